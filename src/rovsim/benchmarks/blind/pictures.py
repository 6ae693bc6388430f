"""The pictures of docs/benchmark_blind.md: rank histograms, and a reliability curve."""

from math import ceil
from pathlib import Path
from typing import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.stats import binom, binomtest

from rovsim.benchmarks.blind.calibration import MIN_BIN_VALUES
from rovsim.reporting.figures.legends import explain_empty, note
from rovsim.reporting.figures.style import save, sheet, styled
from rovsim.results.blind_benchmark import BlindSummary, Calibration, Ranks

RANKS, RELIABILITY = "blind_ranks", "blind_reliability"
COLUMN_COUNT, ROW_HEIGHT_MM = 5, 24  # panels beside each other, mm
BAND_PROBABILITY = 0.99  # of an honest histogram's bars lie inside the band
BAR_COLOR, BAND_COLOR, LINE_COLOR = "#0072B2", "#dddddd", "#D55E00"
MIN_DOUBT = 1e-4  # least distance from one at which a probability is drawn


def write_pictures(page: Path, results: BlindSummary) -> list[str]:
    """Draw the calibration of the diagnosis into the images beside a page.

    Returns:
        Names of the pictures; empty where the diagnosis fitted no hidden parameter.
    """
    summary = results.methods.get("diagnosis")
    if summary is None or not summary.calibration.ranks.values:
        return []
    figures = {RANKS: draw_ranks, RELIABILITY: draw_reliability}
    for name, draw in figures.items():
        for file in save(draw(summary.calibration), page.parent / "images", name):
            if file.suffix == ".pdf":
                file.unlink()
    return list(figures)


@styled()
def draw_ranks(calibration: Calibration) -> Figure:
    """Draw a rank histogram of all values together, and of each parameter with enough values."""
    by_name = {"all": calibration.ranks} | _with_enough(calibration.parameters)
    rows = ceil(len(by_name) / COLUMN_COUNT)
    figure = sheet(14 + ROW_HEIGHT_MM * rows)
    panels = figure.subplots(rows, COLUMN_COUNT, sharex=True, squeeze=False).ravel()
    for axes, (name, ranks) in zip(panels, by_name.items(), strict=False):
        _histogram(axes, name, ranks)
    for axes in panels[len(by_name) :]:
        axes.set_axis_off()
    omitted = len(calibration.parameters) - len(by_name) + 1
    note(
        figure,
        [
            "Rank of the truth, Φ((truth − value) / std), and how many values have it.",
            f"Grey: {100 * BAND_PROBABILITY:.0f} % of the bars of honest intervals lie there.",
            f"{omitted} parameters have fewer than {2 * MIN_BIN_VALUES} values." if omitted else "",
        ],
    )
    return figure


def _with_enough(parameters: Mapping[str, Ranks]) -> dict[str, Ranks]:
    return {name: r for name, r in parameters.items() if r.values >= 2 * MIN_BIN_VALUES}


def _histogram(axes: Axes, name: str, ranks: Ranks) -> None:
    """Draw the number of values in each bin, over the band in which honest ones lie."""
    bins = len(ranks.counts)
    low, high = binom.interval(BAND_PROBABILITY, ranks.values, 1.0 / bins)
    axes.axhspan(low, high, color=BAND_COLOR, zorder=0)
    axes.bar((np.arange(bins) + 0.5) / bins, ranks.counts, width=0.8 / bins, color=BAR_COLOR)
    effect, _, parameter = name.partition(".")
    title = f"{effect}\n{parameter}" if parameter else effect
    axes.set_title(f"{title} ({ranks.values})", fontsize=6.5)
    axes.set_xlim(0.0, 1.0)
    axes.set_xticks([0.0, 0.5, 1.0])
    axes.tick_params(labelsize=6)
    axes.locator_params(axis="y", nbins=3, integer=True)
    axes.grid(False)


@styled()
def draw_reliability(calibration: Calibration) -> Figure:
    """Draw the share of right names against their claimed probability, with 95 % intervals."""
    figure = sheet(75)
    axes = figure.subplots()
    # distance from one, in which 0.99 and 0.999 are far apart
    doubts = np.array([max(1.0 - (c.claimed or 0.0), MIN_DOUBT) for c in calibration.probability])
    for doubt, bin_ in zip(doubts, calibration.probability, strict=True):
        interval = binomtest(bin_.right, bin_.names).proportion_ci(method="wilson")
        share = bin_.right / bin_.names
        axes.plot([doubt] * 2, [interval.low, interval.high], color=BAR_COLOR, linewidth=1.2)
        axes.plot(doubt, share, "o", color=BAR_COLOR, markersize=4)
        axes.annotate(
            f"{bin_.right} of {bin_.names}",
            (doubt, share),
            xytext=(-4, -4),
            textcoords="offset points",
            fontsize=7,
            ha="right",
            va="top",
        )
    honest = np.geomspace(MIN_DOUBT, 1.0, 100)
    axes.plot(honest, 1.0 - honest, color=LINE_COLOR, label="honest")
    axes.set_xscale("log")
    axes.set_xlim(2.0, 0.7 * MIN_DOUBT)
    ticks = {0.5: "0.5", 0.1: "0.9", 0.01: "0.99", 1e-3: "0.999", MIN_DOUBT: "above"}
    axes.set_xticks(list(ticks), list(ticks.values()))
    axes.set_xticks([], minor=True)
    axes.set(
        xlabel="probability that was claimed of a name", ylabel="share of names that are right"
    )
    axes.set_ylim(0.0, 1.05)
    axes.legend(loc="lower right")
    if not calibration.probability:
        explain_empty(axes, "no name had a probability")
    return figure
