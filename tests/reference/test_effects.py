"""Effects against wrenches worked out by hand in world axes, through the compiled engine."""

import numpy as np
import pytest

from rovsim.core.errors import BadInput
from rovsim.core.rotations import from_euler, matrix
from rovsim.core.run import Site
from rovsim.dynamics.actuation import Thrust
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effects.added_mass import AddedMassCoupling
from rovsim.dynamics.effects.coupled_damping import CoupledDamping
from rovsim.dynamics.effects.current import Current
from rovsim.dynamics.effects.damping import CubicDamping, LinearDamping
from rovsim.dynamics.effects.dry_friction import DryFriction
from rovsim.dynamics.effects.fluid_memory import FluidMemory
from rovsim.dynamics.effects.lift import Lift
from rovsim.dynamics.effects.onboard_control import OnboardControl
from rovsim.dynamics.effects.proximity import SurfaceProximity, WallProximity
from rovsim.dynamics.effects.rigid_body import Payload
from rovsim.dynamics.effects.tether import TetherDrag, TetherTension
from rovsim.dynamics.effects.thrusters import AdvanceLoss, PropellerTorque
from rovsim.dynamics.engine.types import NO_MEMORY
from rovsim.simulation.batch import Batch
from rovsim.simulation.drive import Drive
from rovsim.simulation.replay import simulate
from rovsim.simulation.settings import ReplaySettings
from worlds import at_rest, model, motion

# parameters of docs/catalogue.md, where they are not one per axis; `rate` of voltage_sag
# and `latency` of pose_filter are ours, and change nothing unless given
NAMES = {
    "net_buoyancy": ["force"],
    "buoyancy_center": ["x", "y", "z"],
    "payload": ["mass", "x", "y", "z"],
    "lift": ["coefficient"],
    "current": ["north", "east", "down"],
    "current_drift": ["rate"],
    "thruster_lag": ["time_constant"],
    "input_delay": ["delay"],
    "clock_drift": ["rate"],
    "thruster_deadband": ["width"],
    "force_curve": ["exponent"],
    "thruster_gain": [*(f"t{i}" for i in range(1, 9)), "all"],
    "thrust_asymmetry": ["ratio"],
    "voltage_sag": ["fraction", "rate"],
    "advance_loss": ["coefficient"],
    "propeller_torque": ["ratio"],
    "fin_effectiveness": ["all"],
    "thruster_order": ["first", "second"],
    "waterplane_stiffness": ["heave", "roll", "pitch"],
}
AXES = ["surge", "sway", "heave", "roll", "pitch", "yaw"]
ANCHOR = [f"{point}_{axis}" for point in ("anchor", "attachment") for axis in "xyz"]
PAIRS = [(a, b) for a in AXES for b in AXES if a != b]
NAMES |= {
    "coupled_damping": [f"{a}_from_{b}{end}" for end in ("", "_quadratic") for a, b in PAIRS],
    "added_mass_coupling": [f"{a}_{b}" for a, b in PAIRS if AXES.index(a) < AXES.index(b)],
    "fluid_memory": ["coefficient", "time_constant"],
    "onboard_control": [
        *(f"{name}_{axis}" for name in ("gain", "bandwidth") for axis in AXES),
        "attitude",
    ],
    "tether_tension": ["stiffness", "slack_length", *ANCHOR],
    "tether_drag": ["coefficient", *ANCHOR],
    "wall_proximity": ["gain", "length_scale"],
    "surface_proximity": ["gain", "length_scale"],
    "pose_filter": ["cutoff", "latency"],
    "marker_offset": ["x", "y", "z"],
    "marker_misalignment": ["roll", "pitch", "yaw"],
    "world_tilt": ["roll", "pitch"],
}
NAMES |= dict.fromkeys(
    [
        "constant_wrench",
        "linear_damping",
        "quadratic_damping",
        "cubic_damping",
        "dry_friction",
        "added_mass",
    ],
    AXES,
)
COMMAND = np.array([0.4, -0.3, 0.5, 0.2, -0.4, 0.3, 0.1, -0.2])


@pytest.mark.parametrize("name", sorted(set(NAMES) & set(built_in())))
def test_parameters_are_the_public_ones(name):
    assert [p.name for p in built_in()[name].parameters] == NAMES[name]


