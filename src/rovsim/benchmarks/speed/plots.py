"""The plots of docs/benchmark_speed.md."""

from typing import Mapping, Sequence

from matplotlib.figure import Figure

from rovsim.reporting.figures.legends import add_legend, set_log_scale
from rovsim.reporting.figures.palette import (
    BLACK,
    BLUE,
    BROWN,
    FAMILIES,
    GREEN,
    OLIVE,
    PURPLE,
    SKY,
    VERMILION,
)
from rovsim.reporting.figures.style import sheet, styled
from rovsim.results.timing import Accuracy, Bench, Latency

# One colour for us, others for the libraries
PANEL_COLORS = {
    "neighbours, k = 5": {
        "knn": BLUE, "pykdtree_knn": GREEN, "scipy_knn": BROWN,
        "sklearn_knn": VERMILION,
    },
    "Gaussian process, one kernel": {
        "gp_mean": BLUE, "gp_faded": SKY, "gp_variance": BLACK,
        "numpy_gp_mean": GREEN, "sklearn_gp_mean": BROWN, "gpytorch_mean": PURPLE,
        "gpytorch_love": OLIVE, "gpytorch_variance": VERMILION,
    },
}  # fmt: skip
COLORS = {kind: FAMILIES[kind].color for kind in ("knn", "gp", "svgp")} | {
    "gp_six_kernels": VERMILION
}


@styled()
def draw_sizes(bench: Bench) -> Figure:
    """Draw median (line) and p99.9 (dotted, above it) against points, one panel a family."""
    figure = sheet(110)
    for axes, (title, names) in zip(figure.subplots(1, 2), PANEL_COLORS.items(), strict=True):
        for name, color in names.items():
            sizes = _sizes(bench.inference, name)
            for statistic, style in (("median_us", "o-"), ("p999_us", ":")):
                label = name.replace("_", " ") if style == "o-" else None
                axes.plot(
                    list(sizes),
                    [getattr(s, statistic) for s in sizes.values()],
                    style,
                    color=color,
                    markersize=3,
                    label=label,
                )
        axes.axhline(1000.0, color="#444444", linestyle="--", linewidth=0.8)
        set_log_scale(axes, "xy")
        axes.set(xlabel="points", ylabel="one prediction (µs)")
        axes.set_title(title)
        axes.legend(fontsize=6.5, loc="upper center", bbox_to_anchor=(0.5, -0.18), ncols=2)
    return figure


def _sizes(inference: Mapping[str, Latency], name: str) -> dict[int, Latency]:
    """Return the latencies of one way to predict, by number of points."""
    by_points = {
        int(key.split("@")[1]): stats
        for key, stats in inference.items()
        if key.split("@")[0] == name
    }
    return dict(sorted(by_points.items()))


@styled()
def draw_accuracy(bench: Bench) -> Figure:
    """Draw the share of the residual that is left against cost; 1 is no correction at all."""
    figure = sheet(75)
    panels = figure.subplots(1, 2, sharey=True)
    for axes, where in zip(panels, ("seen", "unseen"), strict=True):
        for (name, fades), rows in _by_way(bench.accuracy).items():
            axes.plot(
                [row.median_us for row in rows],
                [getattr(row, where).mean for row in rows],
                "o-" if fades else "x--",
                color=COLORS[name],
                markersize=4,
                label=f"{name.replace('_', ' ')}{', fades' if fades else ''}",
            )
        axes.axhline(1.0, color="#444444", linewidth=0.8, linestyle=":")
        set_log_scale(axes)
        axes.set(xlabel="one prediction (µs)", title=where)
    panels[0].set_ylabel("share of the residual left")
    add_legend(figure, panels[0].get_legend_handles_labels()[0])
    return figure


def _by_way(rows: Sequence[Accuracy]) -> dict[tuple[str, bool], list[Accuracy]]:
    """Group rows by kind of residual, and by whether it fades."""
    by_way: dict[tuple[str, bool], list[Accuracy]] = {}
    for row in rows:
        by_way.setdefault((row.name, row.fades), []).append(row)
    return by_way
