"""What the timing says about control loops, in plain language."""

import math
from typing import Any, Mapping

from rovsim.reporting.figures.inference_time import RATES
from rovsim.reporting.figures.marks import listed, number, significant


def timing_sentences(timing: Mapping[str, Any]) -> list[str]:
    """Say which exported predictors keep which deadlines, and how the libraries compare."""
    inference = timing.get("inference", {})
    exported = {name: ways["exported"] for name, ways in inference.items() if ways.get("exported")}
    library = {name: ways["library"] for name, ways in inference.items() if ways.get("library")}
    return [
        *_range("exported predictors", exported),
        *_deadlines("exported predictors", exported),
        *_against(exported, library),
        *_deadlines("library calls", library),
    ]


def fastest_loop(stats: Mapping[str, Any]) -> int | None:
    """Highest rate in Hz whose period no call exceeded, 0 when none, None when not counted."""
    misses = stats.get("misses")
    if not misses:
        return None
    return max((rate for rate in RATES if misses.get(str(rate)) == 0), default=0)


def _range(what: str, entries: Mapping[str, Any]) -> list[str]:
    medians = [m for m in (number(s.get("median_us")) for s in entries.values()) if m > 0]
    if not medians:
        return []
    low, high = significant(min(medians), 2), significant(max(medians), 2)
    span = f"{low} µs" if low == high else f"{low} to {high} µs"
    return [f"One prediction by the {what} takes {span} (median)."]


def _deadlines(what: str, entries: Mapping[str, Any]) -> list[str]:
    loops = {name: fastest_loop(stats) for name, stats in entries.items()}
    counted = {name: rate for name, rate in loops.items() if rate is not None}
    if not counted:
        return []
    every = f"Of the {what}, " if len(set(counted.values())) > 1 else f"All {what}: "
    groups = [
        f"{_promise(rate)}{_names(counted, rate)}"
        for rate in sorted(set(counted.values()), reverse=True)
    ]
    return [f"{every}{'; '.join(groups)}."]


def _promise(rate: int) -> str:
    if rate == 0:
        return f"even a {min(RATES)} Hz loop would have been missed at least once"
    return f"no call was too late for a {rate} Hz loop"


def _names(counted: Mapping[str, int], rate: int) -> str:
    names = [name for name, value in counted.items() if value == rate]
    return f" ({listed(names)})"


def _against(exported: Mapping[str, Any], library: Mapping[str, Any]) -> list[str]:
    ratios = [
        number(library[name].get("median_us")) / number(exported[name].get("median_us"))
        for name in exported
        if name in library and number(exported[name].get("median_us")) > 0
    ]
    ratios = [r for r in ratios if math.isfinite(r)]
    if not ratios:
        return []
    low, high = significant(min(ratios), 2), significant(max(ratios), 2)
    span = f"{low}" if low == high else f"{low} to {high}"
    return [f"The library's own call takes {span} times as long (median)."]
