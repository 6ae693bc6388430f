"""Thrust that answers what nobody has read yet tells of a sensor on board, not of the vehicle."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from flown import observed
from rovsim.diagnosis import validated_search
from rovsim.diagnosis.checks.feedback_axes import (
    FeedbackOnly,
    find_feedback_axes,
    find_feedback_only,
    find_unpredicted,
)
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effect_entry import EffectEntry
from rovsim.estimation.fit import fit, fit_noise_only
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.noise import FIRST_NOISE
from rovsim.simulation.synthetic_tank import pilot

PENALTY = 10.0
ROTATION = slice(3, 6)


def left_by_base(tmp_path, control, **tank):
    """A bank of one run, and a fit of the noise that the base leaves."""
    base, runs = observed(tmp_path, control=control, **tank)
    noise = FIRST_NOISE
    for _ in range(2):
        bank = FilterBank.design(runs, base, noise)
        left = fit_noise_only(bank.linearise(Hypothesis(base)), bank, noise)
        noise = left.noise
    return left, bank


@pytest.fixture
def steer(tmp_path, monkeypatch):
    """The tank's autopilot reads the true angles; with these gains its thrust shows them."""
    monkeypatch.setattr(pilot, "ANGLE_GAIN", 1.0)
    monkeypatch.setattr(pilot, "RATE_GAIN", 0.6)
    camera, turbulence = {"colour_attitude": 0.006}, {"moment": 0.05}
    return lambda control: left_by_base(tmp_path, control, camera=camera, turbulence=turbulence)


@pytest.mark.parametrize("control", ["3dof", "6dof"])
def test_only_an_autopilot_that_sees_more_than_the_cameras_is_found(steer, control):
    axes = find_feedback_axes(*steer(control))
    assert not axes[0, :3].any()
    assert axes[0, ROTATION].any() == (control == "3dof")


def test_parts_of_a_run_count_together(steer):
    left, bank = steer("3dof")
    (run,) = bank.runs
    middle = run.motion.time.mean()
    parts = [run.limited(run.motion.time < middle), run.limited(run.motion.time >= middle)]
    bank = FilterBank.design(parts, left.hypothesis.model, left.noise)
    left = fit_noise_only(bank.linearise(left.hypothesis), bank, left.noise)
    axes = find_feedback_axes(left, bank)
    assert axes.any()
    assert (axes[0] == axes[1]).all()


def test_a_run_of_few_readings_shows_nothing(tmp_path):
    left, bank = left_by_base(tmp_path, "6dof", duration=15.0)
    (run,) = bank.runs
    short = run.limited(run.motion.time < run.motion.time[0] + 2.5)
    e = np.ones((6, int(short.settled.sum())))
    assert np.isfinite(find_unpredicted(short, left.hypothesis.model, e)).all()


@pytest.fixture(scope="module")
def fly(tmp_path_factory):
    """A fit of net buoyancy to runs with these net buoyancies, and its bank."""

    def make(*forces):
        runs = []
        for k, force in enumerate(forces):
            effects = (EffectEntry(effect="net_buoyancy", parameters={"force": force}),)
            folder = tmp_path_factory.mktemp("run")
            base, (run,) = observed(folder, duration=15.0, seed=k, effects=effects)
            info = replace(run.motion.run, id=f"run-{k}")
            runs.append(replace(run, motion=replace(run.motion, run=info)))
        bank = FilterBank.design(runs, base, FIRST_NOISE)
        start = Hypothesis(base, (Term(built_in()["net_buoyancy"](), ("force",)),))
        return fit(start, bank, FIRST_NOISE), bank

    return make


def weigh(fitted, i):
    return fitted.wald_statistic(fitted.hypothesis.columns[i]) / PENALTY


@pytest.mark.parametrize(
    ("forces", "refuted", "unseen"),
    [
        ((4.0, 0.0), True, False),  # it would show in the other run
        ((9.0, -4.0), True, False),  # there it is the opposite
        ((4.0, 4.0), False, False),  # it does show
        ((4.0,), False, True),  # there is no other run
        ((0.0, 0.0), False, False),  # it is worth nothing anyway
    ],
)
def test_what_shows_on_these_axes_alone_is_not_the_vehicle(fly, forces, refuted, unseen):
    fitted, bank = fly(*forces)
    axes = np.zeros((len(forces), 6), bool)
    axes[0] = True
    found = find_feedback_only(fitted, bank, axes, weigh)
    assert (bool(found.refuted), bool(found.unseen)) == (refuted, unseen)
    nowhere = find_feedback_only(fitted, bank, np.zeros_like(axes), weigh)
    assert nowhere == FeedbackOnly()


@pytest.mark.parametrize("diverges", [False, True])
def test_refuted_effects_go_one_by_one_or_are_doubted(monkeypatch, diverges):
    """`worst` goes, and without it `worse` is no longer refuted."""
    workspace = SimpleNamespace(weigh_term=None)
    selection = SimpleNamespace(is_joint=False, workspace=workspace)
    settled = SimpleNamespace(
        complete=True, selection=selection, whole_file_fit=None, fit=("worst", "worse"), bank=None
    )

    def without(answer, effect_id, usable):
        left = tuple(name for name in answer.fit if name != effect_id)
        return None if diverges else SimpleNamespace(**vars(answer) | {"fit": left})

    def find(fit, bank, axes, weigh):
        return FeedbackOnly(fit if len(fit) == 2 else (), frozenset({"unseen"}))

    monkeypatch.setattr(validated_search, "find_feedback_axes", lambda fit, bank: None)
    monkeypatch.setattr(validated_search, "find_feedback_only", find)
    monkeypatch.setattr(validated_search, "settle_without", without)
    answer, doubted = validated_search._judge_feedback(settled, None)
    assert answer.fit == (("worst", "worse") if diverges else ("worse",))
    assert doubted == ({"worst", "worse", "unseen"} if diverges else {"unseen"})
