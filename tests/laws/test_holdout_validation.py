"""Hold-out validation: stretches kept apart are apart, and only what is sure counts."""

from dataclasses import replace

import numpy as np
import pytest

from flown import observed
from rovsim.diagnosis.selection import holdout_validation
from rovsim.diagnosis.selection.holdout_validation import HoldoutValidation, keep_apart
from rovsim.diagnosis.selection.paired_comparison import find_sure_improvement, surely_costs
from rovsim.diagnosis.selection.search_result import SearchResult
from rovsim.dynamics.effects.added_mass import AddedMass
from rovsim.dynamics.effects.buoyancy import NetBuoyancy
from rovsim.dynamics.effects.damping import LinearDamping, QuadraticDamping
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.noise import FIRST_NOISE
from rovsim.estimation.observer.windows import Windows
from rovsim.evaluation.error_metrics import subtract
from rovsim.simulation.replay import replay
from rovsim.simulation.settings import SimulationSettings
from worlds import model


def test_no_reading_is_on_both_sides(tmp_path):
    _, runs = observed(tmp_path, duration=60.0)
    (chosen,), (holdout,) = keep_apart(runs)
    assert not np.any(chosen.motion.usable & holdout.motion.usable)
    ends = [
        set(run.reading_samples[a] for a, b in run.segments for a in range(a, b))
        for run in (chosen, holdout)
    ]
    assert not ends[0] & ends[1]
    seconds = [run.settled.sum() * run.period for run in (chosen, holdout)]
    assert seconds[1] / sum(seconds) == pytest.approx(0.2, abs=0.06)


def test_short_runs_are_used_whole(tmp_path):
    _, runs = observed(tmp_path, duration=20.0)
    chosen, holdout = keep_apart(runs)
    assert chosen == runs
    assert holdout == []


def test_only_what_is_sure_and_matters_is_less():
    error = np.linspace(0.5, 1.5, 20)
    assert find_sure_improvement(error, 0.5 * error) == pytest.approx(1.0 - np.sqrt(0.5))
    assert find_sure_improvement(error, 0.99 * error) == 0.0  # too little
    uneven = error * np.where(np.arange(20) == 3, 1.0, 0.0)
    assert find_sure_improvement(error + 20.0 * uneven, error) == 0.0  # a single window
    assert find_sure_improvement(np.full(20, np.inf), error) == np.inf
    assert find_sure_improvement(error, np.full(20, np.nan)) == 0.0


def test_a_body_that_cannot_exist_replays_nothing(tmp_path):
    base, runs = observed(tmp_path, duration=60.0)
    holdout = HoldoutValidation(keep_apart(runs)[1], runs)
    nowhere = Hypothesis(base, (Term(AddedMass(surge=-100.0), ("surge",)),))
    possible, impossible = (
        SearchResult(Workspace(), Found(h), (), True) for h in (Hypothesis(base), nowhere)
    )
    models = [one.best.hypothesis.model for one in (possible, impossible)]
    assert holdout.prefers(*models) is True
    assert holdout.prefers(*reversed(models)) is False
    assert holdout.prefers(models[0], models[0]) is None
    passed, whole = holdout.validate(impossible)
    assert passed.best.hypothesis.terms == ()
    assert not whole


def test_predictions_pass_the_filter_of_the_measurement_as_in_the_reported_errors(tmp_path):
    base, runs = observed(tmp_path, duration=60.0)
    _, (held,) = keep_apart(runs)
    validation, windows = HoldoutValidation([held], runs), Windows(held)
    replayed = replay(base, held.motion, SimulationSettings().only(2.0), open_loop=False)
    e = subtract(held.motion, replayed.horizons["2"]).nu / validation.spread
    by_window = [np.mean(e[windows.number == k] ** 2) for k in range(len(windows.spans))]
    np.testing.assert_allclose(validation._errors([base])[0], by_window, rtol=1e-9)


def test_where_a_current_wanders_the_windows_of_one_run_are_one_sample(tmp_path):
    base, runs = observed(tmp_path, duration=60.0)
    _, holdout = keep_apart(runs)
    slower = base + LinearDamping(surge=60.0, sway=60.0)
    assert HoldoutValidation(holdout, runs).refuses(slower, base)
    assert not HoldoutValidation(holdout, runs, current_drifts=True).refuses(slower, base)
    assert not HoldoutValidation([*holdout, *holdout], runs, current_drifts=True).refuses(
        base, slower
    )
    assert HoldoutValidation([*holdout, *holdout], runs, current_drifts=True).refuses(slower, base)


def test_where_physics_is_left_a_name_must_be_surely_worth_it():
    error = np.linspace(0.5, 1.5, 20)
    assert surely_costs(1.1 * error, error, 0.02)
    assert not surely_costs(1.03 * error, error, 0.02)  # a root mean square of 1.5 % more
    once = error + np.where(np.arange(20) == 3, 10.0, 0.0)
    assert not surely_costs(once, error, 0.02)
    assert surely_costs(np.full(20, np.nan), error, 0.02)
    lost = np.append(error[1:], 1e9 * error[0])  # to first order, in a single window
    assert surely_costs(lost, error, 0.02)


