"""ECharts options: time series over linked axes, bars, paths. Plain dictionaries, testable."""

import json
from dataclasses import dataclass, field
from typing import Any, Mapping, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.apps.workbench.chart_axes import LINE, SOFT, Options, named_above, named_below
from rovsim.reporting.figures.palette import AREA_OPACITY, Look, looks
from rovsim.reporting.wording import title

MAX_POINTS = 800  # a curve shows at most: each takes its time to send and to draw
MARK_COLOR = "#D55E00"
# px: panels, what lies between, legend; icons
TALL_PANEL_PX, SHORT_PANEL_PX, PANEL_GAP_PX, LEGEND_PX, ICON_PX = 104, 56, 36, 40, 12
# ids of series, as a csv names them
BAND_LOW_SUFFIX, BAND_WIDTH_SUFFIX = "/low end of the band", "/width of the band"
LINE_WIDTH_PX = 2.2  # of a line on screen for one of width 1 on paper


@dataclass(frozen=True, eq=False)
class Panel:
    """Curves over one time axis of n samples.

    Attributes:
        title: of the vertical axis.
        unit: of all values.
        curves: values (n,) by name.
        short: whether the panel is a low one, as for the errors under a panel of values.
        bands: lower and upper end (2, n) of a curve's probability band, by name of the curve.
        about: heading of each curve in the CSV: its run, axis, quantity and model.
    """

    title: str
    unit: str
    curves: Mapping[str, Array]
    short: bool = False
    bands: Mapping[str, Array] = field(default_factory=dict)
    about: Mapping[str, str] = field(default_factory=dict)


def legend_name(curve: str) -> str:
    """Return the name of a curve in the legend: the title of its model, then its run, if any.

    Ids of curves, and the CSV, keep the name of the model's file.

    Args:
        curve: "MODEL", or "MODEL, RUN".
    """
    model, separator, run = curve.rpartition(", ")
    return f"{title(model)}{separator}{run}" if model else title(curve)


def styles(names: Sequence[str]) -> dict[str, Look]:
    """Return a distinct look for each curve."""
    return looks(names)


