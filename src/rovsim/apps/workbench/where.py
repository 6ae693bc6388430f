"""The screen Where: the error of a model by condition; a bin shows its samples in time."""

from contextlib import nullcontext
from typing import Sequence

import numpy as np
from nicegui import ui

from rovsim.apps.workbench.chart_axes import LINE, SOFT, Options, named_above, named_below
from rovsim.apps.workbench.charts import MARK_COLOR
from rovsim.apps.workbench.condition_map import FieldMap
from rovsim.apps.workbench.parts import (
    about_axes,
    chart,
    computed,
    heading,
    onward,
    section,
    text,
    titled,
)
from rovsim.apps.workbench.place import Place
from rovsim.apps.workbench.workbench import Workbench
from rovsim.core.axes import ACCELERATION_UNITS, AXES
from rovsim.core.signs import minus
from rovsim.evaluation.error_conditions.bins import BinnedErrors
from rovsim.evaluation.error_conditions.entries import list_conditions
from rovsim.evaluation.error_conditions.search import SearchedModel
from rovsim.reporting.charts import chart_bins
from rovsim.reporting.figures.palette import BLUE
from rovsim.results.error_conditions import ConditionFinding, ConditionTable

TITLE, QUESTION = "Where", "Under which conditions does it fail?"
FAINT_COLOR = "#bdbdbd"
WHISKER_NAME = "from two standard errors below to above"
MAX_OPEN_SENTENCES = 4  # the others are folded away


class Where:
    """The screen Where on one page, and the choices made on it."""

    def __init__(self, bench: Workbench, place: Place) -> None:
        self.bench, self.place = bench, place
        self.physical = [n for n, m in bench.models.items() if not m.inert]
        first = {"model": bench.base.name, "axis": None, "condition": None}
        self.chosen = place.choose(first, {"model": self.physical})
        for name in ("axis", "condition"):
            self.chosen[name] = place.query.get(name, self.chosen[name])

    async def show(self) -> None:
        """Build the screen."""
        heading(TITLE, QUESTION)
        about_axes()
        choice = ui.select(
            titled(self.physical), label="Model", value=self.chosen["model"]
        ).classes("control")
        choice.props("outlined dense")
        self.area = ui.row().classes("halves")

        async def changed() -> None:
            self.chosen |= {"model": choice.value, "axis": None, "condition": None}
            await self.draw()

        choice.on_value_change(changed)
        await self.draw()

    async def draw(self) -> None:
        """Draw findings, map and bins of the chosen model."""
        model = self.bench.models[self.chosen["model"]]
        self.searched: SearchedModel = await computed(self.bench.replays.searched, model)
        self.conditions = list_conditions([self.searched]).models[model.name]
        self.area.clear()
        with self.area:
            with ui.column().classes("half equal"):
                self._findings(self.conditions.findings)
                FieldMap(self.conditions, self.choose)
            with ui.column().classes("half equal side"):
                self.bins = ui.column().classes("area")
                onward("Why does it fail?", "/why")
        pair = (self.chosen["axis"], self.chosen["condition"])
        exists = pair[1] in self.searched.explanation.tables.get(pair[0], ())
        chosen = pair if exists else self._largest()
        if chosen:
            self.choose(*chosen)

    def _largest(self) -> tuple[str, str] | None:
        """Return axis and condition of the first finding, else of the largest share of an error."""
        if self.conditions.findings:
            finding = self.conditions.findings[0]
            return finding.axis, finding.condition
        shares = {
            (axis, condition): table.share_of_error
            for axis, tables in self.conditions.axes.items()
            for condition, table in tables.items()
        }
        return max(shares, key=lambda pair: shares[pair]) if shares else None

    def _findings(self, findings: Sequence[ConditionFinding]) -> None:
        """Show the findings in sentences; all but `MAX_OPEN_SENTENCES` are folded away."""
        runs = f"{self.searched.split} runs {', '.join(self.searched.runs)}"
        text(f"Acceleration error in means over half a second, on the {runs}.", "soft")
        for k, sentence in enumerate(self.conditions.sentences):
            if k == MAX_OPEN_SENTENCES:
                folded = ui.expansion(f"{len(findings) - MAX_OPEN_SENTENCES} more").classes("more")
            with folded if k >= MAX_OPEN_SENTENCES else nullcontext(), ui.row().classes("finding"):
                ui.label(sentence)
                if k < len(findings):
                    pair = (findings[k].axis, findings[k].condition)
                    ui.button("show", on_click=lambda _, a=pair: self.choose(*a)).props(
                        f'flat dense no-caps aria-label="Show {pair[0]} over {pair[1]}"'
                    )

    def choose(self, axis: str, condition: str) -> None:
        """Show the error on one axis in bins of one condition."""
        self.chosen |= {"axis": axis, "condition": condition}
        self.place.tell(self.chosen)
        table: BinnedErrors = self.searched.explanation.tables[axis][condition]
        unit = ACCELERATION_UNITS[AXES.index(axis)]
        self.bins.clear()
        with self.bins:
            section(f"{axis.capitalize()} error over {condition}")
            text(
                "Mean error of each bin, measured minus model, with two standard errors. "
                "Click a bin, or choose it below, to see its samples in time.",
                "soft",
            )
            chart(
                bins_chart(self.conditions.axes[axis][condition], condition, axis, unit),
                f"Mean {axis} error by bins of {condition}",
                200,
                on_point_click=lambda e: self._samples(axis, table, e.data_index),
            )
            names = {k: _span(table, k) for k in range(len(table.binning.count))}
            toggle = ui.toggle(names, on_change=lambda e: self._samples(axis, table, e.value))
            toggle.props('no-caps dense flat toggle-color=primary aria-label="Bin"').classes("bins")
            self.series = ui.column().classes("area")

    def _samples(self, axis: str, binned: BinnedErrors, chosen: int) -> None:
        """Show the samples (half-second means) of the bin number `chosen` among all, over time."""
        blocks = self.searched.explanation.blocks
        assert blocks is not None  # a table was made of them
        error, inside = blocks.error[:, AXES.index(axis)], binned.binning.bin == chosen
        self.series.clear()
        with self.series:
            ui.label(f"{int(inside.sum())} samples, {_span(binned, chosen)}").classes("soft")
            for k, run in enumerate(self.searched.runs):
                in_run = blocks.run == k
                if (in_run & inside).any():
                    options = samples_chart(
                        blocks.time[in_run], error[in_run], inside[in_run], run, axis
                    )
                    chart(options, f"Samples of run {run} over time", 170)


