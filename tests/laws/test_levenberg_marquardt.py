"""The descent ends at the least squares also where one value acts in jumps."""

import numpy as np
import pytest

from rovsim.dynamics.catalogue import built_in
from rovsim.estimation.levenberg_marquardt import levenberg_marquardt
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.noise import FIRST_NOISE
from rovsim.estimation.observer.residual_source import linearise
from worlds import model

COUNT = 50
WIDTH, GRAIN = 0.06, 0.005  # of the dead band


class Errors:
    """A source of errors that are a formula."""

    def evaluate(self, models):
        return [np.stack([self._errors(one) for one in models])]

    def linearise(self, at):
        return linearise(at, self.evaluate)

    def whiten(self, e, noise):
        return np.concatenate(e, axis=-1)


class Jumping(Errors):
    """Errors linear in drag; a wider dead band seems to help, and two grains on is far worse."""

    def _errors(self, world):
        by_id = {one.id: one for one in world.added}
        drag = by_id["quadratic_damping"]["surge"]
        grains = (by_id["thruster_deadband"]["width"] - WIDTH) / GRAIN
        found = np.zeros((6, COUNT))
        found[0] = 0.5 * (drag - 40.0) * np.sin(np.arange(COUNT))
        found[1] = 10.0 - 0.5 * grains + (200.0 if grains > 1.5 else 0.0)
        return found


def test_drag_is_fitted_while_the_derivative_of_a_dead_band_promises_too_much():
    start = Hypothesis(
        model(),
        (
            Term(built_in()["quadratic_damping"](), ("surge",)),
            Term(built_in()["thruster_deadband"](width=WIDTH), ("width",)),
        ),
    )
    found = levenberg_marquardt(start, Jumping(), FIRST_NOISE).hypothesis.terms
    assert found[0].effect["surge"] == pytest.approx(40.0, abs=0.5)
    assert found[1].effect["width"] < WIDTH + 2.0 * GRAIN


class Saturated(Errors):
    """Errors that hardly change with drag in surge where it is far off; linear ones in sway."""

    def _errors(self, world):
        (drag,) = world.added
        found = np.zeros((6, COUNT))
        found[0] = 30.0 * np.tanh(3.5 - drag["surge"] / 10.0)
        found[1] = 1.0 - drag["sway"] / 40.0
        return found


def test_a_step_that_damping_made_short_is_followed_by_others():
    start = Hypothesis(model(), (Term(built_in()["quadratic_damping"](), ("surge", "sway")),))
    (found,) = levenberg_marquardt(start, Saturated(), FIRST_NOISE).hypothesis.terms
    assert found.effect["surge"] == pytest.approx(35.0, abs=0.5)
    assert found.effect["sway"] == pytest.approx(40.0, abs=0.5)


class Linear(Errors):
    """Errors linear in drag, 40 in surge and in sway; counts how often it is linearised."""

    def __init__(self):
        self.linearised = 0

    def linearise(self, at):
        self.linearised += 1
        return super().linearise(at)

    def _errors(self, world):
        (drag,) = world.added
        found = np.zeros((6, COUNT))
        found[0] = 0.5 * (drag["surge"] - 40.0) * np.sin(np.arange(COUNT))
        found[1] = 0.5 * (drag["sway"] - 40.0) * np.cos(np.arange(COUNT))
        return found


def test_a_last_small_step_needs_no_new_derivatives():
    term = Term(built_in()["quadratic_damping"](surge=40.0001, sway=40.0), ("surge", "sway"))
    source, start = Linear(), Hypothesis(model(), (term,))
    found = levenberg_marquardt(start, source, FIRST_NOISE)
    there = source.linearise(found.hypothesis)
    assert source.linearised == 2  # that of the start, and this one
    assert found.hypothesis.terms[0].effect["surge"] == pytest.approx(40.0, abs=1e-6)
    np.testing.assert_array_equal(found.e, there.e)
    np.testing.assert_allclose(found.J, there.J, rtol=1e-6, atol=1e-9)
