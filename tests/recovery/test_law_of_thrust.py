"""A law of the thrust, hidden in a short campaign, is found: what it is made of, and its size."""

import pytest

from rovsim.benchmarks.blind.asking import diagnosis
from rovsim.diagnosis.equations.with_thrust import ThrustTerm, WithThrust, build_law
from rovsim.dynamics.catalogue import built_in
from rovsim.simulation.synthetic_tank.campaign import make_campaign
from rovsim.simulation.synthetic_tank.settings import TankRun, TankSettings
from worlds import model

RUNS = (
    TankRun(id="a", control="6dof", split="train"),
    TankRun(id="b", control="6dof", split="train"),
    TankRun(id="c", control="6dof", split="test"),
)
TERM, SIZE = ThrustTerm(5, 2, True, 1), 0.3  # s


@pytest.mark.thorough
def test_a_law_of_the_thrust_is_found(tmp_path):
    """What drifts is turned by the water that vertical thrusters take along."""
    settings = TankSettings(name="turned", seed=11, duration=16.0, runs=RUNS)
    hidden = build_law(TERM, model(), size=1.0, coefficient=SIZE).effect
    make_campaign(settings, tmp_path / "raw", built_in(), unlisted=[hidden])
    found = diagnosis(tmp_path / "raw", tmp_path)
    assert found.verdict == "unexplained"
    law = found.unexplained.proposal
    assert law.equation == WithThrust(TERM).equation
    (value,) = law.parameters.values()
    assert value.unit == "s"
    assert value.value == pytest.approx(SIZE, abs=4.0 * value.std)
    assert found.ladder.models[-1].windows_2s < 1.2 * found.error.noise_floor
