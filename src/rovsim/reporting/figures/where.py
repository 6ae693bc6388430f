"""Draw the error over the conditions that explain most of it, a row of panels for each axis."""

from typing import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rovsim.core.axes import ACCELERATION_UNITS, AXES
from rovsim.reporting.charts import BinCurve, chart_bins, find_varying_shares
from rovsim.reporting.figures.legends import add_legend, explain_empty, lines, note
from rovsim.reporting.figures.palette import Look, looks
from rovsim.reporting.figures.style import sheet, styled
from rovsim.reporting.wording import title
from rovsim.results.error_conditions import ConditionTable, ErrorConditions, ModelConditions

SECTION = "where"
CAPTION = (
    "Mean acceleration error, measured minus model, by the three conditions that explain most of "
    "it on each axis; bars: two standard errors, hollow: too few independent "
    "samples to judge, grey below: how often the vehicle was there."
)
COLUMN_COUNT = 3
MAX_MODELS = 4  # in one panel


@styled()
def draw(*, where: ErrorConditions) -> Figure:
    """Draw `where.json`: for each axis the conditions that explain most of some model's error."""
    models = dict(list(where.models.items())[-MAX_MODELS:])
    style = looks(models)
    searched = [axis for axis in AXES if any(m.axes[axis] for m in models.values())] or AXES
    figure = sheet(40 * len(searched))
    rows = figure.subplots(len(searched), COLUMN_COUNT, sharey="row", squeeze=False)
    for axis, panels in zip(searched, rows, strict=True):
        tables = {name: m.axes[axis] for name, m in models.items()}
        names = strongest(list(tables.values()))
        significant = {f.condition for m in models.values() for f in m.findings if f.axis == axis}
        for panel, name in zip(panels, [*names, *[""] * COLUMN_COUNT][:COLUMN_COUNT], strict=True):
            _draw_panel(panel, {m: t[name] for m, t in tables.items() if name in t}, style)
            panel.set_title(
                _title(name, list(tables.values())),
                fontsize=7.5,
                weight="bold" if name in significant else "normal",
            )
        panels[0].set_ylabel(f"{axis}\n({ACCELERATION_UNITS[AXES.index(axis)]})")
        panels[0].locator_params(axis="y", nbins=4)
    figure.align_ylabels(list(rows[:, 0]))
    add_legend(figure, lines(style))
    note(figure, _remarks(models))
    return figure


def strongest(models: Sequence[Mapping[str, ConditionTable]]) -> list[str]:
    """List the three conditions with several bins that explain most of some model's error."""
    shares: dict[str, float] = {}
    for tables in models:
        for name, share in find_varying_shares(tables).items():
            if len(tables[name].mean) > 1:
                shares[name] = max(shares.get(name, 0.0), share)
    return sorted(shares, key=lambda name: -shares[name])[:COLUMN_COUNT]


def _title(name: str, models: Sequence[Mapping[str, ConditionTable]]) -> str:
    """Return a panel's title: name and unit of a condition, below it the share of each model."""
    matching = [tables for tables in models if name in tables]
    if not matching:
        return ""
    shares = ", ".join(f"{100 * find_varying_shares(tables)[name]:.0f}" for tables in matching)
    label = name.replace("distance to the nearest", "distance to")
    return f"{label} ({chart_bins(matching[0][name]).unit})\n{shares} %"


def _draw_panel(
    axes: Axes, tables: Mapping[str, ConditionTable], style: Mapping[str, Look]
) -> None:
    axes.axhline(0.0, color="#444444", linewidth=0.6, zorder=1.5)
    if not tables:
        explain_empty(axes, "no values")
        axes.set_xticks([])
        return
    _draw_counts(axes, list(tables.values())[-1])
    curves = {name: chart_bins(table) for name, table in tables.items()}
    for order, (name, curve) in enumerate(curves.items()):
        _draw_curve(axes, curve, style[name], 2 + order)
    axes.locator_params(axis="x", nbins=5)
    centers = np.concatenate([curve.center[curve.seen] for curve in curves.values()])
    room = 0.08 * max(float(np.ptp(centers)), 1e-9)
    axes.set_xlim(float(centers.min()) - room, float(centers.max()) + room)


def _draw_curve(axes: Axes, curve: BinCurve, look: Look, order: int) -> None:
    x, mean, judged = curve.center, curve.mean, curve.judged
    axes.plot(x[judged], mean[judged], zorder=order, **look.line())
    for part, face in ((judged, look.color), (curve.seen & ~judged, "white")):
        axes.errorbar(
            x[part],
            mean[part],
            yerr=curve.error[part] if face == look.color else None,
            fmt="o",
            markersize=3,
            color=look.color,
            markerfacecolor=face,
            elinewidth=0.8,
            zorder=order,
        )


def _draw_counts(axes: Axes, table: ConditionTable) -> None:
    """Draw the number of blocks in each bin as grey bars along the lower edge."""
    count, edges = np.array(table.blocks, float), chart_bins(table).edges
    share = 0.25 * count / max(count.max(), 1.0)
    axes.bar(
        edges[:-1],
        share,
        np.diff(edges),
        align="edge",
        color="#e3e3e3",
        linewidth=0,
        zorder=0.4,
        transform=axes.get_xaxis_transform(),
    )


def _remarks(models: Mapping[str, ModelConditions]) -> Sequence[str]:
    if not models:
        return ["No model was searched."]
    splits = {m.split for m in models.values()}
    sentences = [f"{title(n)}: runs of the {m.split} split" for n, m in models.items()]
    return [
        f"Runs of the {splits.pop()} split." if len(splits) == 1 else f"{'; '.join(sentences)}.",
        "Percent: share of the squared error that varies with the condition, model "
        "by model, a constant error taken out; bold: beyond chance.",
    ]