def _span(binned: BinnedErrors, k: int) -> str:
    edges, unit = binned.binning.edges, binned.binning.condition.unit
    low, high = (np.degrees(edges[k : k + 2]) if unit == "rad" else edges[k : k + 2]).tolist()
    if len(edges) == 2:
        return "throughout"
    ends = " to ".join(minus(f"{end:.2g}") for end in (low, high))
    return f"{ends} {'°' if unit == 'rad' else unit}"


def bins_chart(table: ConditionTable, condition: str, axis: str, unit: str) -> Options:
    """Return a chart of the bins' mean errors with two standard errors; grey: too few samples."""
    curve = chart_bins(table)
    colors = [BLUE if yes else FAINT_COLOR for yes in curve.judged]
    centers = [minus(f"{c:.2g}") for c in curve.center]
    low, high = curve.mean - curve.error, curve.mean + curve.error
    whiskers = [[k, *ends] for k, ends in enumerate(np.stack([low, high], axis=1).tolist())]
    return {
        "grid": {"left": 64, "right": 16, "top": 30, "bottom": 44},
        "tooltip": {"trigger": "item"},
        "xAxis": {
            "type": "category",
            "data": centers,
            **named_below(f"{condition} ({curve.unit})" if curve.unit else condition, 26),
            "axisLine": {"onZero": False, "lineStyle": {"color": LINE}},
            "axisLabel": {"color": SOFT},
        },
        "yAxis": named_above(f"{axis} error ({unit})", 56),
        "series": [
            {
                "type": "bar",
                "name": "mean error",
                "barMaxWidth": 64,
                "data": [
                    {"value": m, "itemStyle": {"color": c}}
                    for m, c in zip(table.mean, colors, strict=True)
                ],
            },
            {
                "type": "custom",
                "name": WHISKER_NAME,
                "silent": True,
                "data": whiskers,
                ":renderItem": DRAW_WHISKER,
                "z": 4,
                "encode": {"x": 0, "y": [1, 2]},
            },
        ],
    }


DRAW_WHISKER = (
    "(p, api) => { const a = api.coord([api.value(0), api.value(1)]),"
    " b = api.coord([api.value(0), api.value(2)]);"
    " return {type: 'line', shape: {x1: a[0], y1: a[1], x2: b[0], y2: b[1]},"
    " style: {stroke: '#1a1a1a', lineWidth: 1.5}}; }"
)


def samples_chart(time, error, inside, run: str, axis: str) -> Options:
    """Return a chart of the errors of one run over time; large orange dots are inside the bin.

    Args:
        time: of n samples, s.
        error: at these (n,), measured minus model, m/s2 or rad/s2.
        inside: which of these are in the bin (n,).
        run: name of the run.
        axis: name of the axis.
    """
    pairs = np.round(np.stack([time, error], axis=1), 5)
    return {
        "grid": {"left": 64, "right": 16, "top": 28, "bottom": 36},
        "tooltip": {"trigger": "item"},
        "xAxis": {
            "type": "value",
            **named_below("time in the run (s)", 22),
            "splitLine": {"show": False},
            "axisLabel": {"color": SOFT},
            "axisLine": {"onZero": False, "lineStyle": {"color": LINE}},
        },
        "yAxis": {**named_above(f"run {run}, {axis} error", 56), "splitNumber": 3},
        "series": [
            {
                "type": "scatter",
                "name": "other",
                "symbolSize": 4,
                "itemStyle": {"color": FAINT_COLOR},
                "data": pairs[~inside].tolist(),
            },
            {
                "type": "scatter",
                "name": "in the bin",
                "symbolSize": 9,
                "itemStyle": {"color": MARK_COLOR, "borderColor": "#ffffff"},
                "data": pairs[inside].tolist(),
            },
        ],
    }


async def show(bench: Workbench, place: Place) -> None:
    """Show the screen."""
    await Where(bench, place).show()
