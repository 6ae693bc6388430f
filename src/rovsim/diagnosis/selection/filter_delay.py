"""A filter in the camera's software and a late command both delay what is seen.

The noise of the cameras tells the filter's cutoff only within some per cent, the motion tells the
delay far more finely. So a delay no longer than what the noise leaves open is the filter's. So is
one of about a frame, whatever the noise says: software that works between frames is that much later
than software that works frame by frame.
"""

from dataclasses import replace
from typing import Callable, Iterable, NamedTuple

import numpy as np

from rovsim.diagnosis.selection.pruning import prune
from rovsim.diagnosis.selection.search_result import SearchResult
from rovsim.diagnosis.selection.workspace import HOPELESS_LR, SearchWorkspace
from rovsim.dynamics.effects.clocks import InputDelay
from rovsim.dynamics.effects.thrusters import ThrusterLag
from rovsim.dynamics.model import Model
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.camera import Smoothing
from rovsim.estimation.observer.hypothesis import Hypothesis, Term

DELAY, LAG = InputDelay.id, ThrusterLag.id
# Frames: later by so much, and no more, is a latency, not a lower cutoff. Two stages between frames
# are one frame later than two from frame to frame.
BETWEEN_FRAMES = (0.5, 1.5)


class SearchStart(NamedTuple):
    """Nothing but what the camera does, where to look for more, and the camera's filter."""

    nothing: Fit
    workspace: SearchWorkspace
    smoothing: Smoothing | None


def search_consistent(
    starts: Iterable[SearchStart],
    search_from: Callable[[SearchStart], tuple[SearchResult, Smoothing | None]],
) -> tuple[SearchStart, SearchResult, Smoothing | None]:
    """The first search that ends, beside all that it found, with the camera it began with.

    If none does, the last. Likelihoods do not tell: each camera makes other innovations of the
    same poses.
    """
    for start in starts:
        selection, smoothing = search_from(start)
        if start.smoothing is None or smoothing is None:
            break
        if smoothing.is_near(start.smoothing) and not has_delay(selection.best.hypothesis):
            break
    return start, selection, smoothing


def seen_through(base: Model, smoothing: Smoothing | None) -> Model:
    """The base, as far as is known what the camera does to its poses."""
    return base if smoothing is None else base + smoothing.effect


def absorb_delay(
    selection: SearchResult, base: Model, smoothing: Smoothing
) -> tuple[SearchResult, Smoothing]:
    """The selection without a delay that the filter explains, and the filter that explains it.

    Whatever was named only because the cutoff was not quite right goes.
    """
    fit, workspace = selection.best, selection.workspace
    unlagged = _without_short_lag(fit.hypothesis, smoothing)
    if unlagged:
        again, finer = _absorb(selection, _with_delay(selection, unlagged), base, smoothing)
        if again and workspace.score(again) > workspace.score(fit) - HOPELESS_LR:
            return replace(selection, best=prune(workspace, again)), finer
    if not has_delay(fit.hypothesis):
        fit = _with_delay(selection, fit.hypothesis)
    again, finer = _absorb(selection, fit, base, smoothing)
    return (replace(selection, best=prune(workspace, again)) if again else selection), finer


def has_delay(h: Hypothesis) -> bool:
    """Whether commands are late in it."""
    return any(term.id == DELAY for term in h.terms)


def _with_delay(selection: SearchResult, h: Hypothesis) -> Fit:
    """A hypothesis with a delay, fitted."""
    others = replace(h, terms=tuple(term for term in h.terms if term.id != DELAY))
    return selection.fit(others.with_term(Term(InputDelay(), ("delay",))))


def _without_short_lag(h: Hypothesis, smoothing: Smoothing) -> Hypothesis | None:
    """Without thrusters that lag by about a frame: to most commands the same as a delay.

    The likelihood hardly tells: it hangs more on the cutoff, within what the noise leaves open.
    """
    for k, term in enumerate(h.terms):
        if term.id == LAG and term.effect["time_constant"] < BETWEEN_FRAMES[1] * smoothing.frame:
            return h.without(k)
    return None


def _absorb(
    selection: SearchResult, at: Fit, base: Model, smoothing: Smoothing
) -> tuple[Fit | None, Smoothing]:
    """A hypothesis without its delay, beside the filter that explains it; None if there is none."""
    h = at.hypothesis
    k = next(i for i, term in enumerate(h.terms) if term.id == DELAY)
    delay, column = h.terms[k].effect["delay"], h.columns[k][0]
    std = float(at.std[column] * h.terms[k].parameters[0].scale)
    finer = _refine(smoothing, delay, std)
    if finer is None:
        return None, smoothing
    rest = Hypothesis(seen_through(base, finer), h.without(k).terms)
    again = selection.workspace.fit(rest)
    if not again.is_finite:  # undone, so slow a filter makes more than was there
        return None, smoothing
    return again, finer


def _refine(smoothing: Smoothing, delay: float, std: float) -> Smoothing | None:
    """The filter that is later by a delay, known to within `std` s; None if it cannot be.

    Two stages delay slow motions by twice their time constant T = 1 / (2 pi f).
    """
    late = _delay(smoothing.cutoff) + smoothing.latency + delay
    beyond = late - _delay(smoothing.told)
    least, most = BETWEEN_FRAMES
    if least * smoothing.frame < beyond < most * smoothing.frame:
        return replace(smoothing, cutoff=smoothing.told, latency=beyond)
    cutoff = 1.0 / (np.pi * late) if late > 0.0 else np.inf
    if not smoothing.lowest <= cutoff <= smoothing.highest:
        return None
    return replace(smoothing, cutoff=cutoff, std=np.pi * cutoff**2 * std, latency=0.0)


def _delay(cutoff: float) -> float:
    return 1.0 / (np.pi * cutoff)
