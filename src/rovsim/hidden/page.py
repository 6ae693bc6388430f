"""The tables of docs/benchmark_hidden.md, written between two marks."""

from pathlib import Path
from typing import Any, Mapping, Sequence

from rovsim.errors import BadInput
from rovsim.files import read_text, write_text
from rovsim.hidden.case import SEEDS

BEGIN, END = "<!-- tables: begin -->", "<!-- tables: end -->"
KIND_COLUMNS = {
    "cases": "cases", "verdict": "verdict right", "first": "first name right",
    "exact_strict": "exact", "exact": "exact, lenient", "false_names": "a false name",
    "error_median": "parameter error", "error_95": "95 % of errors below",
    "coverage": "intervals hold", "seconds": "s",
}  # fmt: skip
EFFECT_COLUMNS = {
    "first": "first name right", "exact_strict": "exact", "exact": "exact, lenient",
    "limit": "half are named at", "error_median": "parameter error", "coverage": "intervals hold",
    "instead": "said instead",
}  # fmt: skip
OUTSIDE_COLUMNS = {"cases": "cases", "verdict": "flagged", "false_names": "a false name"}
PERCENT = {"verdict", "first", "exact_strict", "exact", "false_names", "error_median", "error_95",
           "coverage"}  # fmt: skip


def tables(results: Mapping[str, Any]) -> str:
    """Markdown of `summary.json`."""
    first, last = SEEDS[results["seeds"]]
    parts = [
        f"Made by `make benchmark-hidden SUITE={results['suite']}`; {results['seeds']} seeds "
        f"{first} to {last}.",
    ]
    for name, found in results["methods"].items():
        parts += [f"### {name}", table(found["kinds"], "cases of", KIND_COLUMNS)]
        parts += [table(found["effects"], "effect", EFFECT_COLUMNS)]
        parts += [table(found["outside"], "outside the catalogue", OUTSIDE_COLUMNS)]
        parts += [f"Crashed: {', '.join(found['failed'])}."] if found["failed"] else []
    return "\n\n".join(part for part in parts if part)


def table(rows: Mapping[str, Mapping[str, Any]], head: str, columns: Mapping[str, str]) -> str:
    """One Markdown table; empty without rows."""
    if not rows:
        return ""
    lines = [[head, *columns.values()], ["---"] * (len(columns) + 1)]
    lines += [[name, *(shown(k, row.get(k)) for k in columns)] for name, row in rows.items()]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def shown(key: str, value: Any) -> str:
    """One cell."""
    if value is None or value == []:
        return "–"
    if isinstance(value, Sequence):
        return ", ".join(str(v) for v in value)
    if key in PERCENT:
        return f"{100 * value:.0f} %" if value >= 0.1 or value == 0 else f"{100 * value:.1f} %"
    return f"{value:.3g}"


def replace_tables(path: Path, text: str) -> None:
    """Put the tables between the marks of a page.

    Raises:
        BadInput: the page has no such marks.
    """
    page = read_text(path)
    if page.count(BEGIN) != 1 or page.count(END) != 1:
        raise BadInput(
            "the marks of the tables are not there once each",
            where=path,
            expected=f"one line '{BEGIN}' and one line '{END}'",
            remedy="Restore them.",
        )
    before, rest = page.split(BEGIN)
    write_text(path, f"{before}{BEGIN}\n\n{text}\n\n{END}{rest.split(END)[1]}")
