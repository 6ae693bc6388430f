"""Draw the time of one prediction: by the library and by the exported predictor, with deadlines."""

from typing import Mapping

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rovsim.reporting.figures.legends import add_legend, explain_empty, set_log_scale
from rovsim.reporting.figures.palette import BLUE, VERMILION
from rovsim.reporting.figures.style import sheet, styled
from rovsim.reporting.wording import title
from rovsim.results.timing import CONTROL_RATES_HZ, BothWays, Latency, Timing

SECTION = "timing"
CAPTION = (
    "Time of one prediction, one call at a time after warm-up: median, 99th and 99.9th percentile "
    "of the library's own call and of the exported predictor, against the periods of control loops."
)
WAY_STYLES = {"library": (VERMILION, 0.17), "exported": (BLUE, -0.17)}
MARKERS = {"median_us": ("o", "median"), "p99_us": ("|", "p99"), "p999_us": (">", "p99.9")}


@styled()
def draw(*, timing: Timing) -> Figure:
    """Draw `timing.json`: the times of each predictor, in µs."""
    names = list(timing.inference)
    figure = sheet(34 + 11 * max(len(names), 2))
    axes = figure.subplots()
    set_log_scale(axes)
    for row, timings in enumerate(timing.inference.values()):
        for way, stats in timings.measured.items():
            color, shift = WAY_STYLES[way]
            _draw_line(axes, len(names) - 1 - row + shift, stats, color)
    axes.set_yticks(range(len(names)), [title(n, 24) for n in reversed(names)])
    axes.set_ylim(-0.6, max(len(names), 1) - 0.4)
    axes.set_xlabel("time of one prediction (µs)")
    axes.grid(False, axis="y")
    _draw_deadlines(axes, timing.inference)
    if not names:
        explain_empty(axes, "no predictor was timed")
    add_legend(figure, _entries())
    return figure


def _draw_line(axes: Axes, y: float, stats: Latency, color: str) -> None:
    values = {key: getattr(stats, key) for key in MARKERS}
    axes.plot(list(values.values()), [y] * 3, color=color, linewidth=1.2)
    for key, (marker, _) in MARKERS.items():
        axes.plot(values[key], y, marker, color=color, markersize=5 if marker != "|" else 8)


def _draw_deadlines(axes: Axes, inference: Mapping[str, BothWays]) -> None:
    times = [
        getattr(stats, key)
        for timings in inference.values()
        for stats in timings.measured.values()
        for key in MARKERS
    ]
    low = min([t for t in times if t > 0], default=100.0)
    high = max(times, default=100.0)
    axes.set_xlim(low / 2, max(high, 1e6 / min(CONTROL_RATES_HZ)) * 1.6)
    for rate in CONTROL_RATES_HZ:
        axes.axvline(1e6 / rate, color="#444444", linewidth=0.8, linestyle="--", zorder=1)
        axes.annotate(
            f"{rate} Hz",
            (1e6 / rate, 1.0),
            xycoords=axes.get_xaxis_transform(),
            xytext=(0, 2),
            textcoords="offset points",
            ha="center",
            va="bottom",
            fontsize=8,
            color="#444444",
        )


def _entries() -> list[Line2D]:
    ways = [Line2D([], [], color=color, label=way) for way, (color, _) in WAY_STYLES.items()]
    marks = [
        Line2D([], [], color="#444444", linestyle="", marker=marker, label=label)
        for marker, label in MARKERS.values()
    ]
    return [*ways, *marks, Line2D([], [], color="#444444", linestyle="--", label="deadline")]
