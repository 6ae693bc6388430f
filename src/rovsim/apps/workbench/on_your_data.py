"""An effect on the user's own data: the error over a condition, without it and with it."""

import numpy as np
from nicegui import ui

from rovsim import AXES
from rovsim.apps.workbench.charts import INK, LINE, MARK, SOFT, Options
from rovsim.apps.workbench.parts import chart, computed
from rovsim.apps.workbench.where import BLUE, ERRORS, WHISKER
from rovsim.apps.workbench.workbench import Workbench
from rovsim.core.errors import RovsimError
from rovsim.dynamics.model import Model
from rovsim.evaluation.error_conditions.entries import list_conditions
from rovsim.evaluation.error_conditions.lowered import Lowered, find_most_lowered
from rovsim.reporting.charts import chart_bins
from rovsim.reporting.units import ACCELERATION_UNITS
from rovsim.results.error_conditions import ConditionTable, ModelConditions

SEEN = 1e-4  # of the measured power: one per cent of the acceleration
LOOKS = {"without it": (MARK, "dashed"), "with it": (BLUE, "solid")}


async def show_lowered(bench: Workbench, effect: str) -> bool:
    """Show where a found effect lowers the error most, if that can be seen in accelerations."""
    try:
        models = bench.draft.found(but=effect), bench.draft.found()
    except RovsimError:  # a diagnosis from elsewhere, of effects that are not known here
        return False
    before, after = [await computed(_search, bench, model) for model in models]
    found = find_most_lowered(before, after)
    if found is None or found.removed < SEEN:
        return False
    chart(
        lowered_chart(found),
        f"On your data: mean {found.axis} error over {found.condition}, without {effect} and "
        "with it", 230,
    )  # fmt: skip
    ui.label(
        f"On your {before.split} runs: what is left on {found.axis}, measured minus model, beside "
        "all other effects found."
    )
    return True


def _search(bench: Workbench, model: Model) -> ModelConditions:
    (found,) = list_conditions([bench.replays.searched(model)]).models.values()
    return found


def lowered_chart(found: Lowered) -> Options:
    """Means of the bins with two standard errors, before and after."""
    unit = chart_bins(found.before).unit
    series = [
        one
        for (name, (color, dash)), table in zip(
            LOOKS.items(), (found.before, found.after), strict=True
        )
        for one in _curve(name, color, dash, table)
    ]
    return {
        "grid": {"left": 64, "right": 16, "top": 52, "bottom": 44},
        "legend": {"top": 0, "left": 56, "data": list(LOOKS)},
        "tooltip": {"trigger": "axis"},
        "xAxis": {"type": "value", "scale": True, "nameLocation": "middle", "nameGap": 26,
                  "name": f"{found.condition} ({unit})" if unit else found.condition,
                  "nameTextStyle": {"color": SOFT}, "splitLine": {"show": False},
                  "axisLine": {"onZero": False, "lineStyle": {"color": LINE}},
                  "axisLabel": {"color": SOFT}},
        "yAxis": {"type": "value", "splitNumber": 4, "axisTick": {"show": False},
                  "axisLine": {"show": False, "onZero": False},
                  "name": f"{found.axis} error ({ACCELERATION_UNITS[AXES.index(found.axis)]})",
                  "nameTextStyle": {"align": "left", "color": INK, "padding": [0, 0, 0, -56]},
                  "axisLabel": {"color": SOFT}, "splitLine": {"lineStyle": {"color": "#eeeeee"}}},
        "series": series,
    }  # fmt: skip


def _curve(name: str, color: str, dash: str, table: ConditionTable) -> list[Options]:
    curve = chart_bins(table)
    at, mean, error = (x[curve.judged] for x in (curve.center, curve.mean, curve.error))
    line = {
        "name": name, "type": "line", "symbolSize": 6, "itemStyle": {"color": color},
        "lineStyle": {"color": color, "type": dash}, "data": np.stack([at, mean], 1).tolist(),
    }  # fmt: skip
    bars = {
        "type": "custom", "name": f"{name}, {ERRORS}", "silent": True,
        ":renderItem": WHISKER, "z": 4,
        "data": np.stack([at, mean - error, mean + error], 1).tolist(),
        "encode": {"x": 0, "y": [1, 2]}, "tooltip": {"show": False},
    }  # fmt: skip
    return [line, bars]
