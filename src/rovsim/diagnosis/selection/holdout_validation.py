"""Hold-out validation: what was chosen must replay stretches that took no part in choosing.

A likelihood can be wrong about what matters to a user; a replay is what users do. So the last part
of every train run is kept apart. An effect without which these stretches are replayed better goes,
and an answer that replays them worse than the model before is no answer.

No value is fitted to them before the last fit to all runs. But they decide more than once, so that
they are less and less fresh: which effects harm (`judge`), which earn nothing beside physics
without a name (`keep_earning`), whether the cameras smooth (`refuses`), which of two answers
(`prefers`), and whether a law holds (`keeps`).
"""

from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Callable, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.selection.paired_comparison import (
    WORSE_SHARE,
    find_better,
    find_less_lost,
    find_sure_improvement,
    ratio,
    surely_costs,
)
from rovsim.diagnosis.selection.search_result import SearchResult
from rovsim.dynamics.model import Model
from rovsim.estimation.file_effects import FILE_EFFECT_IDS
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.estimation.observer.residual_source import evaluate_possible
from rovsim.estimation.observer.windows import Windows
from rovsim.estimation.replay_fit import MIN_SPREAD, fit_without
from rovsim.evaluation.scores import measured_spread

Split = Callable[[Hypothesis], list[tuple[Term, ...]]]

HOLDOUT_SHARE = 0.2  # of each run's time
MIN_RUN_SECONDS = 60.0  # a fifth of less shows too few windows of 2 s
SLIGHT_SHARE = 0.005  # of the error: what is let go one by one adds up to about WORSE_SHARE
REFIT_SHARE = 0.1  # of the error: who does worse without a term, to first order, is not refitted
FOLDS = 4  # groups of runs that are left out, one after the other; single runs if there are fewer


def keep_apart(runs: Sequence[ObservedRun]) -> tuple[list[ObservedRun], list[ObservedRun]]:
    """The runs to choose by, and those stretches of them that take no part in it."""
    chosen, holdout = [], []
    for run in runs:
        time = run.motion.time
        end = time[0] + (1.0 - HOLDOUT_SHARE) * (time[-1] - time[0])
        if time[-1] - time[0] < MIN_RUN_SECONDS - 1.0:
            chosen.append(run)
            continue
        chosen.append(run.limited(time <= end))
        holdout.append(run.limited(time > end))
    return chosen, [run for run in holdout if Windows(run).spans]


