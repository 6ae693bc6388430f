"""The tables of docs/thesis.md, from what a chapter of folds left in its results.

python -m rovsim.reporting.html.chapter_page results/kth_tank_2025 docs/thesis.md
"""

import argparse
import sys
from pathlib import Path
from typing import Any, Iterator, Mapping, Sequence

from rovsim.core.errors import RovsimError
from rovsim.core.files import read_json
from rovsim.reporting.html.marked import replace_tables, table
from rovsim.reporting.html.published import repeated, text
from rovsim.reporting.html.speed import timing_sentences
from rovsim.reporting.html.verdict import interval


def found(diagnoses: Mapping[str, Mapping[str, Any]]) -> str:
    """What the diagnosis chose while each run was held out: a row a parameter, a column a run."""
    values = {run: dict(_values(content)) for run, content in diagnoses.items()}
    names = dict.fromkeys(name for own in values.values() for name in own)
    rows = [[name, *(own.get(name, "–") for own in values.values())] for name in names]
    return table(["parameter", *(f"without {run}" for run in values)], rows)


def _values(diagnosis: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    for one in diagnosis["selected"]:
        for name, value in one["parameters"].items():
            yield f"{one['effect']} {name}", interval(value)


def together(diagnoses: Mapping[str, Mapping[str, Any]]) -> str:
    """What the runs fixed only jointly in half of the folds or more, the most frequent first."""
    groups = [tuple(g) for one in diagnoses.values() for g in one.get("known_together", [])]
    seen = {group: n for group in groups if 2 * (n := groups.count(group)) >= len(diagnoses)}
    often = sorted(seen, key=lambda group: (-seen[group], group))
    rows = [[", ".join(group), f"{seen[group]} of {len(diagnoses)}"] for group in often]
    return table(["known only together", "folds"], rows)


def page(results: Path) -> str:
    """Markdown of all that the chapter found."""
    marks = read_json(results / "marks.json")
    diagnoses = {run: read_json(results / f"folds/{run}/diagnosis.json") for run in marks["runs"]}
    parts = [
        *text(marks),
        "### What was found while each run was held out",
        found(diagnoses),
        together(diagnoses),
        "### Time of a prediction",
        *timing_sentences(read_json(results / "timing.json")),
    ]
    mistakes = results / "mistakes.json"
    if mistakes.exists():
        parts += ["### The public code's mistakes, repeated", *repeated(read_json(mistakes))]
    return "\n\n".join(parts)


def main(arguments: Sequence[str] | None = None) -> None:
    """Put what a chapter found into a page."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("results", type=Path)
    parser.add_argument("page", type=Path)
    given = parser.parse_args(arguments)
    replace_tables(given.page, page(given.results))


if __name__ == "__main__":
    try:
        main()
    except RovsimError as error:
        print(f"rovsim: {error}", file=sys.stderr)
        sys.exit(2)
