"""A filter in the camera's software and a late command both delay what is seen.

The noise of the cameras tells the filter's cutoff only within some per cent, the motion tells the
delay far more finely. So a delay no longer than what the noise leaves open is the filter's.
"""

from dataclasses import replace

import numpy as np

from rovsim.diagnosis.observer.camera import Smoothing
from rovsim.diagnosis.observer.hypothesis import Hypothesis, Term
from rovsim.diagnosis.selection.pruning import prune
from rovsim.diagnosis.selection.rivals import Selection
from rovsim.dynamics.effects.clocks import InputDelay
from rovsim.dynamics.effects.pose_filter import PoseFilter
from rovsim.dynamics.model import Model

DELAY = InputDelay.id


def seen_through(base: Model, smoothing: Smoothing | None) -> Model:
    """The base, as far as is known what the camera does to its poses."""
    return base if smoothing is None else base + PoseFilter(cutoff=smoothing.cutoff)


def absorb_delay(
    selection: Selection, base: Model, smoothing: Smoothing
) -> tuple[Selection, Smoothing]:
    """The selection without a delay that the filter explains, and the filter that explains it.

    Two stages delay slow motions by twice their time constant T = 1 / (2 pi f). Whatever was named
    only because the cutoff was not quite right goes.
    """
    found = selection.found
    if DELAY not in (term.id for term in found.hypothesis.terms):
        found = selection.fit(found.hypothesis.with_term(Term(InputDelay(), ("delay",))))
    h = found.hypothesis
    k = next(i for i, term in enumerate(h.terms) if term.id == DELAY)
    delay, column = h.terms[k].effect["delay"], h.columns[k][0]
    T, *_ = PoseFilter(cutoff=smoothing.cutoff).time_constants()
    slower = T + 0.5 * delay
    cutoff = 1.0 / (2.0 * np.pi * slower) if slower > 0.0 else np.inf
    if not smoothing.lowest <= cutoff <= smoothing.highest:
        return selection, smoothing
    std = found.std[column] * h.terms[k].parameters[0].scale
    finer = replace(smoothing, cutoff=cutoff, std=float(np.pi * cutoff**2 * std))
    rest = Hypothesis(seen_through(base, finer), h.without(k).terms)
    again = selection.workspace.fit(rest)
    if not np.isfinite(again.likelihood):  # undone, so slow a filter makes more than was there
        return selection, smoothing
    return replace(selection, found=prune(selection.workspace, again)), finer
