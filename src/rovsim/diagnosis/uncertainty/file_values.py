"""All of a vehicle file that is off, fitted together with what was selected.

What was selected was fitted as if the rest of the file were right. Where several of its effects
were selected it is not, and what was left as it was draws the others away: thrust, inertia and
drag share a factor that little but such numbers fixes. So in the end all that the file states is
fitted, each number beside what is known of such files (`estimation/file_effects.py`). Then
what is not sure, or nobody would miss, is left out again, at the gain that was found: the others
take what it did, and their intervals stay those of all together. The gain itself stays where it is
surely not what the file says, although replays without it are as good: the others were all off by
one factor.

A file may also be wrong in a few things alone. Where the runs find all other drag and added mass to
be what the file says, far closer than such files are known to be, it is right elsewhere, and what
was selected stands. That is asked of all of them at once: Savage and Dickey's ratio of densities
(Dickey 1971, Ann. Math. Stat. 42, 204), how much likelier the file's values are after the runs than
before. What a file states as zero, as the ballast's place, is right in most files, and tells
nothing of the others. The more was selected, the less is it likely that just the rest is right: as
many numbers may be wrong as there are, each count as likely before, and all sets of one count alike
(Scott & Berger 2010, Ann. Stat. 38, 2587).
"""

from dataclasses import replace
from typing import Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.special import comb
from scipy.stats import chi2

from rovsim.diagnosis.selection.pruning import drop_parameters
from rovsim.diagnosis.selection.search_result import MIN_LR_APART
from rovsim.diagnosis.selection.vehicle_file.whole_file import know_file, mark_new
from rovsim.diagnosis.structure.residual import FALSE_ALARM
from rovsim.diagnosis.uncertainty.common_scale import CommonScale, describe_scale
from rovsim.dynamics.effects.thrusters import ThrusterGain, name_gains
from rovsim.estimation.file_effects import mark_gain, share_of_file
from rovsim.estimation.fit import Fit, judge
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis
from rovsim.estimation.observer.least_squares import solve
from rovsim.estimation.observer.windows import score_windows

TOLD = 0.7  # of what was known before: runs that leave more of it have told nothing
MISSED = 0.01  # more error in 2 s windows, as a share: less, nobody would see


def is_right_elsewhere(whole: Fit, selected: Hypothesis) -> bool:
    """Whether the runs find the rest of a file right, beside what was selected of it.

    Args:
        whole: all of the file, fitted.
        selected: what was selected, as it was fitted.
    """
    h, new = whole.hypothesis, mark_new(selected, whole.hypothesis)
    each = [(type(t.effect), p) for t in h.terms for p in t.parameters]
    share = np.array([share_of_file(h.base, *one) for one in each])
    asked, of = new & (share > 0.0), int(np.sum(share > 0.0))
    if not asked.any() or whole.distance(asked) > chi2.isf(FALSE_ALARM, asked.sum()):
        return False
    known, usual, one = know_file(selected, h).std[asked], share[asked], np.eye(asked.sum())
    in_all = solve(whole.covariance[np.ix_(asked, asked)], one)
    pull = in_all @ (h.x - h.absence)[asked]
    told = in_all - np.diag(known**-2.0)  # by the runs: the fit knew the file as well
    likelier = np.linalg.slogdet(one + usual[:, None] * told * usual)[1]
    likelier -= pull @ solve(told + np.diag(usual**-2.0), pull)
    return bool(likelier - 2.0 * np.log((of + 1) * comb(of, asked.sum())) > MIN_LR_APART)


def settle_whole_file(
    whole: Fit, selected: Hypothesis, bank: FilterBank
) -> tuple[Fit, CommonScale | None]:
    """The effects that were selected, others that would be missed, and the common scale.

    Args:
        whole: all of the file, fitted.
        selected: what was selected, as it was fitted.
        bank: that of `whole`.
    """
    h, new = whole.hypothesis, mark_new(selected, whole.hypothesis)
    untold = new & (whole.std > TOLD * know_file(selected, h).std)
    owner = np.array([term.id for term in h.terms for _ in term.free])
    named = {term.id for term in selected.terms} | _name_gain(whole)
    sure = {one for one in set(owner) - named if _is_sure(whole, (owner == one) & ~untold)}
    gone = untold | ~np.isin(owner, list(named))
    while left := sorted(sure - named):
        tried = [_leave_out(whole, gone & ((owner != one) | untold)) for one in left]
        all_of_it, without, *more = _measure([h, _leave_out(whole, gone), *tried], bank)
        if without <= (1.0 + MISSED) * all_of_it:
            break
        named.add(left[int(np.argmin(more))])
        gone = untold | ~np.isin(owner, list(named))
    final = judge(bank.linearise(_leave_out(whole, gone)), bank, whole.noise)
    final = replace(final, covariance=whole.covariance[np.ix_(~gone, ~gone)])
    gain = _share_gains(h)
    variance = float(gain @ whole.covariance @ gain)
    return final, describe_scale(final, variance, whole.covariance[~gone] @ gain / variance)


def _name_gain(whole: Fit) -> set[str]:
    """The gain of all thrusters, if it is surely not what the file says.

    No replay would miss it: all others, wrong by its inverse, would make up for it.
    """
    gain = mark_gain(whole.hypothesis)
    sure = gain.any() and whole.distance(gain) > chi2.isf(FALSE_ALARM, 1)
    return {ThrusterGain.id} if sure else set()


def _share_gains(h: Hypothesis) -> Array:
    """What each parameter (k,) has in the mean gain of the thrusters."""
    count = h.base.vehicle.thruster_count
    own = [f"{ThrusterGain.id}.{name}" for name in name_gains(count)]
    single = np.isin(h.parameter_names, own) / max(1, count)
    return np.where(mark_gain(h), 1.0, single)


def _leave_out(whole: Fit, gone: Array) -> Hypothesis:
    """Without some parameters (k,); the others take what they did, but for the gain, which stays.

    To first order: the mean of the others once those are known.
    """
    h, V = whole.hypothesis, whole.covariance
    step = np.where(gone, h.absence - h.x, 0.0)
    given = gone | mark_gain(h)
    follow = V[np.ix_(~given, given)] @ solve(V[np.ix_(given, given)], step[given])
    step[~given] = follow
    return drop_parameters(h.at(h.x + step), gone)


def _is_sure(whole: Fit, own: Array) -> bool:
    """Whether some parameters (k,) are not what the file says, at the gain that was found."""
    h, V = whole.hypothesis, whole.covariance
    own = own & ~mark_gain(h)
    across = V[np.ix_(own, mark_gain(h))]
    beside = V[np.ix_(own, own)] - across @ across.T / V[np.ix_(mark_gain(h), mark_gain(h))]
    off = (h.x - h.absence)[own]
    return bool(off @ solve(beside, off) > chi2.isf(FALSE_ALARM, max(1, own.sum())))


def _measure(hypotheses: Sequence[Hypothesis], bank: FilterBank) -> list[float]:
    """Their errors in 2 s windows; infinite where a model diverges."""
    errors = score_windows([one.model for one in hypotheses], bank.runs).normalised
    return [np.inf if error is None else error for error in errors]
