"""Hold-out validation: the accepted effects must replay stretches that they were not chosen on.

A likelihood can be wrong about what matters to a user, and a replay is what users do. So the last
part of every train run is held out of the search. An effect is removed if these stretches are
replayed better without it, and an answer that replays them worse than the base is refused.

Before the last fit to all runs, no value is fitted to them. But they decide several things, and
become less independent with each: which effects do harm (`validate`), which are of no use where
unknown physics is left (`keep_earning`), whether the cameras smooth (`refuses`), which of two
answers is better (`prefers`), and whether a law holds (`keeps`).
"""

from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from itertools import product
from typing import Callable, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.threads import map_on_cores
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
from rovsim.evaluation.error_metrics import measured_spread
from rovsim.simulation.replay import ReplayCase, predict_all
from rovsim.simulation.settings import SimulationSettings

Split = Callable[[Hypothesis], list[tuple[Term, ...]]]

HOLDOUT_SHARE = 0.2  # of each run's time
MIN_RUN_SECONDS = 60.0  # a fifth of less shows too few windows of 2 s
SLIGHT_SHARE = 0.005  # of the error: several such losses add up to about WORSE_SHARE
# Of the error, sure or not: where few windows differ much, ten are not sure of a loss of half.
LOST_OF_FILE_SHARE = 0.1
REFIT_SHARE = 0.1  # of the error: what is worse by more, to first order, is not refitted
FOLDS = 4  # groups of runs that are left out, one after the other; single runs if there are fewer


def keep_apart(runs: Sequence[ObservedRun]) -> tuple[list[ObservedRun], list[ObservedRun]]:
    """Split train runs into what effects are chosen on, and the stretches that are held out.

    The last fifth of each run is held out, unless the run is shorter than a minute.
    """
    training, holdout = [], []
    for run in runs:
        time = run.motion.time
        end = time[0] + (1.0 - HOLDOUT_SHARE) * (time[-1] - time[0])
        if time[-1] - time[0] < MIN_RUN_SECONDS - 1.0:
            training.append(run)
            continue
        training.append(run.limited(time <= end))
        holdout.append(run.limited(time > end))
    return training, [run for run in holdout if Windows(run).spans]


