"""The tables of docs/thesis.md, from the results of a study that held each run out once.

python -m rovsim.reporting.pages.leave_one_run_out results/kth_tank_2025 docs/thesis.md
"""

import argparse
import sys
from itertools import chain
from pathlib import Path
from typing import Iterator, Mapping, Sequence

from rovsim.core.errors import RovsimError
from rovsim.reporting.pages.against_published import write_markdown
from rovsim.reporting.pages.marked import replace_tables, table
from rovsim.reporting.words.intervals import differs_from_zero, interval
from rovsim.reporting.words.published_errors import tell_pitfalls
from rovsim.reporting.words.speed import timing_sentences
from rovsim.results.diagnosis import Diagnosis
from rovsim.results.fitted import FittedValue
from rovsim.results.pitfalls import Pitfalls
from rovsim.results.published_errors import PublishedErrors
from rovsim.results.timing import Timing


def tabulate_selected(diagnoses: Mapping[str, Diagnosis]) -> str:
    """Return a table of the fitted parameters: a row for each, a column for each held-out run."""
    values = {
        run: {name: interval(value) for name, value in _fitted(diagnosis)}
        for run, diagnosis in diagnoses.items()
    }
    names = dict.fromkeys(name for by_name in values.values() for name in by_name)
    rows = [[name, *(by_name.get(name, "–") for by_name in values.values())] for name in names]
    return table(["parameter", *(f"without {run}" for run in values)], rows)


def _fitted(diagnosis: Diagnosis) -> Iterator[tuple[str, FittedValue]]:
    for fit in diagnosis.selected:
        for name, value in fit.parameters.items():
            yield f"{fit.effect} {name}", value


def tell_known(diagnoses: Mapping[str, Diagnosis]) -> str:
    """Say how many fitted parameters differ from zero in each fold, and which do in all folds."""
    values = {run: dict(_fitted(diagnosis)) for run, diagnosis in diagnoses.items()}
    nonzero = {
        run: [n for n, v in by_name.items() if differs_from_zero(v)]
        for run, by_name in values.items()
    }
    counts = (f"{len(nonzero[run])} of {len(values[run])} without {run}" for run in values)
    always = [
        n for n in dict.fromkeys(chain(*nonzero.values())) if all(n in k for k in nonzero.values())
    ]
    return (
        f"Fitted numbers whose 95 % interval leaves zero out: {', '.join(counts)}; in every fold "
        f"{', '.join(always) or 'none'}. The others predict together, and are no measured physics."
    )


def tabulate_together(diagnoses: Mapping[str, Diagnosis]) -> str:
    """Return a table of the parameters that were known only together in half of the folds or more.

    The most frequent groups come first.
    """
    groups = [group for diagnosis in diagnoses.values() for group in diagnosis.known_together]
    counts = {group: n for group in groups if 2 * (n := groups.count(group)) >= len(diagnoses)}
    frequent = sorted(counts, key=lambda group: (-counts[group], group))
    rows = [[", ".join(group), f"{counts[group]} of {len(diagnoses)}"] for group in frequent]
    return table(["known only together", "folds"], rows)


def describe_folds(results: Path) -> str:
    """Return the Markdown of all results of the folds.

    Args:
        results: folder of a study that held out each run once.
    """
    published_errors = PublishedErrors.read(results / "published_errors.json")
    diagnoses = {
        run: Diagnosis.read(results / f"folds/{run}/diagnosis.json")
        for run in published_errors.runs
    }
    parts = [
        *write_markdown(published_errors),
        "### What was found while each run was held out",
        tell_known(diagnoses),
        tabulate_selected(diagnoses),
        tabulate_together(diagnoses),
        "### Time of a prediction",
        *timing_sentences(Timing.read(results / "timing.json")),
    ]
    pitfalls = results / "pitfalls.json"
    if pitfalls.exists():
        sentences = tell_pitfalls(Pitfalls.read(pitfalls))
        parts += ["### The public code's pitfalls, repeated", *sentences]
    return "\n\n".join(parts)


def main(arguments: Sequence[str] | None = None) -> None:
    """Put what was found into a page."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("results", type=Path)
    parser.add_argument("page", type=Path)
    options = parser.parse_args(arguments)
    replace_tables(options.page, describe_folds(options.results))


if __name__ == "__main__":
    try:
        main()
    except RovsimError as error:
        print(f"rovsim: {error}", file=sys.stderr)
        sys.exit(2)
