"""The table: what designs reached beside usual manoeuvres, and beside what they promised."""

from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.design.expected_information import NEGLIGIBLE
from rovsim.results.design_benchmark import FlownCase, ReachedStd, ThroughWall


def tabulate(results: Sequence[FlownCase]) -> str:
    """Up to three lines: all cases, the pairs, the values."""
    pairs = [one for one in results if "+" in one.case]
    values = [one for one in results if "+" not in one.case]
    lines = [_sum_up(results)]
    lines += [_compare_pairs(pairs)] if pairs else []
    lines += [_compare_values(values)] if values else []
    return "\n".join(lines)


def _sum_up(results: Sequence[FlownCase]) -> str:
    left = sum(isinstance(one.designed, ThroughWall) for one in results)
    seconds = [one.seconds for one in results]
    cpu_seconds = [one.cpu_seconds for one in results]
    return (
        f"{len(results)} flights, {left} through a wall; a design took "
        f"{np.median(seconds):.0f} s (median), at most {max(seconds):.0f} s; of the processor "
        f"{np.median(cpu_seconds):.0f} and {max(cpu_seconds):.0f} s."
    )


def _compare_pairs(pairs: Sequence[FlownCase]) -> str:
    better = _ratios(pairs)
    return (
        f"Pairs: {np.sum(better >= 2.0)} of {len(better)} with twice the log odds of the best "
        f"usual manoeuvre, median {np.median(better):.1f} times."
    )


def _compare_values(values: Sequence[FlownCase]) -> str:
    better, off = _ratios(values), _misses(values)
    return (
        f"Values: {np.sum(better >= 3.0)} of {len(better)} with three times the information, "
        f"median {np.median(better):.1f} times; the interval reached is off by "
        f"{100 * np.median(np.abs(off)):.0f} % of what was promised (median)."
    )


def _misses(values: Sequence[FlownCase]) -> Array:
    """Standard deviations reached over those promised, less one, of flights that ended (n,)."""
    found = []
    for one in values:
        if isinstance(one.designed, ReachedStd):
            promised = one.promised.std[one.case].then
            assert promised is not None
            found.append(one.designed.std / promised - 1.0)
    return np.array(found)


def _ratios(results: Sequence[FlownCase]) -> Array:
    """Told by the design over told by the usual manoeuvre (n,).

    A usual flight that left the tank told nothing.
    """
    found = []
    for one in results:
        if isinstance(one.designed, ThroughWall):
            found.append(0.0)
        elif one.usual is None or isinstance(one.usual, ThroughWall):
            found.append(np.inf)
        else:
            found.append(one.designed.told / max(one.usual.told, NEGLIGIBLE))
    return np.array(found)