@dataclass(frozen=True, eq=False)
class HoldoutValidation:
    """The stretches that were kept apart; the whole runs tell how much each axis varies.

    Where the `current_drifts`, what all windows of a run have in common is by chance.
    """

    runs: Sequence[ObservedRun]
    whole: Sequence[ObservedRun]
    current_drifts: bool = False

    @cached_property
    def spread(self) -> Array:
        """Standard deviation (6,) of the measured velocity."""
        return np.fmax(measured_spread(run.motion for run in self.whole), MIN_SPREAD)

    def judge(self, selection: SearchResult) -> tuple[SearchResult, bool]:
        """What passes, and whether that is all that was selected."""
        fit = selection.best
        while self.runs and fit.hypothesis.terms:
            weakest = self._find_harmful(selection, fit)
            fewer = selection.fit(weakest) if weakest else None
            if fewer is None or not fewer.is_finite:
                break
            fit = fewer
        if self.refuses(fit.hypothesis.model, fit.hypothesis.base):
            base = replace(fit.hypothesis, terms=())
            fit = selection.fit(base)
        return replace(selection, best=fit), fit is selection.best

    def refuses(self, model: Model, before: Model) -> bool:
        """Whether a model replays these stretches surely worse than the one before."""
        if not self.runs:
            return False
        errors = self._errors([model, before])
        return find_sure_improvement(errors[0], errors[1]) > 0.0

    def improves(self, more: Model, less: Model, share: float) -> bool:
        """Whether one model errs less than the other by that share on all runs, held out or not."""
        one, other = replace(self, runs=self.whole)._errors([more, less])
        return ratio(one, other) < 1.0 - share

    def keeps(self, more: Model, less: Model) -> bool:
        """Whether one model errs no more than the other on stretches that were kept apart.

        How sure that is, is asked elsewhere: what acts in one place shows in few of their windows,
        perhaps in none.
        """
        if not self.runs:
            return True
        one, other = self._errors([more, less])
        return ratio(one, other) <= 1.0

    def prefers(self, one: Model, other: Model) -> bool | None:
        """Whether the first replays better; None if nothing was kept apart, or by chance."""
        if not self.runs:
            return None
        return find_better(*self._errors([one, other]))

    def prefers_between_runs(self, one: Fit, other: Fit) -> bool | None:
        """Whether the first replays whole runs better, at the values that replay the others best.

        What is fitted as well by values that mean nothing elsewhere is lost in a run of another
        kind. None where there is but one run, where both are lost, or by chance.
        """
        groups = [self.whole[k::FOLDS] for k in range(min(FOLDS, len(self.whole)))]
        if len(groups) < 2:
            return None
        errors = []
        for group in groups:
            models = [fit_without(fit, self.whole, group) for fit in (one, other)]
            errors.append(replace(self, runs=group)._errors(models))
        return find_less_lost(*np.concatenate(errors, axis=1))

    def keep_earning(self, selection: SearchResult) -> SearchResult:
        """Where physics is left that no name explains: only what makes a difference there.

        A name then stands for part of what has none, unless replays are surely better for it. What
        the vehicle file states counts together; then whatever of it is not sure by itself goes.
        """
        for split, least in ((_group, WORSE_SHARE), (_list_file_effects, SLIGHT_SHARE)):
            selection = self._drop_idle(selection, split, least)
        return selection

    def _drop_idle(self, selection: SearchResult, split: Split, least: float) -> SearchResult:
        """Without groups of terms whose absence does not surely cost that share of the error."""
        kept = selection.best
        while self.runs and (groups := split(kept.hypothesis)):
            fewer, errors = self._do_without(selection, kept, groups)
            idle = [k for k, e in enumerate(errors[1:]) if not surely_costs(e, errors[0], least)]
            if not idle:
                break
            idle.sort(key=lambda k: ratio(errors[1 + k], errors[0]))
            left = (selection.fit(fewer[k]) for k in idle)
            without = next((fit for fit in left if fit.is_finite), None)
            if without is None:
                break
            kept = without
        return replace(selection, best=kept)

    def _find_harmful(self, selection: SearchResult, fit: Fit) -> Hypothesis | None:
        """Without the effect whose absence helps most; None where each of them earns its place."""
        fewer, errors = self._do_without(selection, fit, [(t,) for t in fit.hypothesis.terms])
        tried = len(errors) - 1
        improvements = [find_sure_improvement(errors[0], one, tried) for one in errors[1:]]
        best = int(np.argmax(improvements))
        return fewer[best] if improvements[best] > 0.0 else None

    def _do_without(
        self, selection: SearchResult, fit: Fit, groups: Sequence[Sequence[Term]]
    ) -> tuple[list[Hypothesis], Array]:
        """Hypotheses without each group of terms, and errors (1 + g, w), those with all first.

        Refitted to first order, and in full where that comes close.
        """
        h, fewer = fit.hypothesis, selection.workspace.drop(fit, groups)
        errors = self._errors([h.model, *(one.model for one in fewer)])
        for k, one in enumerate(fewer):
            if ratio(errors[1 + k], errors[0]) < 1.0 + REFIT_SHARE:
                fewer[k] = selection.fit(one).hypothesis
        return fewer, self._errors([h.model, *(one.model for one in fewer)])

    def _errors(self, models: Sequence[Model]) -> Array:
        """Mean squared error (m, w) of each window, every axis in units of how much it varies.

        Of each run where the current wanders.

        NaN where a model cannot move at all: a refit to first order may go that far.
        """
        parts: list[Array] = []
        for run in self.runs:
            windows = Windows(run)
            e = evaluate_possible(models, len(windows.number), partial(_compare_axes, windows))
            with np.errstate(over="ignore", invalid="ignore"):  # of a model that diverges
                squares = np.mean((e / self.spread[:, None]) ** 2, axis=1)
            number = 0 * windows.number if self.current_drifts else windows.number
            parts += [squares[:, number == k].mean(axis=1) for k in np.unique(number)]
        return np.stack(parts, axis=1)


def _compare_axes(windows: Windows, models: Sequence[Model]) -> Array:
    """Errors of the velocity (m, 6, n)."""
    return windows.compare(models).swapaxes(1, 2)


def _list_file_effects(h: Hypothesis) -> list[tuple[Term, ...]]:
    """Each file effect by itself."""
    return [(term,) for term in h.terms if term.id in FILE_EFFECT_IDS]


def _group(h: Hypothesis) -> list[tuple[Term, ...]]:
    """Each special effect by itself, and all file effects together."""
    of_file = tuple(term for term in h.terms if term.id in FILE_EFFECT_IDS)
    groups: list[tuple[Term, ...]] = [(term,) for term in h.terms if term.id not in FILE_EFFECT_IDS]
    return [*groups, of_file] if of_file else groups
