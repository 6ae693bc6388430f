"""Hide known physics in the tank, ask what is missing, and keep the score.

rovsim blind [blind.suite=quick|standard|full|recordings|equations|laboratory|
             strong] [blind.share=1] [blind.seeds=reporting|development]
             [blind.simulator=tank|independent] [blind.methods=[diagnosis,stlsq,frols]]
             [out=results/blind]

One JSON per case and method in OUT/SEEDS/METHOD/; what is there and still true is not asked again.
Case by case on several cores or over a cluster: `snakemake -s workflow/blind.smk`, which ends with
this command. Writes OUT/summary.json, and of reporting seeds in the tank tables and pictures of
docs/benchmark_blind.md. The independent simulator shares no physics with the tank; it leaves out
cases that it does not state, and its OUT is results/blind/independent. The methods beside this
project's own need the extra rovsim[benchmark].
"""

from pathlib import Path

from rovsim.application.settings import BlindSettings, WritingSettings
from rovsim.apps.cli.output import say
from rovsim.benchmarks.blind.pictures import write_pictures
from rovsim.benchmarks.blind.run import Benchmark, read_answers
from rovsim.benchmarks.blind.run import run as run_cases
from rovsim.benchmarks.blind.summary import summarize
from rovsim.benchmarks.blind.tables import write_markdown
from rovsim.core.progress import reported
from rovsim.dynamics.catalogue import Catalogue
from rovsim.reporting.pages.marked import replace_tables
from rovsim.results.blind_benchmark import BlindSummary


class Settings(WritingSettings):
    """What `rovsim blind` takes."""

    blind: BlindSettings


def run(settings: Settings, catalogue: Catalogue) -> None:
    """Run what is missing, then score all."""
    benchmark = Benchmark.of(settings.blind, settings.out)
    options, out = benchmark.asked, benchmark.out
    with reported("blind cases") as progress:
        run_cases(benchmark.pending(), progress)
    by_method = {
        m.name: read_answers(benchmark.cases, m, benchmark.answers) for m in benchmark.methods
    }
    summaries = {name: summarize(answers) for name, answers in by_method.items()}
    results = BlindSummary(
        suite=options.suite,
        share=options.share,
        seeds=options.seeds,
        simulator=options.simulator,
        methods=summaries,
    )
    results.write(out / "summary.json")
    text = write_markdown(results)
    page = Path(options.page)
    if options.seeds == "reporting" and options.simulator == "tank" and page.is_file():
        replace_tables(page, write_markdown(results, write_pictures(page, results)))
    say(settings, f"{text}\n{out / 'summary.json'}", results.to_json())
