"""Nominal parameters that are wrong come back; what is not theirs stays physical."""

import numpy as np
import pytest

from flown import observed
from rovsim.dynamics.effect_entry import EffectEntry
from rovsim.estimation.refit import refit_nominal


def train(folder, effects, control="6dof", duration=25.0):
    """The nominal model, and one train run as the observer sees it."""
    return observed(folder, control, duration=duration, effects=effects, seed=5)


def test_wrong_nominal_parameters_come_back(tmp_path):
    hidden = (
        EffectEntry(effect="quadratic_damping", parameters={"surge": 80.0, "sway": 90.0}),
        EffectEntry(effect="net_buoyancy", parameters={"force": 3.0}),
    )
    base, runs = train(tmp_path, hidden)
    found = refit_nominal(base, runs)
    changes = {e.id: e for e in found.effects[len(base.effects) :]}
    gain = changes["thruster_gain"]["all"]  # masses, drag and forces are known in units of it
    lift = found.body.buoyancy - found.body.weight
    assert lift / gain == pytest.approx(base.body.buoyancy - base.body.weight + 3.0, abs=0.3)
    drag = base.body.quadratic[:2] + np.array([80.0, 90.0])
    assert found.body.quadratic[:2] / gain == pytest.approx(drag, rel=0.2)


def test_what_is_not_theirs_leaves_them_physical(tmp_path):
    lag = EffectEntry(effect="thruster_lag", parameters={"time_constant": 0.3})
    base, runs = train(tmp_path, (lag,), control="3dof")
    body = refit_nominal(base, runs).body
    assert np.all(body.linear >= -1e-9)
    assert np.all(body.quadratic >= -1e-9)
    assert np.all(np.linalg.eigvalsh(body.M) > 0.0)


def test_too_little_changes_nothing(tmp_path):
    base, runs = train(tmp_path, (), duration=4.0)
    found = refit_nominal(base, runs)
    assert found.name == "refitted"
    assert found.added == ()
