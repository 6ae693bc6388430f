"""What a user's effect reads: forces, commands and inflow of actuators, and logged channels."""

from dataclasses import replace

import numpy as np
import pytest

from rovsim.core.errors import BadInput
from rovsim.core.run import Logged, Site
from rovsim.dynamics.actuation import Thrust
from rovsim.dynamics.catalogue import built_in, load_catalogue
from rovsim.dynamics.effects.base import Wrench
from rovsim.dynamics.engine.types import NO_MEMORY
from rovsim.dynamics.laws.thrust_law import ThrustLaw
from rovsim.dynamics.model import nominal
from rovsim.dynamics.vehicle import load_vehicle
from rovsim.simulation.batch import Batch
from rovsim.simulation.drive import Drive
from rovsim.simulation.replay import simulate
from rovsim.simulation.settings import ReplaySettings
from worlds import at_rest, model, motion

READER = """
from rovsim.dynamics.effects.base import Parameter, Wrench

class Probe(Wrench):
    "Shows what it reads as a force."
    id = "probe"
    equation, neglects, source = "X = k", "all else", "a test"
    parameters = (Parameter("k", "1", "k", scale=1.0),)
    channels = ("winch", "sea")

    @staticmethod
    def wrench(at, p):
        a = at.actuators
        return (
            p.k * a.force[0], p.k * a.command[2], p.k * a.inflow[2][1],
            p.k * at.channels.winch, p.k * at.channels.sea, p.k * a.inflow[0][0],
        )
"""


@pytest.fixture
def probe(tmp_path):
    (tmp_path / "probe.py").write_text(READER)
    return load_catalogue([tmp_path / "probe.py"])["probe"]


HELPED = """
import numpy as np
from rovsim.dynamics.effects.base import Parameter, Wrench
from rovsim.dynamics.compilation.compiled import inlined

@inlined
def actuator(at, i):
    return at.actuators.force[i]

@inlined
def twice(at):
    return 2.0 * actuator(at, 0)

class Helped(Wrench):
    "Reads through helpers."
    id = "helped"
    equation, neglects, source = "X = 2 k F", "all else", "a test"
    parameters = (Parameter("k", "1", "k", scale=1.0),)

    @staticmethod
    def wrench(at, p):
        return p.k * twice(at), 0.0, 0.0, 0.0, 0.0, 0.0
"""


def test_a_helper_may_read_for_it(tmp_path):
    (tmp_path / "helped.py").write_text(HELPED)
    helped = load_catalogue([tmp_path / "helped.py"])["helped"]
    found = read(load_vehicle("remus100"), helped(k=0.5), [0.5, 0.1, -0.2], np.zeros(6), ())
    np.testing.assert_allclose(found, [3.86 * 0.25, 0.0, 0.0, 0.0, 0.0, 0.0], atol=1e-9)


def test_only_effects_that_read_are_handed_what_is_read():
    reading = {name for name, cls in built_in().items() if issubclass(cls, Wrench) and cls.reads()}
    assert reading == set()
    assert ThrustLaw.reads()


def push(world, thrust, nu):
    """M nu_dot (6,) at a velocity."""
    state = np.concatenate([at_rest()[:7], nu])
    drive = Drive.by(world, thrust, 1.0)
    found = Batch([world], Site.unknown()).accelerations(drive, np.zeros(1), state[None], NO_MEMORY)
    return world.body.M @ found[0]


def read(vehicle, effect, command, nu, channels=(0.3, -2.0)):
    """What the probe shows of a torpedo."""
    none = np.full((1, 6), np.nan)
    force = nominal(vehicle).thrust_path.thrusters.static_force(np.array([[command[0]]]))
    seen = np.array([[*command, *channels]])
    thrust = Thrust(force, np.zeros((1, 6)), none, angle=np.array([command[1:]]), read=seen)
    return push(nominal(vehicle) + effect, thrust, nu) - push(nominal(vehicle), thrust, nu)


def test_it_reads_what_drives_a_torpedo(probe):
    effect = probe(k=2.0)
    nu = np.array([1.0, 0.2, -0.1, 0.1, 0.2, -0.3])
    remus = load_vehicle("remus100")
    found = read(remus, effect, [0.5, 0.1, -0.2], nu)
    places = [np.array([-0.70, 0, 0]), np.array([-0.638, 0, 0])]
    local = [nu[:3] + np.cross(nu[3:], r) for r in places]
    expected = [3.86 * 0.25, -0.2, local[1][1], 0.3, -2.0, local[0][0]]
    np.testing.assert_allclose(found, 2.0 * np.array(expected), atol=1e-9)


def test_channels_of_a_log_reach_it_and_are_missed(probe):
    run = motion(np.zeros((1, 8)), seconds=0.1)
    start = [(0, 10, at_rest())]
    with pytest.raises(BadInput, match="no channel 'winch' was logged"):
        simulate(model(probe(k=1.0)), run, start, ReplaySettings())
    logged = {
        "winch": Logged(np.array([0.0, 1.0]), np.array([0.0, 1.0])),
        "sea": Logged(np.zeros(1), np.zeros(1)),
    }
    run = replace(run, commands=replace(run.commands, auxiliary=logged))
    end, still = (
        simulate(world, run, start, ReplaySettings())[0][-1]
        for world in (model(probe(k=1.0)), model())
    )
    inertia = model().body.M[3, 3]
    assert (end - still)[10] == pytest.approx(0.5 * 0.1**2 / inertia, rel=0.1)  # a ramp's integral


def test_models_with_and_without_it_go_side_by_side(probe):
    """What one model's effects do not read is zero for it, and changes nothing."""
    worlds = [model(), model(probe(k=0.0))]
    command = np.zeros((1, 8))
    drives = [
        Drive.by(w, Thrust(command, np.zeros((1, 6)), np.full((1, 6), np.nan)), 1.0) for w in worlds
    ]
    batch = Batch(worlds, Site.unknown())
    inputs = batch._inputs(drives)
    assert inputs.acting.shape[-1] == 8 + 16 + 2
