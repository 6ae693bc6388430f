"""Hide known physics in the tank, ask what is missing, and keep the score.

rovsim blind [blind.suite=quick|standard|full|recordings|equations]
             [blind.seeds=reporting|development]
             [blind.simulator=tank|independent] [blind.methods=[diagnosis,stlsq,frols]]
             [blind.cores=2] [out=results/blind]

One JSON per case and method in OUT/SEEDS/METHOD/; what is there and still true is not asked again.
Writes OUT/summary.json, and of reporting seeds in the tank tables and pictures of
docs/benchmark_blind.md. The independent simulator shares no physics with the tank; it leaves out
cases that it does not state, and its OUT is results/blind/independent. The methods beside this
project's own need the extra rovsim[benchmark].
"""

from pathlib import Path

from rovsim.application.settings import BlindSettings, CommandSettings
from rovsim.apps.cli.output import say
from rovsim.benchmarks.blind.methods import chosen
from rovsim.benchmarks.blind.pictures import write_pictures
from rovsim.benchmarks.blind.run import read_answers
from rovsim.benchmarks.blind.run import run as run_cases
from rovsim.benchmarks.blind.suites import suite
from rovsim.benchmarks.blind.summary import summarize
from rovsim.benchmarks.blind.tables import write_markdown
from rovsim.core.progress import reported
from rovsim.dynamics.catalogue import Catalogue
from rovsim.reporting.html.marked import replace_tables
from rovsim.results.blind_benchmark import BlindSummary

_ASIDE = {"tank": (), "independent": ("independent",)}  # folders that keep answers apart


class Settings(CommandSettings):
    """What `rovsim blind` takes."""

    blind: BlindSettings


def run(settings: Settings, catalogue: Catalogue) -> None:
    """Run what is missing, then score all."""
    asked = settings.blind
    out = Path(settings.out or Path("results/blind", *_ASIDE[asked.simulator]))
    cases, methods = suite(asked.suite, asked.seeds), chosen(asked.methods)
    with reported("blind cases") as progress:
        run_cases(cases, methods, out / asked.seeds, asked.cores, progress, asked.simulator)
    found = {m.name: read_answers(cases, m, out / asked.seeds) for m in methods}
    summaries = {name: summarize(answers) for name, answers in found.items()}
    results = BlindSummary(
        suite=asked.suite, seeds=asked.seeds, simulator=asked.simulator, methods=summaries
    )
    results.write(out / "summary.json")
    text = write_markdown(results)
    if asked.seeds == "reporting" and asked.simulator == "tank":
        page = Path(asked.page)
        replace_tables(page, write_markdown(results, write_pictures(page, results)))
    say(settings, f"{text}\n{out / 'summary.json'}", results.to_json())