def push(world, state, force=None, walls=None, demand=None, memory=NO_MEMORY):
    """Wrench (6,) that a model feels at a state: M nu_dot, with thruster forces (8,) in N."""
    walls = np.full((3, 2), np.nan) if walls is None else walls
    demand = np.full(6, np.nan) if demand is None else demand
    force = np.zeros(8) if force is None else force
    drive = Drive.by(world, Thrust(force[None], np.zeros((1, 6)), demand[None]), 1.0)
    batch = Batch([world], Site(walls, np.array([1.0, -1.0, -1.0])))
    return world.body.M @ batch.accelerations(drive, np.zeros(1), state[None], memory)[0]


@pytest.fixture
def tilted():
    state = np.concatenate([[1.0, -2.0, -1.0], from_euler(0.4, -0.3, 1.1), np.zeros(6)])
    state[7:] = [0.4, -0.2, 0.1, 0.3, 0.2, -0.4]
    return state


def test_a_taut_tether_pulls_towards_its_anchor_with_a_moment(tilted):
    R, r = matrix(tilted[3:7]), np.array([-0.2, 0.05, -0.1])
    anchor = np.array([3.0, 4.0, 2.5])  # MoCap, z up
    tether = TetherTension(
        stiffness=7.0,
        slack_length=0.5,
        attachment_x=r[0],
        attachment_y=r[1],
        attachment_z=r[2],
        anchor_x=anchor[0],
        anchor_y=anchor[1],
        anchor_z=anchor[2],
    )
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


@pytest.mark.parametrize(
    ("cls", "law"), [(CubicDamping, lambda v: v**3), (DryFriction, lambda v: np.tanh(v / 0.01))]
)
def test_further_laws_of_drag_act_axis_by_axis_on_the_velocity_through_the_water(cls, law, tilted):
    coefficient, water = np.array([5.0, 4.0, 0.0, 0.3, 0.2, 0.1]), Current(north=0.1, east=0.2)
    nu_r = tilted[7:].copy()
    nu_r[:3] -= matrix(tilted[3:7]).T @ [0.1, 0.2, 0.0]
    effect = cls(**dict(zip(AXES, coefficient, strict=True)))
    found = push(model(water, effect), tilted) - push(model(water), tilted)
    np.testing.assert_allclose(found, -coefficient * law(nu_r), atol=1e-9)


WALLS = np.array([[-3.0, 3.0], [-3.0, 2.0], [-1.6, 2.0]])  # NED: the surface is at -1.6


def test_coupled_damping_pushes_one_axis_by_another(tilted):
    """N = -3 v - 5 |v| v and X = -2 q: nothing else, nothing mirrored."""
    values = {"yaw_from_sway": 3.0, "yaw_from_sway_quadratic": 5.0, "surge_from_pitch": 2.0}
    found = push(model(CoupledDamping(**values)), tilted) - push(model(), tilted)
    v, q = tilted[8], tilted[11]
    expected = [-2.0 * q, 0, 0, 0, 0, -3.0 * v - 5.0 * abs(v) * v]
    np.testing.assert_allclose(found, expected, atol=1e-9)


def test_added_mass_coupling_is_symmetric_and_its_coriolis_follows(tilted):
    world = model(AddedMassCoupling(surge_pitch=0.4, sway_yaw=-0.3))
    change = np.zeros((6, 6))
    change[0, 4] = change[4, 0] = 0.4
    change[1, 5] = change[5, 1] = -0.3
    np.testing.assert_array_equal(world.body.M - model().body.M, change)
    nu = tilted[7:]
    h = change @ nu  # momentum of the change: tau = -(omega x h1, v x h1 + omega x h2)
    moment = np.cross(nu[:3], h[:3]) + np.cross(nu[3:], h[3:])
    expected = -np.concatenate([np.cross(nu[3:], h[:3]), moment])
    np.testing.assert_allclose(push(world, tilted) - push(model(), tilted), expected, atol=1e-9)


def test_walls_multiply_all_diagonal_damping_and_gains_add(tilted):
    """At NED (1, -2, -1): 2 m and 1 m from the nearer walls, 0.6 m below the surface."""
    extra = LinearDamping(sway=4.0)
    both = model(
        extra,
        WallProximity(gain=0.8, length_scale=0.7),
        SurfaceProximity(gain=0.5),
        CoupledDamping(yaw_from_sway=3.0),
    )
    bare = model(extra, CoupledDamping(yaw_from_sway=3.0))
    body, nu = bare.body, tilted[7:]
    drag = -(body.linear + body.quadratic * np.abs(nu)) * nu
    factor = 0.8 * (np.exp(-2 / 0.7) + np.exp(-1 / 0.7)) + 0.5 * np.exp(-0.6 / 0.4)
    found = push(both, tilted, walls=WALLS) - push(bare, tilted, walls=WALLS)
    np.testing.assert_allclose(found, factor * drag, atol=1e-9)
    np.testing.assert_allclose(push(both, tilted), push(bare, tilted), atol=1e-12)  # no walls known


