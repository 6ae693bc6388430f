"""The baseline of the blind benchmark finds a linear effect in data without noise."""

from dataclasses import replace

import numpy as np
import pytest

from rovsim.benchmarks.blind import methods
from rovsim.benchmarks.blind.flight import fly
from rovsim.benchmarks.blind.library import problem, steps
from rovsim.benchmarks.blind.sparse import answer, forward, stlsq, thresholded
from rovsim.benchmarks.blind.suites import nothing
from rovsim.core import extras
from rovsim.core.errors import BadInput
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effects.base import MeasurementFilter
from rovsim.measurement.signals.chain import SignalSettings
from rovsim.simulation.measured_states import accelerate_as_measured, drive_as_measured
from rovsim.simulation.settings import ReplaySettings
from worlds import model, motion, sticks, tank

# enough to choose from, and nothing to compile
OFFERED = {
    n: built_in()[n] for n in ("added_mass", "linear_damping", "net_buoyancy", "thruster_gain")
}
BOTH = pytest.mark.parametrize(
    "regression", [thresholded(0.1, 1e-3), forward(0.05, 8)], ids=["stlsq", "frols"]
)
DRAG = {"surge": 20.0}


def exact(world):
    """A motion of a vehicle of this world, measured without noise: smooth at random, not flown."""
    still = motion(sticks(2, rows=40), seconds=8.0)
    phase, k = np.random.default_rng(3).uniform(0, 6, (6, 4)), np.arange(1, 5)
    nu = 0.1 * np.sin(still.time[:, None, None] * k + phase).sum(axis=-1)
    moving = replace(still, nu=nu, state_nu=nu)
    true = accelerate_as_measured(world, moving, drive_as_measured(world, moving, ReplaySettings()))
    return replace(moving, nu_dot=SignalSettings().filter.smoothed(true, 0.01))


@BOTH
def test_a_linear_effect_is_found_with_its_value(regression):
    run = exact(model(built_in()["linear_damping"](**DRAG)))
    found = answer(problem(model(), [run], OFFERED), regression)
    assert found.verdict == "missing_effects"
    assert [one.effect for one in found.selected] == ["linear_damping"]
    assert found.selected[0].parameters["surge"].value == pytest.approx(20.0, rel=0.02)


@BOTH
def test_nothing_is_found_where_nothing_is_hidden(regression):
    found = answer(problem(model(), [exact(model())], OFFERED), regression)
    assert (found.verdict, found.selected) == ("adequate", ())


def test_every_effect_has_its_columns():
    known = built_in()
    found = [(column, made) for column, made in steps(tank(), known)]
    filters = {name for name, effect in known.items() if issubclass(effect, MeasurementFilter)}
    assert {column.effect for column, _ in found} == set(known) - filters
    for column, made in found:
        assert type(made) is known[column.effect]
        assert made.given() or column.step


@pytest.mark.thorough
def test_noisy_poses_are_not_taken_for_physics(tmp_path):
    """The noise of cameras is most of the target: no column may stand for it."""
    empty = nothing(0, "development", tank={"duration": 20.0})
    fly(empty, tmp_path)
    assert stlsq(tmp_path, tmp_path).selected == ()


def test_without_the_package_the_message_says_what_to_do(monkeypatch):
    monkeypatch.setattr(extras, "find_spec", lambda name: None)
    with pytest.raises(BadInput, match=r"pip install 'rovsim\[benchmark\]'"):
        methods.chosen(["frols"])
