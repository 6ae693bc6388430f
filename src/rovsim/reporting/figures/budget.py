"""Draw the budget of forces: each part of a model over time, and the force that is missing."""

from typing import Mapping

import numpy as np
from matplotlib.figure import Figure
from numpy import ndarray as Array

from rovsim.core.axes import FORCE, FORCE_UNITS
from rovsim.reporting.figures.legends import add_legend, lines, note
from rovsim.reporting.figures.palette import (
    BLACK,
    BLUE,
    BROWN,
    GREEN,
    GREY,
    OLIVE,
    PURPLE,
    VERMILION,
    Look,
)
from rovsim.reporting.figures.panels import SHARED_SCALE_NOTE, plot_all, share_scales, six_panels
from rovsim.reporting.figures.series import excerpt
from rovsim.reporting.figures.style import styled
from rovsim.reporting.wording import significant
from rovsim.results.force_budget import ForceBudget

SECTION = "where"
CAPTION = (
    "Forces and moments of the model's parts at the measured states, and the force that is missing "
    "(M a_res, black). Where a part looks like the missing force, turned over or not, the model "
    "has too much or too little of it."
)
MAX_PARTS = 7
EXCERPT_S = 20.0  # forces change faster than velocities
SMOOTHING_S = 0.5  # the missing force is twice differentiated noise before
PART_LOOKS = {
    "thrusters": Look(BLUE, "-"),
    "quadratic damping": Look(VERMILION, (0, (4, 1.5))),
    "linear damping": Look(BROWN, (0, (2, 0.8))),
    "weight and buoyancy": Look(GREEN, (0, (6, 1, 1, 1))),
    "Coriolis": Look(GREY, (0, (1, 1.2))),
    "added-mass Coriolis": Look(GREY, (0, (5, 2))),
}
ADDED_PART_LOOKS = (Look(PURPLE, "-"), Look(OLIVE, "-"), Look(PURPLE, (0, (4, 1.5))))


@styled()
def draw(*, budget: ForceBudget) -> Figure:
    """Draw a model's parts and the missing force over time."""
    time, parts, missing = budget.time, budget.parts, budget.missing
    valid = np.isfinite(missing).any(axis=1)
    names = _largest(parts, valid)
    curves = {"missing": _smoothed(time, missing), **{n: parts[n] for n in names}}
    curves = {n: np.where(valid[:, None], v, np.nan) for n, v in curves.items()}
    part = excerpt(
        time, np.where(valid[:, None], parts.get("thrusters", missing), np.nan), EXCERPT_S
    )
    style = {"missing": Look(BLACK, "-", width=1.5), **_looks(names)}
    figure, axes = six_panels(FORCE, FORCE_UNITS)
    excerpts = {n: v[part] for n, v in curves.items()}
    remarks = plot_all(axes, time[part], _common(excerpts), style)
    for k, axis in enumerate(axes):
        axis.set_ylim(*_limits([v[:, k] for v in excerpts.values()]))
    share_scales(axes)
    for axis in axes:
        axis.axhline(0.0, color="#444444", linewidth=0.6, zorder=1.5)
    omitted = [n for n in parts if n not in names]
    add_legend(figure, lines(style))
    note(
        figure,
        [
            f"Missing: mean over {significant(SMOOTHING_S, 1)} s.",
            f"Too small to be drawn: {', '.join(omitted)}." if omitted else "",
            _excerpt_told(time, part),
            SHARED_SCALE_NOTE,
            *(r for r in remarks if r.startswith("No values")),
        ],
    )
    return figure


def _looks(names: list[str]) -> dict[str, Look]:
    """Return a look for each part, the same in every figure; added effects share the others."""
    added = [n for n in names if n not in PART_LOOKS]
    return {
        n: PART_LOOKS.get(n) or ADDED_PART_LOOKS[added.index(n) % len(ADDED_PART_LOOKS)]
        for n in names
    }


def _excerpt_told(time: Array, at: slice) -> str:
    whole = at.stop - at.start == len(time)
    return "" if whole else f"Excerpt of a run of {time[-1] - time[0]:.0f} s."


def _largest(parts: Mapping[str, Array], measured: Array) -> list[str]:
    """List the parts with the largest share on some axis, at most `MAX_PARTS`, in the order given.

    Args:
        parts: wrench (n, 6) of each, N and N m.
        measured: at which of the n samples the missing force is known.
    """
    size = {
        n: np.sqrt(np.mean(f[measured] ** 2, axis=0)) for n, f in parts.items() if measured.any()
    }
    whole = np.sqrt(sum((s**2 for s in size.values()), np.zeros(6)))
    share = {n: float(np.max(s / np.where(whole > 0, whole, 1.0))) for n, s in size.items()}
    largest = sorted((n for n in share if share[n] > 0.02), key=lambda n: -share[n])[:MAX_PARTS]
    return [n for n in parts if n in largest]


def _smoothed(time: Array, values: Array) -> Array:
    """Return the running mean over `SMOOTHING_S` s of values (n, 6), NaN left out."""
    count = max(round(SMOOTHING_S / float(np.median(np.diff(time)))), 1)
    valid, window = np.isfinite(values), np.ones(count)
    total = [
        np.convolve(np.where(k, v, 0.0), window, "same")
        for v, k in zip(values.T, valid.T, strict=True)
    ]
    weight = [np.convolve(k.astype(float), window, "same") for k in valid.T]
    return np.stack([t / np.maximum(w, 1.0) for t, w in zip(total, weight, strict=True)], axis=1)


def _common(curves: dict[str, Array]) -> dict[str, Array]:
    """Return the curves with the missing force last, so that it is drawn on top."""
    others = {name: values for name, values in curves.items() if name != "missing"}
    return {**others, "missing": curves["missing"]}


def _limits(values: list[Array]) -> tuple[float, float]:
    finite = np.concatenate([v[np.isfinite(v)] for v in values])
    if not len(finite):
        return -1.0, 1.0
    low, high = float(finite.min()), float(finite.max())
    room = 0.06 * max(high - low, 1e-6)
    return low - room, high + room
