"""The screen Ladder: the error of each model on the test runs, down to the noise floor."""

from nicegui import app, ui

from rovsim.apps.workbench import jobs
from rovsim.apps.workbench.chart_axes import GRID, INK, SOFT, Options, named_below
from rovsim.apps.workbench.parts import (
    cell,
    chart,
    computed,
    heading,
    section,
    table,
    text,
    titled,
)
from rovsim.apps.workbench.place import Place
from rovsim.apps.workbench.workbench import Workbench
from rovsim.core.axes import AXES, VELOCITY_UNITS
from rovsim.learning.learner import learners
from rovsim.reporting.charts import LadderBar, chart_ladder, tell_beyond
from rovsim.reporting.wording import (
    ERROR_MEANING,
    ERROR_NAME,
    LADDER_NOTE,
    LADDER_STEP,
    significant,
    title,
)
from rovsim.results.base import or_none
from rovsim.results.ladder import Ladder

TITLE, QUESTION = "Ladder", "How far down does the error go?"


async def show(bench: Workbench, place: Place) -> None:
    """Show the screen."""
    heading(TITLE, QUESTION)
    text(f"Each model on the test runs, to which nothing was fitted. {ERROR_MEANING}.")
    ladder = await computed(bench.ladder)
    remarks = _remarks(ladder)
    if remarks:
        text(remarks, "soft")
    about = f"{ERROR_NAME} of each model, the noise floor as a line"
    names = {"names": ("model", "error (standard deviations of the measured velocity)")}
    chart(chart_of(ladder), about, 80 + 36 * len(ladder.steps), columns=names)
    _table(ladder)
    _train(bench)
    _report(bench)


def _remarks(ladder: Ladder) -> str:
    """Say which rows build on each other, and which bar is cut."""
    rows = LADDER_NOTE if any(LADDER_STEP.fullmatch(step.model) for step in ladder.steps) else ""
    return " ".join(filter(None, (rows, tell_beyond(chart_ladder(ladder).beyond))))


def _table(ladder: Ladder) -> None:
    """Show a table of the 2 s error, and of the mean absolute velocity error by axis."""
    rows = [
        (
            title(s.model),
            [
                cell(s.windows_2s, f"{s.model}/windows_2s"),
                *(cell(s.velocity_mae[a], f"{s.model}/velocity_mae/{a}") for a in AXES),
            ],
        )
        for s in ladder.steps
    ]
    heads = [f"{a} ({u})" for a, u in zip(AXES, VELOCITY_UNITS, strict=True)]
    groups = [("in standard deviations", 1), ("mean absolute error of the velocity", len(AXES))]
    table(
        "Models on the test runs, restarted every 2 s", ["model", ERROR_NAME, *heads], rows, groups
    )


def _train(bench: Workbench) -> None:
    section("Learn what is left")
    text("Trained on the train runs, on top of any model, and shown here on the test runs.", "soft")
    physical = [n for n, m in bench.models.items() if m.residual is None and not m.inert]
    with ui.row().classes("controls"):
        base = ui.select(titled(physical), label="On top of", value=physical[-1]).classes("control")
        base.props("outlined dense")
        for kind, learner in learners().items():
            train = jobs.Beginning(
                bench,
                f"Train {learner.meaning} ({learner.title})",
                on_click=lambda _, k=kind: jobs.start_training(bench, k, base.value),
            )
            train.props("outline no-caps")


def _report(bench: Workbench) -> None:
    section("A report to send")
    text(
        "One file with everything: the verdict in plain words, figures, tables, data quality.",
        "soft",
    )
    with ui.row().classes("controls"):
        write = jobs.Beginning(
            bench, "Write the report", icon="description", on_click=lambda: jobs.start_report(bench)
        )
        write.props("outline no-caps")
        if "report" in bench.choices:
            path = bench.choices["report"]
            address = app.add_static_file(local_file=path, max_cache_age=0)
            ui.button("Open it", on_click=lambda: ui.navigate.to(address, new_tab=True)).props(
                "flat no-caps"
            )
            ui.label(str(path)).classes("soft")


def chart_of(ladder: Ladder) -> Options:
    """Return a chart with a bar for each step, and a line for the noise floor, which is a bound."""
    ladder_chart = chart_ladder(ladder)
    floor = or_none(ladder_chart.noise_floor)
    bars = [
        {
            "value": or_none(bar.value),
            "itemStyle": {"color": bar.look.color},
            "label": _label(bar, cut=bar in ladder_chart.beyond),
        }
        for bar in ladder_chart.bars
    ]
    line = {} if floor is None else {"markLine": _line(floor)}
    return {
        "grid": {"left": 8, "right": 56, "top": 30, "bottom": 28, "containLabel": True},
        "xAxis": {
            "type": "value",
            "min": 0,
            "max": ladder_chart.end,
            **named_below(f"{ERROR_NAME} (standard deviations)", 26),
            "axisLabel": {"color": SOFT, "showMaxLabel": False},
            "splitLine": {"lineStyle": {"color": GRID}},
        },
        "yAxis": {
            "type": "category",
            "inverse": True,
            "axisTick": {"show": False},
            "data": [bar.label for bar in ladder_chart.bars],
            "axisLabel": {"color": INK},
        },
        "series": [{"type": "bar", "data": bars, "barMaxWidth": 22, **line}],
    }


def _line(noise_floor: float) -> Options:
    """Return a line at the noise floor."""
    return {
        "symbol": "none",
        "silent": True,
        "data": [{"xAxis": noise_floor}],
        "precision": -1,  # the exact place; by default ECharts rounds to two decimals
        "lineStyle": {"color": "#333333", "type": "dashed", "width": 1.5},
        "label": {
            "formatter": f"noise floor {significant(noise_floor)}",
            "position": "start",
            "color": INK,
        },
    }


def _label(bar: LadderBar, cut: bool) -> Options:
    """Return the label with the number of a bar: behind the bar, or on a bar that is cut."""
    text = significant(bar.value)
    if cut:
        return {
            "show": True,
            "position": "insideRight",
            "color": INK,
            "padding": [3, 4],
            "backgroundColor": "#ffffff",
            "formatter": f"{text} →",
        }
    return {"show": True, "position": "right", "color": INK, "formatter": text}
