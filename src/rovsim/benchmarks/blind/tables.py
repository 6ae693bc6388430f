"""The tables of docs/benchmark_blind.md."""

from typing import Mapping, Sequence

from rovsim.benchmarks.blind.case import SEED_RANGES
from rovsim.benchmarks.blind.pictures import RANKS, RELIABILITY
from rovsim.core.schema import Section
from rovsim.reporting.pages import marked
from rovsim.results.blind_benchmark import (
    BlindSummary,
    Calibration,
    Claims,
    Ranks,
)

KIND_COLUMNS = {
    "cases": "cases", "verdict": "verdict right", "first": "first name right",
    "exact_strict": "exact", "exact": "exact, lenient", "unseen": "the rest not observable",
    "false_names": "a false name",
    "error_median": "parameter error", "error_95": "95 % of errors below",
    "coverage": "intervals hold", "worse": "worse than nominal", "seconds": "s",
    "seconds_95": "95 % below", "cpu_seconds": "CPU s", "cpu_seconds_95": "95 % below",
}  # fmt: skip
EFFECT_COLUMNS = {
    "first": "first name right",
    "exact_strict": "exact",
    "exact": "exact, lenient",
    "limit": "half are named at",
    "error_median": "parameter error",
    "coverage": "intervals hold",
    "instead": "said instead",
}
LAW_COLUMNS = {
    "cases": "cases",
    "unexplained": "flagged",
    "proposed": "an equation",
    "right": "right terms",
    "half": "half way to the floor",
}
BAND_COLUMNS = {
    "campaigns": "campaigns",
    "points": "points",
    "inside": "inside",
    "low": "in 5 % of campaigns less than",
    "high": "in 5 % more than",
}
OUTSIDE_COLUMNS = {"cases": "cases", "verdict": "flagged", "false_names": "a false name"}
PERCENT_COLUMNS = {"inside", "low", "high", "verdict", "first", "exact_strict", "exact", "unseen",
           "false_names",
           "unexplained", "proposed", "right", "half",
           "error_median", "error_95", "coverage", "worse", "covered", "p_value"}  # fmt: skip
RANK_COLUMNS = {
    "values": "values",
    "covered": "inside 95 %",
    "stretch": "times too narrow",
    "p_value": "chance of such ranks",
    "counts": "ranks",
    "said": "intervals are",
}
_SIMULATOR_NAMES = {"tank": "tank", "independent": "independent simulator"}
# p-value of a rank histogram, below which intervals are not called honest
MIN_HONEST_P_VALUE = 0.01
MIN_PRINTED_P_VALUE = 0.001  # p-values below are all written as below this
WIDTH_TOLERANCE = 0.1  # of the width of an interval: less is of the right width
CAPTIONS = {
    RANKS: "Rank histograms: where the truth lies in what was said of each parameter",
    RELIABILITY: "Reliability: share of right names against the probability that was claimed",
}


def write_markdown(results: BlindSummary, pictures: Sequence[str] = ()) -> str:
    """Write a summary as Markdown, with those of the page's pictures that were drawn."""
    first, last = SEED_RANGES[results.seeds]
    share = "" if results.share == 1.0 else f" SHARE={results.share:g}"
    parts = [
        f"Made by `make benchmark-blind SUITE={results.suite}{share}`; {results.seeds} seeds "
        f"{first} to {last}; flown in the {_SIMULATOR_NAMES[results.simulator]}.",
    ]
    for name, summary in results.methods.items():
        parts += [f"### {name}", table(summary.kinds, "cases of", KIND_COLUMNS)]
        parts += [table(summary.effects, "effect", EFFECT_COLUMNS)]
        parts += [table(summary.outside, "outside the catalogue", OUTSIDE_COLUMNS)]
        parts += [table(summary.laws, "law hidden", LAW_COLUMNS)]
        parts += _calibration(summary.calibration, pictures if name == "diagnosis" else ())
        parts += [f"Crashed: {', '.join(summary.failed)}."] if summary.failed else []
    return "\n\n".join(part for part in parts if part)


def _calibration(calibration: Calibration, pictures: Sequence[str]) -> list[str]:
    """Write whether intervals and probabilities are honest; nothing without intervals."""
    if not calibration.ranks.values:
        return []
    images = {name: f"![{CAPTIONS[name]}](images/{name}.png)" for name in pictures}
    parts = ["**Are intervals honest?** All kinds of cases together."]
    parts += [_table_ranks({"all": calibration.ranks} | calibration.effects, "effect")]
    parts += ["Parameter by parameter:", _table_ranks(calibration.parameters, "parameter")]
    parts += [images.get(RANKS, "")]
    parts += [
        "**Are probabilities honest?**",
        _table_claims(calibration),
        images.get(RELIABILITY, ""),
    ]
    if calibration.bands:
        parts += ["**Do bands hold?** 90 % of the measured velocities should lie inside."]
        parts += [table(calibration.bands, "s after a start", BAND_COLUMNS)]
    return parts


def _table_ranks(rows: Mapping[str, Ranks], head: str) -> str:
    columns = list(RANK_COLUMNS)[:-1]
    lines = [
        [n, *(shown(k, getattr(r, k)) for k in columns), _judge_honesty(r)] for n, r in rows.items()
    ]
    return marked.table([head, *RANK_COLUMNS.values()], lines)


def _judge_honesty(ranks: Ranks) -> str:
    """Say in a word whether intervals are honest."""
    if ranks.p_value is None or ranks.stretch is None:
        return "–"
    if ranks.p_value > MIN_HONEST_P_VALUE:
        return "honest, as far as can be seen"
    if abs(ranks.stretch - 1.0) < WIDTH_TOLERANCE:
        return "of the right width, but uneven"
    return "too narrow" if ranks.stretch > 1.0 else "too wide"


def _table_claims(calibration: Calibration) -> str:
    rows = [[f"{c.low:g} to {c.high:g}", *_share_right(c)] for c in calibration.probability]
    rows += [["none", *_share_right(calibration.without_probability)]]
    return marked.table(["probability", "claimed, mean", "names", "right"], rows)


def _share_right(claims: Claims) -> list[str]:
    right = shown("verdict", claims.right / claims.names if claims.names else None)
    return ["–" if claims.claimed is None else f"{claims.claimed:.4f}", str(claims.names), right]


def table(rows: Mapping[str, Section], head: str, columns: Mapping[str, str]) -> str:
    """Write a Markdown table; empty without rows.

    Args:
        rows: by name; columns are fields of theirs.
        head: title of the column of names.
        columns: titles by field.
    """
    if not rows:
        return ""
    lines = [[name, *(shown(k, getattr(row, k)) for k in columns)] for name, row in rows.items()]
    return marked.table([head, *columns.values()], lines)


def shown(key: str, value: float | Sequence[str] | Sequence[int] | None) -> str:
    """Write one cell of a table; `key` is the field that the value is of."""
    if value is None or value == ():
        return "–"
    if key == "counts" and isinstance(value, Sequence):
        return " ".join(str(v) for v in value)
    if isinstance(value, Sequence):
        return ", ".join(str(v) for v in value)
    if isinstance(value, int):
        return str(value)
    if key == "p_value" and value < MIN_PRINTED_P_VALUE:
        return f"below {100 * MIN_PRINTED_P_VALUE:.1f} %"
    if key in PERCENT_COLUMNS:
        return f"{100 * value:.0f} %" if value >= 0.1 or value == 0 else f"{100 * value:.1f} %"
    return f"{value:.3g}"
