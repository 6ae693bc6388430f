"""Data of the charts that are drawn on paper and on screen alike: ladder and error conditions."""

from dataclasses import dataclass
from typing import Mapping, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.axes import AXES
from rovsim.core.model_names import NOISE_FLOOR, ZERO_ACCELERATION
from rovsim.reporting.figures.palette import Look, family_look
from rovsim.reporting.wording import title
from rovsim.results.base import or_nan
from rovsim.results.error_conditions import THROUGHOUT, ConditionTable, ModelConditions
from rovsim.results.ladder import Ladder

MAX_NAME_LETTERS = 28  # of a step's name
HEADROOM_RATIO = 1.14  # for the values behind the bars
# times the highest model: a baseline beyond is cut, so that the models can be told apart
MAX_BASELINE_RATIO = 2.0


@dataclass(frozen=True)
class LadderBar:
    """One step of the ladder.

    Attributes:
        model: its name in files.
        label: its name on the chart.
        value: its 2 s error (`windows_2s`), in standard deviations; NaN if unknown.
        look: that of its kind of model.
    """

    model: str
    label: str
    value: float
    look: Look


@dataclass(frozen=True)
class LadderChart:
    """The bars of a ladder.

    Attributes:
        bars: from the first step down.
        noise_floor: a lower bound of the error, not a model; NaN if unknown.
        end: of the axis; a longer bar is cut there.
    """

    bars: tuple[LadderBar, ...]
    noise_floor: float
    end: float

    @property
    def beyond(self) -> tuple[LadderBar, ...]:
        """The bars that are cut at the end of the axis."""
        return tuple(bar for bar in self.bars if bar.value > self.end)


def chart_ladder(ladder: Ladder) -> LadderChart:
    """Return the bars of a ladder, and where their axis ends."""
    bars = tuple(
        LadderBar(
            s.model, title(s.model, MAX_NAME_LETTERS), or_nan(s.windows_2s), family_look(s.model)
        )
        for s in ladder.models
    )
    floor = or_nan(ladder.noise_floor)
    return LadderChart(bars, floor, _end({bar.model: bar.value for bar in bars}, floor))


def _end(steps: Mapping[str, float], floor: float) -> float:
    """Return where the axis ends: a baseline that is far higher than all models is cut."""
    values = {n: v for n, v in {**steps, NOISE_FLOOR: floor}.items() if np.isfinite(v)}
    models = max((v for n, v in values.items() if n != ZERO_ACCELERATION), default=0.0)
    cut = 0.0 < MAX_BASELINE_RATIO * models < values.get(ZERO_ACCELERATION, 0.0)
    return HEADROOM_RATIO * (models if cut else max(values.values(), default=0.0)) or 1.0


def tell_beyond(bars: Sequence[LadderBar]) -> str:
    """Say which bar is longer than the axis; empty where none is."""
    return f"The bar of {bars[0].label} is longer than the axis." if bars else ""


@dataclass(frozen=True, eq=False)
class ConditionMap:
    """Which share of each axis' squared error varies with which condition.

    Attributes:
        axes: names of a axes.
        conditions: names of c conditions; those that explain most come first.
        share: (c, a), 0 to 1. A constant error counts for the condition `throughout` alone.
        significant: pairs of axis and condition that are more than chance.
    """

    axes: tuple[str, ...]
    conditions: tuple[str, ...]
    share: Array
    significant: frozenset[tuple[str, str]]


def chart_conditions(model: ModelConditions, most: int | None = None) -> ConditionMap:
    """Return the map of one model, with at most `most` conditions; None: with all."""
    axes = tuple(axis for axis in AXES if model.axes.get(axis))
    shares = {axis: find_varying_shares(model.axes[axis]) for axis in axes}
    largest = {
        name: max(shares[axis][name] for axis in axes) for name in (shares[axes[0]] if axes else ())
    }
    conditions = tuple(sorted(largest, key=lambda name: -largest[name])[:most])
    share = [[shares[axis][name] for axis in axes] for name in conditions]
    findings = frozenset((finding.axis, finding.condition) for finding in model.findings)
    return ConditionMap(axes, conditions, np.reshape(share, (len(conditions), len(axes))), findings)


def find_varying_shares(tables: Mapping[str, ConditionTable]) -> dict[str, float]:
    """Return the share of one axis' squared error that varies with each condition.

    The mean square of bins contains that of a constant error, whatever the condition: the error of
    a vehicle that is too light is there at every speed and depth. It is therefore subtracted from
    all conditions but `throughout`.
    """
    constant = tables[THROUGHOUT].share_of_error if THROUGHOUT in tables else 0.0
    return {
        name: t.share_of_error if name == THROUGHOUT else max(t.share_of_error - constant, 0.0)
        for name, t in tables.items()
    }


@dataclass(frozen=True, eq=False)
class BinCurve:
    """Mean error of one axis in n bins of a condition.

    Attributes:
        unit: of the condition; angles are in degrees.
        edges: of the bins (n+1,), in this unit.
        center: of the bins (n,), in this unit.
        mean: error (n,), measured minus model.
        error: two standard errors (n,) of the mean.
        judged: which bins (n,) have enough samples to be judged.
        seen: which bins (n,) have any sample.
    """

    unit: str
    edges: Array
    center: Array
    mean: Array
    error: Array
    judged: Array
    seen: Array


def chart_bins(table: ConditionTable) -> BinCurve:
    """Return the mean error of one axis over one condition."""
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