def points(time: Array, values: Array) -> list[list[float]]:
    """Return pairs (time, value) for ECharts, at most about `MAX_POINTS`; NaN leaves a gap.

    Args:
        time: of the samples (n,), s.
        values: at these (n,).
    """
    step = max(1, len(time) // MAX_POINTS)
    return np.stack([np.round(time[::step], 3), np.round(values[::step], 5)], axis=1).tolist()


def line_style(look: Look) -> Options:
    """Return colour, width and dashes of a line as ECharts options."""
    dash = "solid" if isinstance(look.dash, str) else [2 * d for d in look.dash[1]]
    return {"color": look.color, "width": LINE_WIDTH_PX * look.width, "type": dash}


def height(panels: Sequence[Panel]) -> int:
    """Return the height in px of a chart with these panels."""
    return (
        LEGEND_PX
        + sum((SHORT_PANEL_PX if p.short else TALL_PANEL_PX) + PANEL_GAP_PX for p in panels)
        + 24
    )


def series_data(time: Array, panels: Sequence[Panel], but: Sequence[str] = ()) -> list[Options]:
    """Return the points of every curve and band, by id, without the curves named in `but`."""
    return [
        {"id": f"{k}/{name}", "data": points(time, values)}
        for k, panel in enumerate(panels)
        for name, values in (*panel.curves.items(), *_ends(panel))
        if name not in but
    ]


def columns(panels: Sequence[Panel]) -> Options:
    """Return the headings of the CSV: of the time, and of each series by its id."""
    return {
        "x": "time (s)",
        "curves": {
            f"{k}/{name}{end}": f"{about}{end.replace('/', ', ')} ({panel.unit})"
            for k, panel in enumerate(panels)
            for name, about in panel.about.items()
            for end in ("", *((BAND_LOW_SUFFIX, BAND_WIDTH_SUFFIX) if name in panel.bands else ()))
        },
    }


def _ends(panel: Panel) -> list[tuple[str, Array]]:
    """List the lower ends of bands, and their widths, which ECharts stacks on these."""
    bands = [(name, low, high - low) for name, (low, high) in panel.bands.items()]
    return [
        s
        for name, low, wide in bands
        for s in ((name + BAND_LOW_SUFFIX, low), (name + BAND_WIDTH_SUFFIX, wide))
    ]


def time_series(time: Array, panels: Sequence[Panel], look: Mapping[str, Look]) -> Options:
    """Return a chart of panels one above the other, which share zoom and pointer.

    Args:
        time: of the samples (n,), s.
        panels: from top to bottom.
        look: by name of a curve.
    """
    data = {series["id"]: series["data"] for series in series_data(time, panels)}
    last = len(panels) - 1
    return {
        **_controls(panels),
        "grid": _grids(panels),
        "xAxis": [_time_axis(k, time, k == last) for k in range(len(panels))],
        "yAxis": [_value_axis(k, panel) for k, panel in enumerate(panels)],
        "series": [s for k, panel in enumerate(panels) for s in _panel(k, panel, look, data)],
    }


def _controls(panels: Sequence[Panel]) -> Options:
    """Return legend, zoom, pointer and tooltip, which the panels share."""
    titles = [_title(panel) for panel in panels]
    return {
        "legend": {
            "type": "scroll",
            "top": 0,
            "left": 56,
            "right": 8,
            "itemWidth": 34,
            "itemStyle": {"opacity": 0},
        },
        "toolbox": {
            "right": 8,
            "top": ICON_PX,
            "iconStyle": {"borderColor": SOFT},
            "feature": {
                "dataZoom": {"yAxisIndex": "none", "title": {"zoom": "zoom", "back": "back"}}
            },
        },
        "axisPointer": {"link": [{"xAxisIndex": "all"}]},
        "tooltip": {
            "trigger": "axis",
            "confine": True,
            ":formatter": f"points => tellPanels(points, {json.dumps(titles)})",
        },
        "dataZoom": [
            {
                "type": "inside",
                "xAxisIndex": list(range(len(panels))),
                "filterMode": "none",
                "zoomOnMouseWheel": "ctrl",
                "moveOnMouseMove": "shift",
                "preventDefaultMouseMove": False,
            }
        ],
    }


def _panel(
    k: int, panel: Panel, look: Mapping[str, Look], ready: Mapping[str, Any]
) -> list[Options]:
    """List the series of a panel: its curves, their bands, and the cursor.

    Args:
        k: number of the panel.
        panel: what it shows.
        look: by name of a curve.
        ready: points of every series by id.
    """
    return [
        *(_curve(k, name, look[name], ready) for name in panel.curves),
        *(
            _area(k, name, end, look[name], ready)
            for name in panel.bands
            for end in (BAND_LOW_SUFFIX, BAND_WIDTH_SUFFIX)
        ),
        cursor(k, None) | {"xAxisIndex": k, "yAxisIndex": k},
    ]


def _curve(k: int, name: str, look: Look, ready: Mapping[str, Any]) -> Options:
    """Return the series of a curve; what was measured lies above the others."""
    return {
        "id": f"{k}/{name}",
        "name": legend_name(name),
        "type": "line",
        "symbol": "none",
        "xAxisIndex": k,
        "yAxisIndex": k,
        "lineStyle": line_style(look),
        "itemStyle": {"color": look.color},
        "data": ready[f"{k}/{name}"],
        "z": 3 if name == "measured" else 2,
    }


def _area(k: int, name: str, end: str, look: Look, ready: Mapping[str, Any]) -> Options:
    """Return one of the two series of a band: an invisible lower line, and the area stacked on it.

    Args:
        k: number of the panel.
        name: of the curve that the band belongs to.
        end: `BAND_LOW_SUFFIX` or `BAND_WIDTH_SUFFIX`.
        look: of that curve.
        ready: points of every series by id.
    """
    shade = {"color": look.color, "opacity": AREA_OPACITY if end == BAND_WIDTH_SUFFIX else 0.0}
    return {
        "id": f"{k}/{name}{end}",
        "name": legend_name(name),
        "type": "line",
        "silent": True,
        "symbol": "none",
        "xAxisIndex": k,
        "yAxisIndex": k,
        "stack": f"{k}/{name}",
        "stackStrategy": "all",
        "lineStyle": {"opacity": 0},
        "areaStyle": shade,
        "itemStyle": {"color": look.color},
        "data": ready[f"{k}/{name}{end}"],
        "z": 1,
    }


def cursor(panel: int, time: float | None) -> Options:
    """Return a series that marks an instant with a vertical line; None: no line."""
    marks = [] if time is None else [{"xAxis": time}]
    look = {"color": MARK_COLOR, "width": 1.5, "type": "solid"}
    return {
        "id": f"{panel}/cursor",
        "type": "line",
        "data": [],
        "silent": True,
        "markLine": {
            "symbol": "none",
            "label": {"show": False},
            "data": marks,
            "lineStyle": look,
            "animation": False,
        },
    }


def _title(panel: Panel) -> str:
    return f"{panel.title} ({panel.unit})"


def _grids(panels: Sequence[Panel]) -> list[Options]:
    top, grids = LEGEND_PX + PANEL_GAP_PX // 2, []
    for panel in panels:
        size = SHORT_PANEL_PX if panel.short else TALL_PANEL_PX
        grids.append({"left": 60, "right": 16, "top": top, "height": size})
        top += size + PANEL_GAP_PX
    return grids


def _time_axis(k: int, time: Array, last: bool) -> Options:
    return {
        "type": "value",
        "gridIndex": k,
        "min": float(time[0]),
        "max": float(time[-1]),
        "axisLabel": {
            "show": last,
            "color": SOFT,
            "hideOverlap": True,
            "showMinLabel": False,
            "showMaxLabel": False,
        },
        "axisTick": {"show": last},
        "axisLine": {"onZero": False, "lineStyle": {"color": LINE}},
        "splitLine": {"show": False},
        "axisPointer": {"label": {":formatter": "p => Number(p.value).toFixed(2) + ' s'"}},
        **(named_below("time (s)", 22) if last else {}),
    }


def _value_axis(k: int, panel: Panel) -> Options:
    return {
        **named_above(_title(panel), 52),
        "gridIndex": k,
        "scale": True,
        "splitNumber": 2 if panel.short else 3,
        "nameGap": 10,
    }
