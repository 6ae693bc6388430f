"""Say which control loops the predictors are fast enough for."""

from typing import Mapping

from rovsim.reporting.wording import listed, significant, title
from rovsim.results.timing import CONTROL_RATES_HZ, Latency, Timing


def timing_sentences(timing: Timing) -> list[str]:
    """Say which exported predictors keep which deadlines, and how the libraries compare."""
    exported = {name: times.exported for name, times in timing.inference.items()}
    library = {name: t.library for name, t in timing.inference.items() if t.library}
    return [
        *_tell_range("exported predictors", exported),
        *_tell_deadlines("exported predictors", exported),
        *_against(exported, library),
        *_tell_deadlines("library calls", library),
    ]


def fastest_loop(stats: Latency) -> int:
    """Highest rate in Hz whose period no call exceeded, 0 when none."""
    return max((rate for rate in CONTROL_RATES_HZ if stats.misses[str(rate)] == 0), default=0)


def _tell_range(what: str, entries: Mapping[str, Latency]) -> list[str]:
    medians = [stats.median_us for stats in entries.values()]
    if not medians:
        return []
    low, high = significant(min(medians), 2), significant(max(medians), 2)
    span = f"{low} µs" if low == high else f"{low} to {high} µs"
    return [f"One prediction by the {what} takes {span} (median)."]


def _tell_deadlines(what: str, entries: Mapping[str, Latency]) -> list[str]:
    loops = {name: fastest_loop(stats) for name, stats in entries.items()}
    if not loops:
        return []
    head = f"Of the {what}, " if len(set(loops.values())) > 1 else f"All {what}: "
    groups = [
        f"{_promise(rate)}{_names(loops, rate)}"
        for rate in sorted(set(loops.values()), reverse=True)
    ]
    return [f"{head}{'; '.join(groups)}."]


def _promise(rate: int) -> str:
    if rate == 0:
        return f"at least one call was too late even for a {min(CONTROL_RATES_HZ)} Hz loop"
    return f"no call was too late for a {rate} Hz loop"


def _names(counted: Mapping[str, int], rate: int) -> str:
    names = [title(name) for name, value in counted.items() if value == rate]
    return f" ({listed(names)})"


def _against(exported: Mapping[str, Latency], library: Mapping[str, Latency]) -> list[str]:
    ratios = [library[name].median_us / exported[name].median_us for name in library]
    if not ratios:
        return []
    low, high = significant(min(ratios), 2), significant(max(ratios), 2)
    span = f"{low}" if low == high else f"{low} to {high}"
    return [f"The library's own call takes {span} times as long (median)."]
