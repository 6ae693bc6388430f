"""Find the condition over which a change of the model lowers its error most."""

from dataclasses import dataclass
from typing import Collection, Iterator, Sequence

import numpy as np

from rovsim.core.axes import AXES
from rovsim.dynamics.effects.base import Signature
from rovsim.evaluation.error_conditions.bins import (
    BinnedErrors,
    bin_errors,
    cut_bins,
    number_stretches,
)
from rovsim.evaluation.error_conditions.conditions import (
    HEADING,
    Blocks,
    Condition,
    list_shown_conditions,
)

TIE_RATIO = 0.97  # of the most: other conditions show as much, as a steady force shows in any


@dataclass(frozen=True, eq=False)
class Lowered:
    """Error of one axis over one condition, before a change of the model and after it.

    Attributes:
        axis: surge to yaw.
        condition: the condition.
        before: errors of the model without the change, in bins.
        after: errors of the model with it, in the same bins.
        size: whether the RMS of the bins shows the change, instead of their means.
        removed: by how much the mean square of the bins fell, over the mean square of the measured
            acceleration of the axis.
    """

    axis: str
    condition: Condition
    before: BinnedErrors
    after: BinnedErrors
    size: bool
    removed: float


def find_most_lowered(
    before: Blocks, after: Blocks, shown: Signature | None, axes: Collection[str] = AXES
) -> Lowered | None:
    """Find the axis and condition over which the error fell most when an effect was added.

    Only conditions are considered that are like the one over which the effect declares to show. If
    it declares none, or that was not measured, all are. Of conditions that show about as much, the
    declared one is preferred, then one of the axis' own motion.

    Args:
        before: blocks of the model without the effect.
        after: the same blocks of the model with it.
        shown: over what the effect declares to show; None if it does not.
        axes: on which it acts.

    Returns:
        The error before and after; None where it did not fall.
    """
    if len(before.time) < 2 or not np.array_equal(before.time, after.time):
        return None
    candidates = [
        c
        for axis, conditions in _list_choices(before, shown)
        if axis in axes
        for c in _compare(before, after, axis, conditions, shown is not None and shown.size)
    ]
    largest = max((c.removed for c in candidates), default=0.0)
    near_largest = [c for c in candidates if c.removed >= TIE_RATIO * largest]
    declared = shown.condition if shown else ""
    return max(
        near_largest,
        key=lambda c: (
            c.condition.name == declared,
            c.condition.axis == c.axis,
            c.removed,
        ),
        default=None,
    )


def _list_choices(
    blocks: Blocks, shown: Signature | None
) -> Iterator[tuple[str, Sequence[Condition]]]:
    """Yield the axes that were measured, each with the conditions over which it may be shown."""
    conditions = [*list_shown_conditions(blocks)]
    declared = next((c for c in conditions if shown and c.name == shown.condition), None)
    for k in np.flatnonzero(blocks.axes).tolist():
        if shown is None or declared is None:
            yield AXES[k], [*blocks.values]
        else:
            yield AXES[k], [c for c in conditions if _is_alike(c, AXES[k], declared, shown.axis)]


def _is_alike(condition: Condition, axis: str, declared: Condition, shown_axis: str) -> bool:
    """Whether a condition relates to an axis as the declared one does to the declared axis.

    For example, the speed of the axis itself, if an effect declares to show over its own speed.
    """
    if declared.axis == "" or declared.name == HEADING:
        return condition == declared
    on_shown_axis = declared.axis == shown_axis
    return condition.kind == declared.kind and (condition.axis == axis) == on_shown_axis


def _compare(
    before: Blocks, after: Blocks, axis: str, conditions: Sequence[Condition], size: bool
) -> Iterator[Lowered]:
    """Yield those of the conditions over which the error of an axis fell."""
    k = AXES.index(axis)
    old, new, acceleration = before.error[:, k], after.error[:, k], before.measured[:, k]
    stretch = number_stretches(before, old)
    values = list_shown_conditions(before)
    for condition in conditions:
        cut = cut_bins(condition, values[condition], stretch)
        tables = bin_errors(cut, old, stretch), bin_errors(cut, new, stretch)
        reduction = _removed(*tables, size) / float(np.mean(acceleration**2) or np.inf)
        if reduction > 0.0:
            yield Lowered(axis, condition, *tables, size, reduction)


def _removed(before: BinnedErrors, after: BinnedErrors, size: bool) -> float:
    """By how much the mean square of the judged bins fell; zero where there is only one bin."""
    count = before.binning.count * before.binning.judged
    if len(count) < 2:
        return 0.0
    old, new = (errors.rms if size else errors.mean for errors in (before, after))
    return float(count @ (old**2 - new**2) / max(count.sum(), 1))
