"""The map on the screen Where: the share of each axis' error that varies with each condition."""

from typing import Any, Callable

from nicegui import ui

from rovsim.apps.workbench.chart_axes import INK, Options
from rovsim.apps.workbench.parts import chart, section, text
from rovsim.reporting.charts import ConditionMap, chart_conditions
from rovsim.results.error_conditions import ModelConditions

# one hue: also without colours
SHARE_COLORS = ["#f7fbff", "#c6dbef", "#6baed6", "#2171b5", "#08306b"]
MAX_CONDITIONS = 12
KEY_MOVES = {"ArrowLeft": (-1, 0), "ArrowRight": (1, 0), "ArrowUp": (0, -1), "ArrowDown": (0, 1)}
# All other keys stay the browser's; arrows would move the page.
KEY_HANDLER = f"""(e) => {{
  if (!{[*KEY_MOVES, "Enter"]}.includes(e.key)) return;
  e.preventDefault();
  emit(e.key);
}}"""


class FieldMap:
    """A map of fields to click, or to walk through with the arrow keys.

    Fields are numbered (column, row) from the left and from the top.

    Args:
        conditions: the errors of one model over conditions.
        choose: called with axis and condition of a field that is chosen.
    """

    def __init__(self, conditions: ModelConditions, choose: Callable[[str, str], None]) -> None:
        section("What the error varies with")
        self.shown, self.choose = chart_conditions(conditions, MAX_CONDITIONS), choose
        if not self.shown.axes:
            return
        text(
            "Percent of that axis' squared error: the more, the stronger the blue. A constant "
            "error is in the row throughout alone. Click a field to see its bins; or use the arrow "
            "keys, and Enter.",
            "soft",
        )
        self.at = (0, 0)
        self.chart = chart(
            map_chart(self.shown),
            "Share of the error by axis and condition, percent",
            44 + 30 * len(self.shown.conditions),
            on_point_click=lambda e: self._choose(e.data[0], self._turned(e.data[1])),
            columns={"names": ("axis", "condition", "share of the squared error")},
        )
        self.chart.props('role="application" tabindex="0"')
        self.chart.on("keydown", self._key, js_handler=KEY_HANDLER)
        self.chart.on("focus", lambda: self._mark(), js_handler="() => emit()")
        self.status = ui.label().classes("soft").props('role="status"')

    def _turned(self, row: int) -> int:
        """Convert a number of a row: ECharts counts rows from below."""
        return len(self.shown.conditions) - 1 - row

    def _choose(self, column: int, row: int) -> None:
        self.at = (column, row)
        self.choose(self.shown.axes[column], self.shown.conditions[row])

    def _key(self, event: Any) -> None:
        if event.args == "Enter":
            self._choose(*self.at)
            return
        right, down = KEY_MOVES[event.args]
        self.at = (
            min(max(self.at[0] + right, 0), len(self.shown.axes) - 1),
            min(max(self.at[1] + down, 0), len(self.shown.conditions) - 1),
        )
        self._mark()

    def _mark(self) -> None:
        """Highlight the present field, and tell its share to screen readers."""
        column, row = self.at
        field = self._turned(row) * len(self.shown.axes) + column
        for action in ({"type": "downplay"}, {"type": "highlight", "dataIndex": field}):
            self.chart.run_chart_method("dispatchAction", {**action, "seriesIndex": 0})
        share = float(self.shown.share[row][column])
        axis, condition = self.shown.axes[column], self.shown.conditions[row]
        self.status.text = f"{axis} over {condition}: {100 * share:.0f} % of the error"


def map_chart(shown: ConditionMap) -> Options:
    """Return a chart with a field for each axis and condition; bluer for a larger share."""
    axes, conditions = list(shown.axes), list(reversed(shown.conditions))
    data = [
        [k, j, float(share)]
        for j, row in enumerate(shown.share[::-1])
        for k, share in enumerate(row)
    ]
    return {
        "grid": {"left": 158, "right": 4, "top": 28, "bottom": 8},
        "tooltip": {":formatter": "p => (100 * p.value[2]).toFixed(0) + ' % of the error'"},
        "xAxis": {"type": "category", "data": axes, "position": "top",
                  "axisLabel": {"color": INK, "interval": 0},
                  "axisLine": {"show": False}, "axisTick": {"show": False}},
        "yAxis": {"type": "category", "data": conditions,
                  "axisLabel": {"color": INK, "interval": 0, "width": 150,
                                "overflow": "truncate"},
                  "axisLine": {"show": False}, "axisTick": {"show": False}},
        "visualMap": {"show": False, "min": 0, "max": 1, "inRange": {"color": SHARE_COLORS}},
        "series": [{"type": "heatmap", "data": data,
                    "itemStyle": {"borderColor": "#ffffff", "borderWidth": 2},
                    "emphasis": {"itemStyle": {"borderColor": INK}},
                    "label": {"show": True, "fontSize": 11,
                              ":formatter": "p => p.value[2] < 0.03 ? '' :"
                                            " (100 * p.value[2]).toFixed(0)"}}],
    }  # fmt: skip
