"""Axes of charts: their names, what stands at their ticks, and the colours of both."""

from typing import Any

Options = dict[str, Any]  # of ECharts, plain and deep

INK, SOFT, LINE, GRID = "#1a1a1a", "#555555", "#d9d9d9", "#eeeeee"


def named_below(name: str, gap: int) -> Options:
    """The name of a horizontal axis, centred `gap` px below it; a part of its options."""
    return {
        "name": name,
        "nameLocation": "middle",
        "nameGap": gap,
        "nameTextStyle": {"color": SOFT},
    }


def named_above(name: str, outset: int) -> Options:
    """The options of a vertical axis of values, whose name begins `outset` px left of it."""
    return {
        "type": "value",
        "name": name,
        "nameTextStyle": {"align": "left", "color": INK, "padding": [0, 0, 0, -outset]},
        "axisLabel": {"color": SOFT},
        "splitLine": {"lineStyle": {"color": GRID}},
    }


def with_minus(options: Options) -> Options:
    """Return a chart whose numbers on axes and at the pointer have a true minus (charts.js)."""
    chart = dict(options)
    for name in {"xAxis", "yAxis"} & chart.keys():
        axes = chart[name] if isinstance(chart[name], list) else [chart[name]]
        chart[name] = [_axis_with_minus(axis) for axis in axes]
    if "tooltip" in chart:
        chart["tooltip"] = {":valueFormatter": "tellNumber", **chart["tooltip"]}
    return chart


def _axis_with_minus(axis: Options) -> Options:
    if axis.get("type") != "value":
        return axis
    return {**axis, "axisLabel": {":formatter": "tellTick", **axis.get("axisLabel", {})}}
