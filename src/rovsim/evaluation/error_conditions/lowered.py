"""Under which condition a change of the model lowers the error most."""

from dataclasses import dataclass

import numpy as np

from rovsim.results.error_conditions import ConditionTable, ModelConditions

NEARLY = 0.97  # of the most: a steady force is gone from the bins of any condition


@dataclass(frozen=True)
class Lowered:
    """Error of one axis over one condition, before a change and after it.

    `removed`: mean square that is gone from the means of the bins, over that of the measured
    acceleration of the axis.
    """

    axis: str
    condition: str
    before: ConditionTable
    after: ConditionTable
    removed: float


def find_most_lowered(before: ModelConditions, after: ModelConditions) -> Lowered | None:
    """Where the means of bins fell most; None where none fell.

    Of conditions that show about as much, one of the axis' own motion.
    """
    found = [
        Lowered(axis, name, table, after.axes[axis][name], removed)
        for axis, tables in before.axes.items()
        for name, table in tables.items()
        if name in after.axes.get(axis, {})
        and (removed := _removed(table, after.axes[axis][name], before.error[axis].measured_rms))
        > 0.0
    ]
    most = max((one.removed for one in found), default=0.0)
    near = [one for one in found if one.removed >= NEARLY * most]
    return max(
        near, key=lambda one: (one.condition.startswith(one.axis), one.removed), default=None
    )


def _removed(before: ConditionTable, after: ConditionTable, measured: float | None) -> float:
    """As `Lowered.removed`, of bins judged in both; zero where there is one, or they differ."""
    if not measured or before.edges != after.edges or len(before.mean) < 2:
        return 0.0
    count = np.array(before.blocks) * (np.array(before.judged) & np.array(after.judged))
    gone = np.square(before.mean) - np.square(after.mean)
    return float(count @ gone / (max(count.sum(), 1) * measured**2))
