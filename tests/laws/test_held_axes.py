"""Thrust that answers what nobody has read yet tells of a sensor on board, not of the vehicle."""

from dataclasses import replace

import numpy as np
import pytest

from flown import observed
from rovsim.diagnosis.checks import held_axes
from rovsim.diagnosis.checks.held_axes import WhiteRuns, find_held_axes, find_held_only
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effect_entry import EffectEntry
from rovsim.estimation.fit import fit, fit_noise_only
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.noise import FIRST_NOISE
from rovsim.simulation.synthetic_tank import pilot

PENALTY = 10.0
ROTATION = slice(3, 6)


@pytest.mark.parametrize("control", ["3dof", "6dof"])
def test_only_an_autopilot_that_sees_more_than_the_cameras_holds_axes(
    tmp_path, monkeypatch, control
):
    """That of the tank reads the true angles; with these gains its thrust shows them."""
    monkeypatch.setattr(pilot, "ANGLE_GAIN", 1.0)
    monkeypatch.setattr(pilot, "RATE_GAIN", 0.6)
    base, (run,) = observed(
        tmp_path,
        control=control,
        camera={"colour_attitude": 0.006},
        turbulence={"moment": 0.05},
    )
    noise = FIRST_NOISE
    for _ in range(2):
        bank = FilterBank.design([run], base, noise)
        left = fit_noise_only(bank.linearise(Hypothesis(base)), bank, noise)
        noise = left.noise
    held = find_held_axes(WhiteRuns.of(left, bank), base)[0]
    assert not held[:3].any()
    assert held[ROTATION].any() == (control == "3dof")


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


@pytest.mark.parametrize(
    ("forces", "refuted", "unseen"),
    [
        ((4.0, 0.0), True, False),  # it would show in the other run
        ((4.0, 4.0), False, False),  # it does
        ((4.0,), False, True),  # there is no other run
    ],
)
def test_what_shows_on_held_axes_alone_is_not_the_vehicle(
    fly, monkeypatch, forces, refuted, unseen
):
    fitted, bank = fly(*forces)

    def hold(white, model):
        held = np.zeros((len(white.runs), 6), bool)
        held[0] = True
        return held

    monkeypatch.setattr(held_axes, "find_held_axes", hold)
    found = find_held_only(fitted, bank, PENALTY)
    assert (bool(found.refuted), bool(found.unseen)) == (refuted, unseen)


def test_where_nothing_is_held_nothing_is_doubted(fly):
    assert find_held_only(*fly(4.0, 0.0), PENALTY) == (frozenset(), frozenset())
