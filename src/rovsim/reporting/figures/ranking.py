"""Draw the ranking: the share of the error that each effect removes alone, selected ones first."""

from typing import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from rovsim.core.signs import minus
from rovsim.reporting.figures.legends import add_legend, explain_empty, note
from rovsim.reporting.figures.palette import FAMILIES, Style
from rovsim.reporting.figures.style import sheet, styled
from rovsim.reporting.wording import MIN_SHOWN_SHARE, short
from rovsim.results.base import or_nan
from rovsim.results.diagnosis import Diagnosis

SECTION = "verdict"
CAPTION = (
    "Share of the model's error that each of the likeliest effects removes by itself, at its first "
    "estimate; for the selected ones, above, also what each adds in the final model, fitted "
    "together. Effects that remove less than 1 % are left out."
)
OTHER_COLOR = "#BBBBBB"
MIN_SHARE, MAX_SHARE = -0.2, 1.0  # a share outside is drawn as an arrow at that end


@styled()
def draw(*, diagnosis: Diagnosis) -> Figure:
    """Draw `ranking` and `selected` of `diagnosis.json`, a bar for each effect.

    The selected effects come first, in the order of the verdict, then the others by their share. A
    diamond marks what a selected effect removes in the final model. A selected effect that is not
    in the ranking has no bar: it was found only beside others.
    """
    alone = {fit.effect: or_nan(fit.error_reduction) for fit in diagnosis.ranking}
    selected = {fit.effect: or_nan(fit.error_reduction) for fit in diagnosis.selected}
    others = [
        name for name, share in alone.items() if share >= MIN_SHOWN_SHARE and name not in selected
    ]
    names = [*selected, *sorted(others, key=lambda name: -alone[name])]
    figure = sheet(28 + 6.0 * max(len(names), 3))
    axes = figure.subplots()
    for y, name in enumerate(names):
        color = FAMILIES["effects"].color if name in selected else OTHER_COLOR
        _draw_row(axes, y, alone.get(name, np.nan), selected.get(name, np.nan), color)
    axes.set_yticks(range(len(names)), [short(name, 28) for name in names])
    for label in axes.get_yticklabels():
        label.set_fontweight("bold" if label.get_text() in selected else "normal")
    axes.set_ylim(max(len(names), 1) - 0.4, -0.6)
    harm = any(share < 0.0 for share in selected.values())
    if harm:
        axes.axvline(0, color="black", linewidth=0.5)
    _scale(axes, [*alone.values(), *selected.values()], harm)
    axes.tick_params(axis="y", length=0)
    axes.grid(False, axis="y")
    axes.set_xlabel("share of the error removed (%)")
    if not names:
        axes.set_xticks([])
        explain_empty(axes, "no effect removes 1 % by itself" if alone else "no effect was judged")
    add_legend(figure, _handles(bool(selected)) if names else [])
    note(figure, _remarks(diagnosis))
    return figure


def _scale(axes: Axes, shares: Sequence[float], harm: bool) -> None:
    """Set the axis as wide as the largest share and its number need, with no tick above 100 %."""
    most = 100 * float(np.clip(np.nan_to_num([*shares, 0.1]).max(), 0.0, MAX_SHARE))
    axes.set_xlim(-25 if harm else 0, 1.25 * most)
    marks = MaxNLocator(6, steps=[1, 2, 5, 10]).tick_values(100 * MIN_SHARE if harm else 0, most)
    axes.set_xticks([mark for mark in marks if 100 * MIN_SHARE <= mark <= most])


def _draw_row(axes: Axes, y: int, alone: float, together: float, color: str) -> None:
    axes.barh(y, 100 * np.nan_to_num(alone), 0.66, color=color, linewidth=0)
    clipped = float(np.clip(together, MIN_SHARE, MAX_SHARE))
    if np.isfinite(together):
        marker = "D" if clipped == together else "<" if together < clipped else ">"
        axes.plot(100 * clipped, y, marker, color="black", markersize=4, clip_on=False)
    right = 100 * max(np.nan_to_num(alone), np.nan_to_num(clipped))
    axes.annotate(
        _text(alone, together),
        (right, y),
        xytext=(6, 0),
        va="center",
        textcoords="offset points",
        fontsize=8,
        bbox={"facecolor": "white", "pad": 1, "linewidth": 0},
    )


def _text(alone: float, together: float) -> str:
    by_itself = minus(f"{100 * alone:.0f}") if np.isfinite(alone) else ""
    if not np.isfinite(together):
        return by_itself
    return minus(f"{100 * together:.0f}") + (f" ({by_itself} alone)" if by_itself else "")


def _handles(chosen: bool) -> list[Line2D | Patch]:
    others = Patch(color=OTHER_COLOR, linewidth=0, label="alone")
    if not chosen:
        return [others]
    mark: Style = {
        "marker": "D",
        "color": "black",
        "markersize": 4,
        "linestyle": "none",
    }
    return [
        others,
        Patch(color=FAMILIES["effects"].color, linewidth=0, label="alone, selected"),
        Line2D([], [], label="in the final model", **mark),
    ]


def _remarks(diagnosis: Diagnosis) -> list[str]:
    if not diagnosis.ranking:
        return ["Too little was recorded to judge any effect."]
    selected = "" if diagnosis.selected else "; none was selected"
    return [f"Train runs, 2 s windows{selected}."]
