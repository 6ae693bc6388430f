"""The budget: parts add up, and each is what its equation says."""

import numpy as np
import pytest

from rovsim.core.rotations import exp
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effects.base import Autopilot, DemandTransform
from rovsim.dynamics.vehicle import load_vehicle
from rovsim.evaluation import force_budget
from rovsim.evaluation.force_budget import RESTORING, balance_forces
from rovsim.results.force_budget import ForceBudget
from rovsim.simulation.measured_states import (
    accelerate_as_measured,
    drive_as_measured,
    undo_mocap_view,
)
from rovsim.simulation.settings import ReplaySettings, SimulationSettings
from small_study import ROOT
from worlds import at_rest, beside_others, model, motion, some, sticks, tank


def run(kind="thruster", columns=8):
    start = at_rest()
    start[3:7] = exp(np.array([0.2, -0.1, 0.7]))
    start[7:] = [0.4, -0.2, 0.1, 0.3, -0.2, 0.5]
    value = sticks()[:, : columns if kind == "thruster" else 6]
    return motion(value, kind, start=start, site=tank())


def made(world, found=None):
    found = found or run()
    return balance_forces(world, found, SimulationSettings())


@pytest.mark.parametrize("cls", built_in().values(), ids=lambda cls: cls.id)
def test_the_parts_add_up_to_the_models_inertia_force(cls):
    world = beside_others(some(cls))
    columns = world.thrust_path.columns("thruster")
    measured = run(
        "demand" if issubclass(cls, Autopilot | DemandTransform) else "thruster", columns
    )
    true = undo_mocap_view(world, measured)
    at = drive_as_measured(world, true, ReplaySettings())
    expected = accelerate_as_measured(world, true, at) @ world.body.M.T
    parts = made(world, measured).parts
    np.testing.assert_allclose(sum(parts.values()), expected, atol=1e-9)
    assert f"+{cls.id}" in parts


def test_each_part_is_what_its_equation_says(tmp_path):
    world, measured = model(), run()
    found = made(world, measured)
    nu, hydro = measured.nu[0], world.vehicle.hydrodynamics
    linear = -np.array(hydro.linear_damping) * nu
    np.testing.assert_allclose(found.parts["linear damping"][0], linear, atol=1e-9)
    quadratic = -np.array(hydro.quadratic_damping) * np.abs(nu) * nu
    np.testing.assert_allclose(found.parts["quadratic damping"][0], quadratic, atol=1e-9)
    for name in ("Coriolis", "added-mass Coriolis"):
        assert found.parts[name][0] @ nu == pytest.approx(0, abs=1e-9)
    weight = world.body.weight - world.body.buoyancy
    assert np.linalg.norm(found.parts[RESTORING][0, :3]) == pytest.approx(abs(weight))
    found.write(tmp_path / "b.npz")
    again = ForceBudget.read(tmp_path / "b.npz")
    assert again.rms() == found.rms()
    assert list(again.parts) == list(found.parts)


def test_an_effect_of_the_vehicle_without_a_named_part_is_one_of_its_own(monkeypatch):
    named = made(model())
    monkeypatch.delitem(force_budget.NOMINAL_PARTS, "quadratic_damping")
    found = made(model())
    drag = found.parts["quadratic_damping"]
    np.testing.assert_allclose(drag, named.parts["quadratic damping"], atol=1e-9)
    np.testing.assert_allclose(sum(found.parts.values()), sum(named.parts.values()), atol=1e-9)


@pytest.mark.parametrize("name", [path.stem for path in (ROOT / "conf/vehicle").glob("*.yaml")])
def test_all_that_a_vehicle_has_is_part_of_the_budget(name):
    held = {"rigid_body", "thrusters", "held_axes"}  # weight, Coriolis; commands; no force
    for effect in load_vehicle(name).effects():
        assert effect.id in (held if effect.neutral() is effect else force_budget.NOMINAL_PARTS)


def test_the_missing_force_is_the_one_that_was_left_out():
    """A push the model lacks comes back as missing, newton for newton."""
    from dataclasses import replace

    from rovsim.dynamics.effects.constant_wrench import ConstantWrench

    measured, world = run(), model()
    pushed = model(ConstantWrench(surge=3.0, yaw=-1.0))
    at = drive_as_measured(pushed, measured, ReplaySettings())
    moved = replace(measured, nu_dot=accelerate_as_measured(pushed, measured, at))
    both = [balance_forces(world, one, SimulationSettings()).missing for one in (moved, measured)]
    change = (both[0] - both[1] - moved.nu_dot @ world.body.M.T)[5:-5]
    np.testing.assert_allclose(change, 0.0, atol=1e-9)
    assert "+constant_wrench" in made(pushed).parts
    np.testing.assert_allclose(made(pushed).parts["+constant_wrench"][:, 0], 3.0, atol=1e-9)
