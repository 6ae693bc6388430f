"""Draw a map of the share of the error that each condition explains on each axis."""

from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure

from rovsim.reporting.charts import chart_conditions
from rovsim.reporting.figures.legends import explain_empty, note
from rovsim.reporting.figures.palette import VERMILION
from rovsim.reporting.figures.style import sheet, styled
from rovsim.reporting.wording import title
from rovsim.results.error_conditions import ErrorConditions

SECTION = "where"
CAPTION = (
    "Share of the squared acceleration error, in percent, that each condition explains on each "
    "axis, for the last model. Framed: the conditions that were found to explain it; what varied "
    'together with them is high as well. An error that is constant is in the row "throughout" and '
    "taken out of the others."
)
SHARE_COLORS = LinearSegmentedColormap.from_list("shares", ["#ffffff", "#0072B2"])


@styled()
def draw(*, where: ErrorConditions) -> Figure:
    """Draw the map of the last model of `where.json`; findings are framed."""
    name, model = list(where.models.items())[-1] if where.models else ("", None)
    chart = chart_conditions(model) if model else None
    rows = chart.conditions if chart else ()
    figure = sheet(30 + 4.6 * max(len(rows), 5))
    axes = figure.subplots()
    axes.grid(False)
    if model is None or chart is None or not rows:
        explain_empty(axes, "nothing was searched")
        return figure
    axes.imshow(chart.share, cmap=SHARE_COLORS, vmin=0, vmax=1, aspect="auto")
    for y, row in enumerate(rows):
        for x, axis in enumerate(chart.axes):
            _draw_cell(axes, x, y, float(chart.share[y, x]), (axis, row) in chart.significant)
    axes.set_xticks(range(len(chart.axes)), chart.axes)
    axes.xaxis.tick_top()
    axes.set_yticks(range(len(rows)), rows)
    axes.tick_params(length=0)
    axes.set_ylim(len(rows) - 0.4, -0.6)
    note(figure, [f"Model {title(name)}, runs of the {model.split} split."])
    return figure


def _draw_cell(axes, x: int, y: int, share: float, significant: bool) -> None:
    text = f"{100 * share:.0f}" if round(100 * share) >= 1 else "·"
    color = "white" if share > 0.6 else "#222222"
    axes.text(x, y, text, ha="center", va="center", fontsize=7.5, color=color)
    if significant:
        frame = {"facecolor": "none", "edgecolor": VERMILION, "linewidth": 1.6}
        axes.bar(x, 0.86, 0.95, y - 0.43, **frame)
