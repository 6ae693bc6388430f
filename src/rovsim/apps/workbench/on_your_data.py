"""A chart of an effect in the user's data: the error over a condition without it and with it."""

from typing import Collection

import numpy as np
from nicegui import ui

from rovsim.apps.workbench.chart_axes import LINE, SOFT, Options, named_above, named_below
from rovsim.apps.workbench.charts import MARK_COLOR
from rovsim.apps.workbench.parts import chart, computed
from rovsim.apps.workbench.where import DRAW_WHISKER, WHISKER_NAME
from rovsim.apps.workbench.workbench import Workbench
from rovsim.core.axes import ACCELERATION_UNITS, AXES
from rovsim.core.errors import RovsimError
from rovsim.evaluation.error_conditions.bins import BinnedErrors
from rovsim.evaluation.error_conditions.entries import tabulate
from rovsim.evaluation.error_conditions.lowered import Lowered, find_most_lowered
from rovsim.reporting.charts import chart_bins
from rovsim.reporting.figures.palette import BLUE

MIN_SEEN_SHARE = 1e-4  # of the measured power: one per cent of the acceleration
CURVE_LOOKS = {"without it": (MARK_COLOR, "dashed"), "with it": (BLUE, "solid")}


async def show_lowered(bench: Workbench, effect: str) -> bool:
    """Show how an effect lowers the acceleration error over its condition, if that is visible.

    Returns:
        Whether it is, so that there is a chart.
    """
    try:
        models = bench.draft.fitted_model(but=effect), bench.draft.fitted_model()
    except RovsimError:  # a diagnosis from elsewhere, of effects that are not known here
        return False
    cls = bench.catalogue.get(effect)
    before, after = [await computed(bench.replays.searched, model) for model in models]
    blocks = before.explanation.blocks, after.explanation.blocks
    if blocks[0] is None or blocks[1] is None:
        return False
    errors = find_most_lowered(*blocks, cls.signature if cls else None, _axes(bench, effect))
    if errors is None or errors.removed < MIN_SEEN_SHARE:
        return False
    chart(
        lowered_chart(errors),
        f"On your data: {_name_condition(errors)} over {errors.condition.name}, without {effect} "
        "and with it",
        230,
    )
    label = "the size (RMS) of what is left" if errors.size else "what is left"
    ui.label(
        f"On your {before.split} runs: {label} on {errors.axis}, measured minus model, beside all "
        "other effects found."
    )
    return True


def _axes(bench: Workbench, effect: str) -> Collection[str]:
    """Return the axes that an effect acts on: those that its parameters are named after, or all."""
    fitted = bench.draft.fitted[effect].parameters if effect in bench.draft.fitted else ()
    return [axis for axis in AXES if axis in fitted] or AXES


def _name_condition(lowered: Lowered) -> str:
    return f"{'size of ' if lowered.size else ''}{lowered.axis} error"


def lowered_chart(lowered: Lowered) -> Options:
    """Return a chart of the binned errors: means with two standard errors, or their RMS."""
    name, unit = lowered.condition.name, chart_bins(tabulate(lowered.before)).unit
    series = [
        curve
        for (label, (color, dash)), table in zip(
            CURVE_LOOKS.items(), (lowered.before, lowered.after), strict=True
        )
        for curve in _curve(label, color, dash, table, lowered.size)
    ]
    return {
        "grid": {"left": 64, "right": 16, "top": 52, "bottom": 44},
        "legend": {"top": 0, "left": 56, "data": list(CURVE_LOOKS)},
        "tooltip": {"trigger": "axis"},
        "xAxis": {
            "type": "value",
            "scale": True,
            **named_below(f"{name} ({unit})" if unit else name, 26),
            "splitLine": {"show": False},
            "axisLine": {"onZero": False, "lineStyle": {"color": LINE}},
            "axisLabel": {"color": SOFT},
        },
        "yAxis": {
            **named_above(
                f"{_name_condition(lowered)} ({ACCELERATION_UNITS[AXES.index(lowered.axis)]})", 56
            ),
            "splitNumber": 4,
            "axisTick": {"show": False},
            "axisLine": {"show": False, "onZero": False},
        },
        "series": series,
    }


def _curve(name: str, color: str, dash: str, table: BinnedErrors, size: bool) -> list[Options]:
    curve = chart_bins(tabulate(table))
    height = table.rms if size else curve.mean
    centers, mean, error = (x[curve.judged] for x in (curve.center, height, curve.error))
    line = {
        "name": name,
        "type": "line",
        "symbolSize": 6,
        "itemStyle": {"color": color},
        "lineStyle": {"color": color, "type": dash},
        "data": np.stack([centers, mean], 1).tolist(),
    }
    if size:
        return [line]
    bars = {
        "type": "custom",
        "name": f"{name}, {WHISKER_NAME}",
        "silent": True,
        ":renderItem": DRAW_WHISKER,
        "z": 4,
        "data": np.stack([centers, mean - error, mean + error], 1).tolist(),
        "encode": {"x": 0, "y": [1, 2]},
        "tooltip": {"show": False},
    }
    return [line, bars]
