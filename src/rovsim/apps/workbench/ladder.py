"""Ladder: the error falling step by step, down to the noise floor."""

from nicegui import app, ui

from rovsim import AXES
from rovsim.apps.workbench import jobs
from rovsim.apps.workbench.charts import INK, SOFT, Options
from rovsim.apps.workbench.parts import (
    cell,
    chart,
    computed,
    heading,
    section,
    table,
    text,
    while_idle,
)
from rovsim.apps.workbench.place import Place
from rovsim.apps.workbench.workbench import Workbench
from rovsim.reporting.charts import chart_ladder
from rovsim.reporting.units import VELOCITY_UNITS
from rovsim.reporting.wording import significant, title
from rovsim.results.base import or_none
from rovsim.results.ladder import Ladder

TITLE, QUESTION = "Ladder", "How far down does the error go?"
KINDS = {"knn": "nearest neighbours (KNN)", "gp": "Gaussian process (GP)"}


async def show(bench: Workbench, place: Place) -> None:
    """Show the screen."""
    heading(TITLE, QUESTION)
    text(
        "Each step on the test runs, to which nothing was fitted: velocity error of the model, "
        "restarted from the measured state every 2 s, in units of the measured velocity's "
        "standard deviation."
    )
    ladder = await computed(bench.ladder)
    about = "Error of each step, the noise floor as a line"
    names = {"names": ("step", "error (standard deviations of the measured velocity)")}
    chart(chart_of(ladder), about, 60 + 36 * len(ladder.steps), columns=names)
    rows = [
        (
            title(s.model),
            [
                cell(s.windows_2s, f"{s.model}/windows_2s"),
                *(cell(s.velocity_mae[a], f"{s.model}/velocity_mae/{a}") for a in AXES),
            ],
        )
        for s in ladder.steps
    ]  # fmt: skip
    heads = [f"{a} ({u})" for a, u in zip(AXES, VELOCITY_UNITS, strict=True)]
    table("The steps, and their mean absolute velocity errors in 2 s windows",
          ["step", "error", *heads], rows)  # fmt: skip
    _train(bench)
    _report(bench)


def _train(bench: Workbench) -> None:
    section("Learn what is left")
    text("Trained on the train runs, on top of any model, and shown here on the test runs.", "soft")
    physical = [n for n, m in bench.models.items() if m.residual is None and not m.inert]
    with ui.row().classes("controls"):
        on = ui.select(physical, label="On top of", value=physical[-1]).classes("control")
        on.props("outlined dense")
        for kind, name in KINDS.items():
            train = ui.button(
                f"Train {name}", on_click=lambda _, k=kind: jobs.train(bench, k, on.value)
            )
            while_idle(bench, train.props("outline no-caps"))


def _report(bench: Workbench) -> None:
    section("A report to send")
    text(
        "One file with everything: the verdict in plain words, figures, tables, data quality.",
        "soft",
    )
    with ui.row().classes("controls"):
        write = ui.button(
            "Write the report", icon="description", on_click=lambda: jobs.report(bench)
        )
        while_idle(bench, write.props("outline no-caps"))
        if "report" in bench.choices:
            path = bench.choices["report"]
            address = app.add_static_file(local_file=path, max_cache_age=0)
            ui.button("Open it", on_click=lambda: ui.navigate.to(address, new_tab=True)).props(
                "flat no-caps"
            )
            ui.label(str(path)).classes("soft")


def chart_of(ladder: Ladder) -> Options:
    """Bars from the first step down; the noise floor is a line, for it is a bound and no model."""
    shown = chart_ladder(ladder)
    floor = or_none(shown.noise_floor)
    bars = [{"value": or_none(b.value), "itemStyle": {"color": b.look.color}} for b in shown.bars]
    line = {
        "symbol": "none", "silent": True, "data": [{"xAxis": floor}],
        "lineStyle": {"color": "#333333", "type": "dashed", "width": 1.5},
        "label": {"formatter": f"noise floor {significant(shown.noise_floor)}", "position": "start",
                  "color": INK},
    }  # fmt: skip
    return {
        "grid": {"left": 8, "right": 56, "top": 30, "bottom": 8, "containLabel": True},
        "xAxis": {"type": "value", "min": 0, "axisLabel": {"color": SOFT},
                  "splitLine": {"lineStyle": {"color": "#eeeeee"}}},
        "yAxis": {"type": "category", "inverse": True, "axisTick": {"show": False},
                  "data": [bar.label for bar in shown.bars], "axisLabel": {"color": INK}},
        "series": [{
            "type": "bar", "data": bars, "barMaxWidth": 22,
            "label": {"show": True, "position": "right", "color": INK,
                      ":formatter": "p => Number(p.value).toPrecision(3)"},
            **({"markLine": line} if floor is not None else {}),
        }],
    }  # fmt: skip