@pytest.mark.parametrize("given_anchor", [False, True])
def test_a_towed_tether_drags_at_its_attachment(tilted, given_anchor):
    """Without an anchor: over the middle of the tank, NED (0, -0.5, -1.6)."""
    anchor = {"anchor_x": 2.0, "anchor_y": 1.0, "anchor_z": 1.5} if given_anchor else {}
    place = np.array([2.0, -1.0, -1.5] if given_anchor else [0.0, -0.5, -1.6])
    water = Current(north=0.1)
    v = tilted[7:10] - matrix(tilted[3:7]).T @ [0.1, 0, 0]
    F = -1.5 * np.linalg.norm(place - tilted[:3]) * np.linalg.norm(v) * v
    world = model(water, TetherDrag(coefficient=1.5, **anchor))
    found = push(world, tilted, walls=WALLS) - push(model(water), tilted, walls=WALLS)
    np.testing.assert_allclose(found, [*F, *np.cross([-0.2, 0, 0], F)], atol=1e-9)


def test_remembered_water_pushes_along(tilted):
    """tau = -c diag(1, 1, 1, k, k, k) (nu_r - m) with k = 0.02 m2, whatever the walls."""
    m = np.array([0.1, 0.2, -0.3, 0.4, -0.5, 0.6])
    near = WallProximity(gain=2.0)
    world = model(FluidMemory(coefficient=6.0, time_constant=0.5), near)
    found = push(world, tilted, walls=WALLS, memory=m[None]) - push(
        model(near), tilted, walls=WALLS
    )
    expected = -6.0 * np.array([1, 1, 1, 0.02, 0.02, 0.02]) * (tilted[7:] - m)
    np.testing.assert_allclose(found, expected, atol=1e-9)


@pytest.mark.parametrize("attitude", [0.0, 1.0])
def test_a_loop_on_board_chases_its_set_point(tilted, attitude):
    demand = np.array([0.5, np.nan, np.nan, 0.2, -0.4, 0.3])
    gain = {"gain_surge": 0.8, "gain_roll": 0.6, "gain_pitch": 0.7, "gain_yaw": 1.2}
    width = {"bandwidth_surge": 2.0, "bandwidth_roll": 3, "bandwidth_pitch": 4, "bandwidth_yaw": 5}
    world = model(OnboardControl(**gain, **width, attitude=attitude))
    found = push(world, tilted, demand=demand) - push(model(), tilted)
    u, p, q, r = tilted[[7, 10, 11, 12]]
    roll, pitch = 0.6 * 0.2, 0.7 * -0.4
    if attitude:  # the fixture's angles are 0.4 and -0.3 rad
        roll, pitch = 3 * (roll - 0.4), 4 * (pitch + 0.3)
    M = np.diag(model().body.M)
    rates = [2 * (0.4 - u), 0, 0, 3 * (roll - p), 4 * (pitch - q), 5 * (0.36 - r)]
    np.testing.assert_allclose(found, M * rates, atol=1e-9)


def test_a_loop_replaces_its_axis_of_the_mixer_only():
    path = model(OnboardControl(bandwidth_yaw=2.0)).thrust_path
    demand = np.array([[0.2, 0, 0, 0, 0, 0.3]])
    alone = np.array([[0.2, 0, 0, 0, 0, 0.0]])
    np.testing.assert_array_equal(
        path.thruster_commands(demand, "demand"),
        model().thrust_path.thruster_commands(alone, "demand"),
    )


def test_a_loop_without_logged_demands_is_refused():
    run = motion(np.zeros((1, 8)), seconds=0.1)
    replay(model(OnboardControl(gain_yaw=1.0)), run)  # no bandwidth, no loop
    with pytest.raises(BadInput, match="acts on demands, and this log holds none"):
        replay(model(OnboardControl(gain_yaw=1.0, bandwidth_yaw=1.0)), run)


def test_a_tether_without_anchor_in_an_unknown_tank_is_refused():
    run = motion(np.zeros((1, 8)), seconds=0.1)
    replay(model(TetherDrag(coefficient=1.0, anchor_x=0, anchor_y=0, anchor_z=0)), run)
    with pytest.raises(BadInput, match="no anchor, and the tank is not known"):
        replay(model(TetherDrag(coefficient=1.0)), run)


def replay(world, run):
    return simulate(world, run, [(0, 10, at_rest())], ReplaySettings())