class Workspace:
    """Fits nothing: hypotheses as they are, and no filter holds any but those it is given."""

    def __init__(self, finite=True):
        self.finite, self.first_order = finite, self

    def fit(self, h, prior_std):
        return Found(h, self.finite)

    def drop(self, found, groups):
        h = found.hypothesis
        return [replace(h, terms=tuple(t for t in h.terms if t not in own)) for own in groups]


class Found:
    def __init__(self, h, finite=True):
        self.hypothesis, self.is_finite, self.noise = h, finite, FIRST_NOISE


def test_an_effect_that_harms_goes_and_one_that_helps_stays(tmp_path):
    truth = [{"effect": "quadratic_damping", "parameters": {"surge": {"value": 120.0}}}]
    base, runs = observed(tmp_path, duration=60.0, effects=truth)
    _, holdout = keep_apart(runs)
    right = Term(QuadraticDamping(surge=120.0), ("surge",))
    wrong = Term(LinearDamping(sway=150.0), ("sway",))
    selection = SearchResult(Workspace(), Found(Hypothesis(base, (right, wrong))), (), True)
    passed, whole = HoldoutValidation(holdout, runs).validate(selection)
    assert [t.id for t in passed.best.hypothesis.terms] == ["quadratic_damping"]
    assert not whole
    lost = replace(selection, workspace=Workspace(finite=False))
    assert HoldoutValidation(holdout, runs).keep_earning(lost).best is lost.best
    assert HoldoutValidation(holdout, runs).keep_earning(selection).best is not selection.best
    alone = SearchResult(Workspace(), Found(Hypothesis(base, (wrong,))), (), True)
    passed, whole = HoldoutValidation(holdout, runs).validate(alone)
    assert passed.best.hypothesis.terms == ()
    assert not whole
    assert Windows(holdout[0]).spans


class Eroding(HoldoutValidation):
    """Each of four effects is worth 6 % of the error, all of them two thirds; no window is sure."""

    def _errors(self, models):
        weights = np.random.default_rng(0).uniform(0.2, 1.8, (len(models), 10))
        missing = [4 - len(m.added) for m in models]
        sizes = np.array([3.0 if k == 4 else 1.06**k for k in missing])
        return (sizes**2)[:, None] * weights / weights.mean(axis=1, keepdims=True)


def test_what_nobody_misses_one_by_one_may_be_missed_together():
    """A thruster that weakened in one run: ten windows were not sure of any effect of the file."""
    terms = (
        Term(LinearDamping(sway=9.0), ("sway",)),
        Term(QuadraticDamping(surge=9.0), ("surge",)),
        Term(AddedMass(surge=1.0), ("surge",)),
        Term(NetBuoyancy(force=1.0), ("force",)),
    )
    every = SearchResult(Workspace(), Found(Hypothesis(model(), terms)), (), True)
    kept = Eroding(["a run"], ["a run"]).keep_earning(every).best.hypothesis.terms
    assert len(kept) == 3


def test_of_two_answers_the_one_that_replays_runs_it_was_not_fitted_to_is_better(tmp_path):
    truth = [{"effect": "quadratic_damping", "parameters": {"surge": {"value": 120.0}}}]
    flown = [observed(tmp_path / str(k), duration=20.0, effects=truth, seed=k) for k in range(3)]
    base, runs = flown[0][0], [run for _, (run,) in flown]
    right = Found(Hypothesis(base, (Term(QuadraticDamping(surge=60.0), ("surge",)),)))
    wrong = Found(Hypothesis(base, (Term(LinearDamping(sway=1.0), ("sway",)),)))
    holdout = HoldoutValidation((), runs)
    assert holdout.prefers_between_runs(right, wrong) is True
    assert holdout.prefers_between_runs(wrong, right) is False
    assert holdout.prefers_between_runs(right, right) is None
    nowhere = Found(Hypothesis(base, (Term(AddedMass(surge=-100.0), ()),)))
    assert holdout.prefers_between_runs(right, nowhere) is True
    assert holdout.prefers_between_runs(nowhere, right) is False
    assert holdout.prefers_between_runs(nowhere, nowhere) is None
    assert HoldoutValidation((), runs[:1]).prefers_between_runs(right, wrong) is None


def test_every_run_is_left_out_once_in_four_groups_at_most(tmp_path, monkeypatch):
    base, (run,) = observed(tmp_path, duration=20.0)
    runs, seen = [replace(run) for _ in range(6)], []

    def fit_without(fit, whole, left_out):
        seen.append([k for k, one in enumerate(whole) if any(one is r for r in left_out)])
        return base

    monkeypatch.setattr(holdout_validation, "fit_without", fit_without)
    one = Found(Hypothesis(base))
    assert HoldoutValidation((), runs).prefers_between_runs(one, one) is None
    assert seen[::2] == [[0, 4], [1, 5], [2], [3]]
