"""The table: what designs reached beside usual manoeuvres, and beside what they promised."""

from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.design.expected_information import MIN_INFORMATION_GAIN
from rovsim.results.design_benchmark import FlownCase, ReachedStd, ThroughWall


def tabulate(results: Sequence[FlownCase]) -> str:
    """Up to three lines: all cases, the pairs, the values."""
    pairs = [case for case in results if "+" in case.case]
    values = [case for case in results if "+" not in case.case]
    lines = [_sum_up(results)]
    lines += [_compare_pairs(pairs)] if pairs else []
    lines += [_compare_values(values)] if values else []
    return "\n".join(lines)


def _sum_up(results: Sequence[FlownCase]) -> str:
    collisions = sum(isinstance(case.designed, ThroughWall) for case in results)
    seconds = [case.seconds for case in results]
    cpu_seconds = [case.cpu_seconds for case in results]
    return (
        f"{len(results)} flights, {collisions} through a wall; a design took "
        f"{np.median(seconds):.0f} s (median), at most {max(seconds):.0f} s; of the processor "
        f"{np.median(cpu_seconds):.0f} and {max(cpu_seconds):.0f} s."
    )


def _compare_pairs(pairs: Sequence[FlownCase]) -> str:
    ratios = _ratios(pairs)
    return (
        f"Pairs: {np.sum(ratios >= 2.0)} of {len(ratios)} with twice the log odds of the best "
        f"usual manoeuvre, median {np.median(ratios):.1f} times."
    )


def _compare_values(values: Sequence[FlownCase]) -> str:
    ratios, errors = _ratios(values), _misses(values)
    return (
        f"Values: {np.sum(ratios >= 3.0)} of {len(ratios)} with three times the information, "
        f"median {np.median(ratios):.1f} times; the interval reached is off by "
        f"{100 * np.median(np.abs(errors)):.0f} % of what was promised (median)."
    )


def _misses(values: Sequence[FlownCase]) -> Array:
    """Standard deviations reached over those promised, less one, of flights that ended (n,)."""
    errors = []
    for case in values:
        if isinstance(case.designed, ReachedStd):
            promised = case.promised.std[case.case].then
            assert promised is not None
            errors.append(case.designed.std / promised - 1.0)
    return np.array(errors)


def _ratios(results: Sequence[FlownCase]) -> Array:
    """Told by the design over told by the usual manoeuvre (n,).

    A usual flight that left the tank told nothing.
    """
    ratios = []
    for case in results:
        if isinstance(case.designed, ThroughWall):
            ratios.append(0.0)
        elif case.usual is None or isinstance(case.usual, ThroughWall):
            ratios.append(np.inf)
        else:
            ratios.append(case.designed.told / max(case.usual.told, MIN_INFORMATION_GAIN))
    return np.array(ratios)
