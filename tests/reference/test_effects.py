"""Effects against wrenches worked out by hand in world axes, through the compiled engine."""

import numpy as np
import pytest

from rovsim.effects import catalogue
from rovsim.effects.current import Current
from rovsim.effects.lift import Lift
from rovsim.effects.rigid_body import Payload
from rovsim.effects.tether_tension import TetherTension
from rovsim.effects.thrusters import AdvanceLoss, PropellerTorque
from rovsim.engine.at import Inputs, Place
from rovsim.frames import from_euler, matrix
from worlds import at_rest, model

# parameters of contract, section 2, where they are not one per axis
NAMES = {
    "net_buoyancy": ["force"],
    "buoyancy_center": ["x", "y", "z"],
    "payload": ["mass", "x", "y", "z"],
    "lift": ["coefficient"],
    "current": ["north", "east", "down"],
    "thruster_lag": ["time_constant"],
    "input_delay": ["delay"],
    "clock_drift": ["rate"],
    "thruster_deadband": ["width"],
    "thruster_gain": [*(f"t{i}" for i in range(1, 9)), "all"],
    "thrust_asymmetry": ["ratio"],
    "voltage_sag": ["fraction"],
    "advance_loss": ["coefficient"],
    "propeller_torque": ["ratio"],
}
AXES = ["surge", "sway", "heave", "roll", "pitch", "yaw"]
NAMES |= dict.fromkeys(
    ["constant_wrench", "linear_damping", "quadratic_damping", "added_mass"], AXES
)
COMMAND = np.array([0.4, -0.3, 0.5, 0.2, -0.4, 0.3, 0.1, -0.2])


@pytest.mark.parametrize("name", sorted(set(NAMES) & set(catalogue())))
def test_parameters_are_the_public_ones(name):
    assert [p.name for p in catalogue()[name].parameters] == NAMES[name]


def push(world, state, force=None):
    """Wrench (6,) that a model feels at a state: M nu_dot, with thruster forces (8,) in N."""
    force = np.zeros(8) if force is None else force
    given = Inputs(
        (world.body.B @ force)[None, None], force[None, None], np.full((1, 6), np.nan),
        np.zeros(1, np.int64), np.ones(1),
    )  # fmt: skip
    site, out = Place(np.full((3, 2), np.nan), np.array([1.0, -1.0, -1.0])), np.empty((1, 6))
    world.engine.accelerations(
        np.zeros(1), state[None], world.constants, given, world.wrench_parameters()[None],
        np.empty(0), site, out,
    )  # fmt: skip
    return world.body.M @ out[0]


@pytest.fixture
def tilted():
    state = np.concatenate([[1.0, -2.0, -1.0], from_euler(0.4, -0.3, 1.1), np.zeros(6)])
    state[7:] = [0.4, -0.2, 0.1, 0.3, 0.2, -0.4]
    return state


def test_a_taut_tether_pulls_towards_its_anchor_with_a_moment(tilted):
    R, r = matrix(tilted[3:7]), np.array([-0.2, 0.05, -0.1])
    anchor = np.array([3.0, 4.0, 2.5])  # MoCap, z up
    tether = TetherTension(
        stiffness=7.0, slack_length=0.5, attachment_x=r[0], attachment_y=r[1], attachment_z=r[2],
        anchor_x=anchor[0], anchor_y=anchor[1], anchor_z=anchor[2],
    )  # fmt: skip
    line = anchor * [1, -1, -1] - (tilted[:3] + R @ r)  # in NED, from the attachment
    F = R.T @ (7.0 * (np.linalg.norm(line) - 0.5) * line / np.linalg.norm(line))
    found = push(model(tether), tilted) - push(model(), tilted)
    np.testing.assert_allclose(found, [*F, *np.cross(r, F)], atol=1e-9)
    slack = tether.with_values({"slack_length": 20.0})
    np.testing.assert_allclose(push(model(slack), tilted), push(model(), tilted), atol=1e-9)


def test_inflow_against_the_thrust_raises_it(tilted):
    world, c, v_c = model(), 0.3, np.array([0.1, 0.2, -0.05])
    force = world.thrust_path.thrusters.static_force(COMMAND)
    water = Current(**dict(zip(("north", "east", "down"), v_c, strict=True)))
    v_r = tilted[7:10] - matrix(tilted[3:7]).T @ v_c
    torque = PropellerTorque(ratio=0.02)  # comes after the loss: it sees the reduced thrust
    B = model(torque).body.B
    loss = B @ (-c * np.sign(force) * (world.body.directions @ v_r) * force)
    with_it = push(model(water, torque, AdvanceLoss(coefficient=c)), tilted, force)
    np.testing.assert_allclose(with_it - push(model(water, torque), tilted, force), loss, atol=1e-9)
    ahead = at_rest()
    ahead[7] = 0.5  # moving ahead, thruster 1 pushing ahead: less thrust
    pushing = np.eye(8)[0] * 10.0
    lost = push(model(AdvanceLoss(coefficient=c)), ahead, pushing) - push(model(), ahead, pushing)
    assert lost[0] < 0


def test_lift_sees_the_velocity_through_the_water(tilted):
    v_c = np.array([0.1, 0.2, -0.05])
    water = Current(north=0.1, east=0.2, down=-0.05)
    u, v, w = tilted[7:10] - matrix(tilted[3:7]).T @ v_c
    found = push(model(water, Lift(coefficient=12.0)), tilted) - push(model(water), tilted)
    np.testing.assert_allclose(found, [0, -12 * abs(u) * v, -12 * abs(u) * w, 0, 0, 0], atol=1e-9)


def test_a_payload_weighs_down_where_it_hangs():
    """At rest and level: m g down; forward of CO the nose drops, to starboard it lists."""
    place = np.array([0.2, 0.1, 0.05])
    world = model(Payload(mass=1.5, x=place[0], y=place[1], z=place[2]))
    weight = np.array([0.0, 0.0, 1.5 * 9.82])
    found = push(world, at_rest()) - push(model(), at_rest())
    np.testing.assert_allclose(found, [*weight, *np.cross(place, weight)], atol=1e-9)
    assert found[3] > 0 > found[4]


@pytest.mark.parametrize("axis", range(3))
def test_a_current_carries_a_resting_vehicle_along(axis):
    """In world axes, whatever the heading."""
    state, v_c = at_rest(), 0.2 * np.eye(3)[axis]
    state[3:7] = from_euler(0.0, 0.0, 2.0)
    water = Current(**dict(zip(("north", "east", "down"), v_c, strict=True)))
    found = push(model(water), state) - push(model(), state)
    along = matrix(state[3:7]) @ found[:3]
    assert along[axis] > 1.0
