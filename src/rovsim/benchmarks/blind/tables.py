"""The tables of docs/benchmark_blind.md."""

from typing import Mapping, Sequence

from rovsim.benchmarks.blind.case import SEEDS
from rovsim.reporting.html import marked
from rovsim.results.blind_benchmark import BlindSummary, Rates

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


def write_markdown(results: BlindSummary) -> str:
    """Markdown of `summary.json`."""
    first, last = SEEDS[results.seeds]
    parts = [
        f"Made by `make benchmark-blind SUITE={results.suite}`; {results.seeds} seeds "
        f"{first} to {last}.",
    ]
    for name, found in results.methods.items():
        parts += [f"### {name}", table(found.kinds, "cases of", KIND_COLUMNS)]
        parts += [table(found.effects, "effect", EFFECT_COLUMNS)]
        parts += [table(found.outside, "outside the catalogue", OUTSIDE_COLUMNS)]
        parts += [f"Crashed: {', '.join(found.failed)}."] if found.failed else []
    return "\n\n".join(part for part in parts if part)


def table(rows: Mapping[str, Rates], head: str, columns: Mapping[str, str]) -> str:
    """One Markdown table; empty without rows."""
    if not rows:
        return ""
    lines = [[name, *(shown(k, getattr(row, k)) for k in columns)] for name, row in rows.items()]
    return marked.table([head, *columns.values()], lines)


def shown(key: str, value: float | Sequence[str] | None) -> str:
    """One cell."""
    if value is None or value == ():
        return "–"
    if isinstance(value, Sequence):
        return ", ".join(str(v) for v in value)
    if key in PERCENT:
        return f"{100 * value:.0f} %" if value >= 0.1 or value == 0 else f"{100 * value:.1f} %"
    return f"{value:.3g}"
