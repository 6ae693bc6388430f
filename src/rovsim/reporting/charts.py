"""What the ladder and the conditions of error show: decided here, drawn on paper and on screen."""

from dataclasses import dataclass

import numpy as np
from numpy import ndarray as Array

from rovsim import AXES
from rovsim.reporting.figures.palette import Look, looks
from rovsim.reporting.wording import title
from rovsim.results.base import or_nan
from rovsim.results.error_conditions import ConditionTable, ModelConditions
from rovsim.results.ladder import Ladder

NAME = 28  # letters of a step's name


@dataclass(frozen=True)
class LadderBar:
    """One step: its name as shown, its `windows_2s` (NaN if unknown), what it looks like."""

    model: str
    label: str
    value: float
    look: Look


@dataclass(frozen=True)
class LadderChart:
    """Bars from the first step down, and the noise floor, a bound and no model (NaN if unknown)."""

    bars: tuple[LadderBar, ...]
    noise_floor: float


def chart_ladder(ladder: Ladder) -> LadderChart:
    """The bars of a ladder."""
    style = looks(step.model for step in ladder.models)
    bars = tuple(
        LadderBar(s.model, title(s.model, NAME), or_nan(s.windows_2s), style[s.model])
        for s in ladder.models
    )
    return LadderChart(bars, or_nan(ladder.noise_floor))


@dataclass(frozen=True, eq=False)
class ConditionMap:
    """Share (c, a) of the squared error of each of a axes that varies with each of c conditions.

    Conditions that explain most come first; `found` pairs of axis and condition beyond chance.
    """

    axes: tuple[str, ...]
    conditions: tuple[str, ...]
    share: Array
    found: frozenset[tuple[str, str]]


def chart_conditions(model: ModelConditions, most: int | None = None) -> ConditionMap:
    """The map of one model; `most` conditions, or all."""
    axes = tuple(axis for axis in AXES if model.axes.get(axis))
    best = {
        name: max(model.axes[axis][name].share_of_error for axis in axes)
        for name in (model.axes[axes[0]] if axes else ())
    }
    conditions = tuple(sorted(best, key=lambda name: -best[name])[:most])
    share = [[model.axes[axis][name].share_of_error for axis in axes] for name in conditions]
    found = frozenset((one.axis, one.condition) for one in model.findings)
    return ConditionMap(axes, conditions, np.reshape(share, (len(conditions), len(axes))), found)


@dataclass(frozen=True, eq=False)
class BinCurve:
    """Mean error (n,) in n bins of a condition, with two standard errors; angles in degrees.

    `edges` (n+1,) and `center` (n,) of the bins in `unit`; `judged` often enough; `seen` at all.
    """

    unit: str
    edges: Array
    center: Array
    mean: Array
    error: Array
    judged: Array
    seen: Array


def chart_bins(table: ConditionTable) -> BinCurve:
    """The curve of one axis over one condition."""
    angle = table.unit == "rad"
    edges, center = (np.degrees(x) if angle else np.array(x) for x in (table.edges, table.center))
    return BinCurve(
        unit="deg" if angle else table.unit,
        edges=edges,
        center=center,
        mean=np.array(table.mean),
        error=2 * np.array(table.std_error),
        judged=np.array(table.judged, bool),
        seen=np.array(table.blocks) > 0,
    )
