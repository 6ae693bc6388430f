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

DELAY_ID, LAG_ID = InputDelay.id, ThrusterLag.id
# Frames: later by so much, and no more, is a latency, not a lower cutoff. Two stages between frames
# are one frame later than two from frame to frame.
LATENCY_FRAMES = (0.5, 1.5)


class SearchStart(NamedTuple):
    """Where a search for missing effects begins.

    Attributes:
        base_fit: the base, with the filter of the cameras and without any effect.
        workspace: the candidates, and the runs they are judged on.
        smoothing: the filter of the cameras that is assumed; None where they do not smooth.
    """

    base_fit: Fit
    workspace: SearchWorkspace
    smoothing: Smoothing | None


class FinishedSearch(NamedTuple):
    """A search that has ended.

    Attributes:
        start: where it began.
        selection: the effects that it accepted.
        smoothing: the filter of the cameras as it is known now; None where they do not smooth.
    """

    start: SearchStart
    selection: SearchResult
    smoothing: Smoothing | None


def search_with_consistent_filter(
    starts: Iterable[SearchStart],
    search_from: Callable[[SearchStart], tuple[SearchResult, Smoothing | None]],
) -> FinishedSearch:
    """Search from one start after the other until a search confirms the filter it began with.

    A search confirms the filter if the accepted effects leave its cutoff about where it was, and
    no delay of the commands is left over. If no search does, the last one is returned. Likelihoods
    cannot decide between the searches: each filter turns the same poses into other innovations.

    Args:
        starts: at least one; the next is only made when the search before it was not consistent.
        search_from: runs one search, and returns what it accepted and the filter it ends with.
    """
    for start in starts:
        finished = FinishedSearch(start, *search_from(start))
        smoothing = finished.smoothing
        if start.smoothing is None or smoothing is None:
            break
        if smoothing.is_near(start.smoothing) and not has_delay(finished.selection.best.hypothesis):
            break
    return finished


def with_camera_filter(base: Model, smoothing: Smoothing | None) -> Model:
    """The base with the filter of the cameras as an effect; unchanged where they do not smooth."""
    return base if smoothing is None else base + smoothing.effect


def absorb_delay(
    selection: SearchResult, base: Model, smoothing: Smoothing
) -> tuple[SearchResult, Smoothing]:
    """Count a delay of the commands as part of the filter, where the filter can explain it.

    Effects that were only accepted because the cutoff was slightly wrong are removed again.

    Args:
        selection: what the search accepted.
        base: the model that is diagnosed, without the filter.
        smoothing: the filter that the search began with.

    Returns:
        The selection without the delay, and the filter that explains it; both unchanged where the
        filter cannot.
    """
    fit, workspace = selection.best, selection.workspace
    without_lag = _without_short_lag(fit.hypothesis, smoothing)
    if without_lag:
        refit, finer = _absorb(selection, _with_delay(selection, without_lag), base, smoothing)
        if refit and workspace.score(refit) > workspace.score(fit) - HOPELESS_LR:
            return replace(selection, best=prune(workspace, refit)), finer
    if not has_delay(fit.hypothesis):
        fit = _with_delay(selection, fit.hypothesis)
    refit, finer = _absorb(selection, fit, base, smoothing)
    return (replace(selection, best=prune(workspace, refit)) if refit else selection), finer


def has_delay(h: Hypothesis) -> bool:
    """Whether the hypothesis contains an `input_delay`."""
    return any(term.id == DELAY_ID for term in h.terms)


def _with_delay(selection: SearchResult, h: Hypothesis) -> Fit:
    """Fit the hypothesis with an `input_delay` in place of any that it has."""
    without_delay = h.without_effect(DELAY_ID)
    return selection.fit(without_delay.with_term(Term(InputDelay(), ("delay",))))


def _without_short_lag(h: Hypothesis, smoothing: Smoothing) -> Hypothesis | None:
    """Without a thruster lag of about one frame; None where there is no such lag.

    With most commands so short a lag looks the same as a delay. The likelihood hardly tells them
    apart: it depends more on the cutoff, which the noise gives only roughly.
    """
    for k, term in enumerate(h.terms):
        if term.id == LAG_ID and term.effect["time_constant"] < LATENCY_FRAMES[1] * smoothing.frame:
            return h.without(k)
    return None


def _absorb(
    selection: SearchResult, at: Fit, base: Model, smoothing: Smoothing
) -> tuple[Fit | None, Smoothing]:
    """Fit a hypothesis without its delay, with a slower filter that causes the same delay.

    Returns:
        The fit and the slower filter; None and the filter as it was where no such filter fits.
    """
    h = at.hypothesis
    k = next(i for i, term in enumerate(h.terms) if term.id == DELAY_ID)
    delay, column = h.terms[k].effect["delay"], h.columns[k][0]
    std = float(at.std[column] * h.terms[k].parameters[0].scale)
    finer = _refine(smoothing, delay, std)
    if finer is None:
        return None, smoothing
    hypothesis = Hypothesis(with_camera_filter(base, finer), h.without(k).terms)
    refit = selection.workspace.fit(hypothesis)
    if not refit.is_finite:  # undoing so slow a filter amplifies the noise without bound
        return None, smoothing
    return refit, finer


def _refine(smoothing: Smoothing, delay: float, std: float) -> Smoothing | None:
    """The filter that delays poses by `delay` s more; None where the noise excludes its cutoff.

    Its two stages delay slow motions by twice their time constant T = 1 / (2 pi f).

    Args:
        smoothing: the filter as it is known so far.
        delay: to be added, s.
        std: standard deviation of that delay, s.
    """
    total_delay = find_slow_delay(smoothing.cutoff) + smoothing.latency + delay
    latency = total_delay - find_slow_delay(smoothing.noise_cutoff)
    low, high = LATENCY_FRAMES
    if low * smoothing.frame < latency < high * smoothing.frame:
        return replace(smoothing, cutoff=smoothing.noise_cutoff, latency=latency)
    cutoff = 1.0 / (np.pi * total_delay) if total_delay > 0.0 else np.inf
    if not smoothing.lowest <= cutoff <= smoothing.highest:
        return None
    std = find_cutoff_std(cutoff, std)
    return replace(smoothing, cutoff=cutoff, std=std, latency=0.0)


def find_slow_delay(cutoff: float) -> float:
    """How late, s, the filter reports slow motions; its cutoff is in Hz."""
    return 1.0 / (np.pi * cutoff)


def find_cutoff_std(cutoff: float, std: float) -> float:
    """Standard deviation of a cutoff, Hz, of which that of its delay is `std` s."""
    return float(np.pi * cutoff**2 * std)