@dataclass(frozen=True, eq=False)
class HoldoutValidation:
    """Judges models by how they replay the held-out stretches.

    Attributes:
        runs: the held-out stretches.
        whole_runs: the train runs that they belong to; these say how much each axis varies.
        current_drifts: whether the current wanders. What all windows of a run have in common may
            then be chance, so a run counts as one window.
        simulation: filter of the measurement, and the steps of a replay. Predictions pass the same
            filter, as in the reported errors: else a lag, which smooths them, replays better.
    """

    runs: Sequence[ObservedRun]
    whole_runs: Sequence[ObservedRun]
    current_drifts: bool = False
    simulation: SimulationSettings = field(default_factory=SimulationSettings)

    @cached_property
    def spread(self) -> Array:
        """Standard deviation (6,) of the measured velocity, m/s and rad/s."""
        return np.fmax(measured_spread(run.motion for run in self.whole_runs), MIN_SPREAD)

    def validate(self, selection: SearchResult) -> tuple[SearchResult, bool]:
        """Remove effects that do harm; all of them where the rest is still worse than the base.

        Returns:
            The selection that passes, and whether nothing had to be removed.
        """
        fit = selection.best
        while self.runs and fit.hypothesis.terms:
            weakest = self._find_harmful(selection, fit)
            reduced = selection.fit(weakest) if weakest else None
            if reduced is None or not reduced.is_finite:
                break
            fit = reduced
        if self.refuses(fit.hypothesis.model, fit.hypothesis.base):
            base = replace(fit.hypothesis, terms=())
            fit = selection.fit(base)
        return replace(selection, best=fit), fit is selection.best

    def refuses(self, model: Model, before: Model) -> bool:
        """Whether a model surely replays the held-out stretches worse than another one."""
        if not self.runs:
            return False
        errors = self._errors([model, before])
        return find_sure_improvement(errors[0], errors[1]) > 0.0

    def improves(self, more: Model, less: Model, share: float) -> bool:
        """Whether the error of `more` on all runs is less than that of `less` by that share."""
        e_more, e_less = replace(self, runs=self.whole_runs)._errors([more, less])
        return ratio(e_more, e_less) < 1.0 - share

    def keeps(self, more: Model, less: Model) -> bool:
        """Whether `more` errs no more than `less` on the held-out stretches.

        Chance is not allowed for: what acts in one place alone shows in few of their windows or in
        none, so these stretches cannot say how sure it is.
        """
        if not self.runs:
            return True
        e_more, e_less = self._errors([more, less])
        return ratio(e_more, e_less) <= 1.0

    def prefers(self, one: Model, other: Model) -> bool | None:
        """Whether the first model surely replays better, or the second; None where neither does."""
        if not self.runs:
            return None
        return find_better(*self._errors([one, other]))

    def prefers_between_runs(self, one: Fit, other: Fit) -> bool | None:
        """Whether the first answer replays whole runs better, at values fitted to the other runs.

        An answer whose values only suit the runs it was fitted to fails in a run of another kind.

        Returns:
            None where there is only one run, where both answers diverge, or where the difference
            may be chance.
        """
        groups = [self.whole_runs[k::FOLDS] for k in range(min(FOLDS, len(self.whole_runs)))]
        if len(groups) < 2:
            return None

        def refit(group: Sequence[ObservedRun], fit: Fit) -> Model:
            return fit_without(fit, self.whole_runs, group)

        refits = iter(map_on_cores(refit, *zip(*product(groups, (one, other)), strict=True)))
        pairs = zip(groups, zip(refits, refits, strict=True), strict=True)
        errors = [replace(self, runs=group)._errors(models) for group, models in pairs]
        return find_less_lost(*np.concatenate(errors, axis=1))

    def keep_earning(self, selection: SearchResult) -> SearchResult:
        """Where unknown physics is left, keep only effects without which replays are surely worse.

        Any other effect may merely stand in for part of that physics. The file effects are first
        judged together, then each by itself: nobody may miss any of them, and all of them be most
        of what was found.
        """
        selection = self._drop_idle(selection, _group, WORSE_SHARE, np.inf)
        return self._drop_idle(selection, _list_file_effects, SLIGHT_SHARE, LOST_OF_FILE_SHARE)

    def _drop_idle(
        self, selection: SearchResult, split: Split, least: float, most: float
    ) -> SearchResult:
        """Remove groups of terms one by one, as long as little is lost by that.

        Args:
            selection: with all groups.
            split: lists the groups of a hypothesis.
            least: share by which the error has to be larger than with all groups to be surely so.
            most: share by which it may be larger, sure or not.
        """
        if not self.runs:
            return selection
        best = selection.best
        with_all = self._errors([best.hypothesis.model])[0]
        while groups := split(best.hypothesis):
            reduced, errors = self._do_without(selection, best, groups)
            idle = [
                k
                for k, e in enumerate(errors[1:])
                if ratio(e, with_all) < 1.0 + most and not surely_costs(e, with_all, least)
            ]
            if not idle:
                break
            idle.sort(key=lambda k: ratio(errors[1 + k], errors[0]))
            refits = (selection.fit(reduced[k]) for k in idle)
            refit = next((fit for fit in refits if fit.is_finite), None)
            if refit is None:
                break
            best = refit
        return replace(selection, best=best)

    def _find_harmful(self, selection: SearchResult, fit: Fit) -> Hypothesis | None:
        """The hypothesis without the most harmful effect; None where no effect surely does harm."""
        reduced, errors = self._do_without(selection, fit, [(t,) for t in fit.hypothesis.terms])
        count = len(errors) - 1
        improvements = [find_sure_improvement(errors[0], e, count) for e in errors[1:]]
        k_best = int(np.argmax(improvements))
        return reduced[k_best] if improvements[k_best] > 0.0 else None

    def _do_without(
        self, selection: SearchResult, fit: Fit, groups: Sequence[Sequence[Term]]
    ) -> tuple[list[Hypothesis], Array]:
        """Try to do without each of g groups of terms.

        The other terms are refitted to first order, and in full where the error then is close.

        Returns:
            The hypotheses without each group, and the errors (1 + g, w) in each of w windows, of
            which the first row is that of the fit itself.
        """
        h, reduced = fit.hypothesis, selection.workspace.first_order.drop(fit, groups)
        errors = self._errors([h.model, *(trial.model for trial in reduced)])
        close = [k for k, e in enumerate(errors[1:]) if ratio(e, errors[0]) < 1.0 + REFIT_SHARE]
        refits = map_on_cores(selection.fit, [reduced[k] for k in close])
        for k, refit in zip(close, refits, strict=True):
            reduced[k] = refit.hypothesis
        return reduced, self._errors([h.model, *(trial.model for trial in reduced)])

    def _errors(self, models: Sequence[Model]) -> Array:
        """Mean squared velocity error (m, w) of m models in each of w windows.

        Each axis is in units of its `spread`. Where the current wanders, a run is one window. NaN
        for models that are impossible, as a refit to first order may make them.
        """
        parts: list[Array] = []
        for run in self.runs:
            windows = Windows(run)
            compare = partial(_compare_axes, windows, self.simulation)
            e = evaluate_possible(models, len(windows.number), compare)
            with np.errstate(over="ignore", invalid="ignore"):  # of a model that diverges
                squares = np.mean((e / self.spread[:, None]) ** 2, axis=1)
            number = 0 * windows.number if self.current_drifts else windows.number
            parts += [squares[:, number == k].mean(axis=1) for k in np.unique(number)]
        return np.stack(parts, axis=1)


def _compare_axes(
    windows: Windows, simulation: SimulationSettings, models: Sequence[Model]
) -> Array:
    """Velocity errors (m, 6, n) of m models at the n compared samples of a run, m/s and rad/s."""
    run, at = windows.run, windows.compared
    cases = [ReplayCase(model, run.motion) for model in models]
    nu = np.stack([p.nu[at] for p in predict_all(cases, windows.spans, simulation)])
    e = nu - run.motion.nu[at]
    return np.where(run.axes, e, 0.0).swapaxes(1, 2)


def _list_file_effects(h: Hypothesis) -> list[tuple[Term, ...]]:
    """Each file effect by itself."""
    return [(term,) for term in h.terms if term.id in FILE_EFFECT_IDS]


def _group(h: Hypothesis) -> list[tuple[Term, ...]]:
    """Each special effect by itself, and all file effects together."""
    of_file = tuple(term for term in h.terms if term.id in FILE_EFFECT_IDS)
    groups: list[tuple[Term, ...]] = [(term,) for term in h.terms if term.id not in FILE_EFFECT_IDS]
    return [*groups, of_file] if of_file else groups
