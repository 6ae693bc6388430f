"""Terms that not every vehicle has, against the same equations written here with NumPy."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rovsim.core.errors import BadInput
from rovsim.core.rotations import from_euler
from rovsim.core.run import Commands, Logged, Site
from rovsim.core.yaml_files import read_yaml
from rovsim.dynamics.actuation import Thrust
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.engine.types import NO_MEMORY
from rovsim.dynamics.model import nominal
from rovsim.dynamics.model_file import build_model, write_model
from rovsim.dynamics.vehicle import build_vehicle
from rovsim.dynamics.vehicle.cross_flow import parse_product
from rovsim.simulation.batch import Batch
from rovsim.simulation.drive import Drive
from rovsim.simulation.replay import simulate
from rovsim.simulation.settings import ReplaySettings
from worlds import at_rest, motion

SYMMETRIC = np.diag([4.0, 30.0, 30.0, 0.5, 5.0, 5.0])
SYMMETRIC[1, 5] = SYMMETRIC[5, 1] = 1.5
LINEAR = np.diag([2.0, 5.0, 6.0, 0.3, 1.0, 1.2]) + 0.1 * np.arange(36).reshape(6, 6) % 0.7
QUADRATIC = np.diag([3.0, 40.0, 41.0, 0.1, 7.0, 8.0]) + 0.2 * np.arange(36).reshape(6, 6) % 0.9
PLAIN = {
    "name": "test",
    "fluid": {"density": 1025.0, "gravity": 9.81},
    "rigid_body": {
        "mass": 30.0,
        "inertia": {"Ixx": 0.4, "Iyy": 3.5, "Izz": 3.6, "Ixy": 0.02, "Ixz": -0.05, "Iyz": 0.03},
        "center_of_gravity": [0.02, 0.01, 0.03],
        "displaced_volume": 0.0293,
        "center_of_buoyancy": [0.02, 0.01, 0.0],
    },
    "hydrodynamics": {
        "added_mass": SYMMETRIC.tolist(),
        "linear_damping": LINEAR.tolist(),
        "quadratic_damping": QUADRATIC.tolist(),
    },
}
LEVEL = -0.3
finite = st.floats(-1.0, 1.0)
velocities = st.lists(finite, min_size=6, max_size=6).map(np.array)


def vehicle(**more):
    return build_vehicle(PLAIN | more, "here")


def wrench(described, nu, eta=(0.0, 0.0, 0.0), depth=0.0, angle=(), force=()):
    """M nu_dot (6,) of a vehicle: what pushes it."""
    world, state = nominal(described), at_rest()
    state[2], state[3:7], state[7:] = LEVEL + depth, from_euler(*eta), nu
    thrust = Thrust(
        np.array([force], float),
        np.zeros((1, 6)),
        np.full((1, 6), np.nan),
        angle=np.array([angle], float),
    )
    drive = Drive.by(world, thrust, 1.0)
    batch = Batch([world], Site(np.full((3, 2), np.nan), np.ones(3), LEVEL))
    return world.body.M @ batch.accelerations(drive, np.zeros(1), state[None], NO_MEMORY)[0]


def change(more, nu, **at):
    """What a part of the vehicle file adds."""
    plain = {k: v for k, v in at.items() if k in ("eta", "depth")}
    return wrench(vehicle(**more), nu, **at) - wrench(vehicle(), nu, **plain)


@given(velocities)
def test_whole_matrices_of_mass_and_damping(nu):
    body, drag = (
        nominal(vehicle()).body,
        PLAIN
        | {
            "hydrodynamics": {
                **PLAIN["hydrodynamics"],
                "linear_damping": [0.0] * 6,
                "quadratic_damping": [0.0] * 6,
            }
        },
    )
    np.testing.assert_allclose(body.M_A, SYMMETRIC)
    found = wrench(vehicle(), nu) - wrench(build_vehicle(drag, "here"), nu)
    expected = -LINEAR @ nu - QUADRATIC @ (np.abs(nu) * nu)
    np.testing.assert_allclose(found, expected, atol=1e-9)


def test_products_of_inertia_stand_with_a_minus():
    m, r = 30.0, np.array([0.02, 0.01, 0.03])
    about_cg = np.array([[0.4, -0.02, 0.05], [-0.02, 3.5, -0.03], [0.05, -0.03, 3.6]])
    expected = about_cg + m * (r @ r * np.eye(3) - np.outer(r, r))
    np.testing.assert_allclose(nominal(vehicle()).body.M_RB[3:, 3:], expected, atol=1e-12)


@given(velocities)
def test_products_of_velocities_push_as_their_names_say(nu):
    u, v, w, _, q, r = nu
    names = {"Yuv": -28.6, "Yv|v|": -1310.0, "Nrr": -94.0, "Zuw": -28.0, "Muq": -2.0,
             "X|q||q|": -1.9, "Xuuu": -5.9, "K|r|v": 0.7, "Nvvr": 0.3}  # fmt: skip
    expected = [
        -1.9 * q**2 - 5.9 * u**3,
        -28.6 * u * v - 1310.0 * v * abs(v),
        -28.0 * u * w,
        0.7 * abs(r) * v,
        -2.0 * u * q,
        -94.0 * abs(r) * r + 0.3 * v * v * r,
    ]
    found = change({"cross_flow": names}, nu)
    np.testing.assert_allclose(found, expected, atol=1e-8)
    inside = {"hydrodynamics": PLAIN["hydrodynamics"] | {"cross_flow": names}}
    np.testing.assert_allclose(change(inside, nu), found, atol=1e-9)


@pytest.mark.parametrize("name", ["Yu", "Quv", "Yuz", "Yuvwp", "Y|uv", "yuv", "Y"])
def test_what_is_no_name_of_a_product_is_refused(name):
    with pytest.raises(ValueError, match="such as Yuv"):
        parse_product(name)
    with pytest.raises(BadInput, match="such as Yuv"):
        vehicle(cross_flow={name: 1.0})


@given(finite, st.floats(-0.5, 0.5), st.floats(-0.5, 0.5), st.floats(-3.0, 3.0))
def test_a_waterplane_rights_what_floats(depth, roll, pitch, yaw):
    more = {"waterplane": {"heave": 900.0, "roll": 20.0, "pitch": 60.0}}
    found = change(more, np.zeros(6), eta=(roll, pitch, yaw), depth=depth)
    np.testing.assert_allclose(
        found, [0, 0, -900.0 * depth, -20.0 * roll, -60.0 * pitch, 0], atol=1e-9
    )


def surface(nu, angle, place, normal, thrust, disc):
    """Lift and drag across and along the local flow, a flat plate beyond the stall."""
    area, slope, drag, stall, density = 0.02, 3.0, 0.02, 0.3, 1025.0
    chord = np.array([1.0, 0.0, 0.0])
    v = nu[:3] + np.cross(nu[3:], place)
    ahead, across = v @ chord, v @ normal
    if thrust > 0.0:  # far behind an actuator disc
        ahead = (
            np.copysign(1.0, s := ahead * abs(ahead) + 2.0 * thrust / (density * disc))
            * abs(s) ** 0.5
        )
    flow = np.array([ahead, across])
    alpha = angle - np.arctan2(across, ahead)
    alpha = (alpha + np.pi) % (2.0 * np.pi) - np.pi
    plate = slope * stall / np.sin(2.0 * stall)
    lift = slope * alpha if abs(alpha) <= stall else plate * np.sin(2.0 * alpha)
    drag = drag + 2.0 * plate * np.sin(alpha) ** 2
    half = 0.5 * density * area * np.hypot(*flow)
    in_plane = half * (lift * np.array([-across, ahead]) - drag * flow)
    force = in_plane[0] * chord + in_plane[1] * normal
    return np.concatenate([force, np.cross(place, force)])


STERN = {"name": "stern", "position": [-0.6, 0.0, 0.1], "normal": [0.0, 0.0, -1.0], "area": 0.02,
         "lift_slope": 3.0, "drag": 0.02, "stall": 0.3}  # fmt: skip
RUDDER = STERN | {"name": "rudder", "normal": [0.0, 1.0, 0.0], "in_wake_of": "t1"}
SCREW = {
    "force_curve": {"quadratic": {"forward": 9.0, "reverse": 5.0}},
    "units": [{"name": "t1", "position": [-0.5, 0, 0], "direction": [1, 0, 0], "diameter": 0.14}],
}


@given(velocities, st.floats(-1.5, 1.5), st.floats(-1.5, 1.5), st.floats(-5.0, 9.0))
def test_surfaces_lift_and_drag_in_the_flow_and_in_the_wake(nu, first, second, thrust):
    more = {"surfaces": [STERN, RUDDER], "thrusters": SCREW}
    found = change(more, nu, angle=(first, second), force=(thrust,))
    place, disc = np.array([-0.6, 0.0, 0.1]), np.pi / 4 * 0.14**2
    expected = surface(nu, first, place, np.array([0.0, 0.0, -1.0]), 0.0, disc)
    expected += surface(nu, second, place, np.array([0.0, 1.0, 0.0]), thrust, disc)
    expected[0] += thrust
    np.testing.assert_allclose(found, expected, atol=1e-7)


def test_a_rudder_at_a_positive_angle_turns_the_bow_to_port():
    """It lifts along its normal, to starboard, behind CO."""
    found = change(
        {"surfaces": [STERN, STERN | RUDDER]} | {"thrusters": SCREW},
        np.array([1.0, 0, 0, 0, 0, 0]),
        angle=(0.0, 0.1),
        force=(0.0,),
    )
    assert found[1] > 0 > found[5]


PLANAR = {
    "degrees_of_freedom": ["surge", "sway", "yaw"],
    "rigid_body": {"mass": 30.0, "inertia": {"Izz": 3.6}, "center_of_gravity": [0.05, 0, 0]},
}


def test_held_axes_stay_and_the_others_do_not_feel_them():
    planar = vehicle(**PLANAR, thrusters=SCREW)
    start = at_rest()
    start[7:] = [0.5, 0.2, 0.3, 0.4, -0.3, 0.2]
    run = motion(np.full((5, 1), 0.5), start=start)
    path = simulate(nominal(planar), run, [(0, 200, start)], ReplaySettings())[0]
    assert not path[:, [9, 10, 11]].any()
    assert np.ptp(path[:, 2]) == 0.0
    nu, free = np.array([0.5, 0.2, 0, 0, 0, 0.2]), [0, 1, 5]
    world = nominal(planar)
    batch = Batch([world], Site.unknown())
    still = Drive.by(world, Thrust(np.zeros((1, 1)), np.zeros((1, 6)), np.zeros((1, 6))), 1.0)
    state = np.concatenate([at_rest()[:7], start[7:]])
    found = batch.accelerations(still, np.zeros(1), state[None], NO_MEMORY)[0][free]
    whole = world.body.M[np.ix_(free, free)] @ found
    m, x = world.body.M, nu
    h = m @ x  # momentum: Coriolis forces of the plane, Fossen 2021, eq. 3.64 and 6.57
    coriolis = np.array([-nu[5] * h[1], nu[5] * h[0], nu[0] * h[1] - nu[1] * h[0]])
    drag = (LINEAR @ nu + QUADRATIC @ (np.abs(nu) * nu))[free]
    np.testing.assert_allclose(whole, -coriolis - drag, atol=1e-9)


@given(st.lists(finite, min_size=3, max_size=3), st.floats(8.0, 20.0))
def test_force_curves(commands, volts):
    table = {"command": [-1.0, 0.0, 1.0], "force": [-4.0, 0.0, 5.0]}
    strong = {"command": [-1.0, 0.0, 1.0], "force": [-6.0, 0.0, 8.0]}
    curves = [
        {"odd_polynomial": [2.0, 3.0]},
        {"quadratic": {"forward": 10.0, "reverse": 6.0, "deadband": 0.1}},
        {"tables": {"volts": {12: table, 16: strong}}},
    ]
    units = [
        SCREW["units"][0] | {"name": f"t{k}", "force_curve": curve}
        for k, curve in enumerate(curves)
    ]
    a, b, c = commands
    share = np.clip((volts - 12.0) / 4.0, 0.0, 1.0)
    effort = max(0.0, abs(b) - 0.1) / 0.9
    between = np.interp(c, [-1, 0, 1], [-4 - 2 * share, 0, 5 + 3 * share])
    expected = [2 * a + 3 * a**3, (6.0 if b < 0 else 10.0) * np.sign(b) * effort**2, between]
    thrusters = nominal(vehicle(thrusters={"units": units})).thrust_path.thrusters
    found = thrusters.static_force(np.array([commands]), np.array([volts]))
    np.testing.assert_allclose(found[0], expected, atol=1e-12)
    full = thrusters.static_force(np.array([commands]))  # no voltage: the highest, a full battery
    assert full[0, 2] == pytest.approx(np.interp(c, [-1, 0, 1], [-6, 0, 8]))


def test_a_logged_voltage_reaches_the_thrusters():
    table = {"command": [-1, 1], "force": [-10, 10]}
    weak = {"command": [-1, 1], "force": [-5, 5]}
    units = [SCREW["units"][0] | {"force_curve": {"tables": {"volts": {10: weak, 16: table}}}}]
    path = nominal(vehicle(thrusters={"units": units})).thrust_path
    sag = {"voltage": Logged(np.array([0.0, 2.0]), np.array([16.0, 10.0]))}
    log = Commands(np.zeros(1), np.ones((1, 1)), "thruster", sag)
    force = path.over_steps(log, np.linspace(0.0, 2.0, 101)).force[:, 0]
    np.testing.assert_allclose(force, 10.0 - 2.5 * (np.arange(100) + 0.5) / 50.0, atol=1e-9)


def test_a_thruster_that_turns_pushes_along_its_angle():
    units = [
        SCREW["units"][0],
        {"name": "pod", "position": [-0.6, 0.2, 0.1], "direction": [1, 0, 0], "azimuth": True},
    ]
    turning = vehicle(thrusters=SCREW | {"units": units})
    assert turning.command_columns == ("t1", "pod", "pod_angle")
    world, angle = nominal(turning), 0.7
    value = np.array([[0.2, 0.5, angle]])
    thrust = world.thrust_path.over_steps(
        Commands(np.zeros(1), value, "thruster"), np.array([0.0, 0.1])
    )
    along = 9.0 * 0.25 * np.array([np.cos(angle), np.sin(angle), 0.0])
    pod = np.concatenate([along, np.cross([-0.6, 0.2, 0.1], along)])
    found = Drive.by(world, thrust, 0.1).wrench[0]
    np.testing.assert_allclose(found, pod + np.eye(6)[0] * 9.0 * 0.04, atol=1e-12)


BAD = {
    "matrix": ({"hydrodynamics": PLAIN["hydrodynamics"] | {"added_mass": [1.0] * 5}}, "six rows"),
    "asymmetric": (
        {"hydrodynamics": PLAIN["hydrodynamics"] | {"added_mass": LINEAR.tolist()}},
        "symmetric",
    ),
    "drive": ({"hydrodynamics": PLAIN["hydrodynamics"] | {"linear_damping": [-1.0] * 6}}, "least"),
    "two curves": (
        {
            "thrusters": SCREW
            | {
                "force_curve": {
                    "odd_polynomial": [1.0],
                    "table": {"command": [0, 1], "force": [0, 1]},
                }
            }
        },
        "one of",
    ),
    "no curve": ({"thrusters": {"units": SCREW["units"]}}, "no force_curve"),
    "wake": ({"surfaces": [RUDDER]}, "in the wake of 't1'"),
    "normal": ({"surfaces": [STERN | {"normal": [1.0, 0, 0]}]}, "across the x axis"),
    "twins": ({"surfaces": [STERN, STERN]}, "called stern"),
    "axis": ({"degrees_of_freedom": ["surge", "yew"]}, "surge"),
    "moment": ({"rigid_body": PLANAR["rigid_body"]}, "Ixx"),
    "buoyancy": (
        {"rigid_body": {k: v for k, v in PLAIN["rigid_body"].items() if "buoy" not in k}},
        "what floats has a 'waterplane'",
    ),
    "centre": (
        {"rigid_body": {k: v for k, v in PLAIN["rigid_body"].items() if "gravity" not in k}},
        r"'rigid_body\.center_of_gravity' is missing.*docs/vehicles\.md",
    ),
    "both": (
        {
            "cross_flow": {"Yuv": 1.0},
            "hydrodynamics": PLAIN["hydrodynamics"] | {"cross_flow": {"Yuv": 1.0}},
        },
        "stands in",
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_what_does_not_fit_together_is_explained(name):
    more, says = BAD[name]
    with pytest.raises(BadInput, match=says):
        vehicle(**more)


def test_a_log_of_demands_needs_a_mixer():
    path = nominal(vehicle(thrusters=SCREW)).thrust_path
    with pytest.raises(BadInput, match="no mixer"):
        path.thruster_commands(np.zeros((1, 6)), "demand")


def test_a_wrench_drives_a_vehicle_without_thrusters():
    world = nominal(vehicle(surfaces=[STERN]))
    log = Commands(np.zeros(1), np.array([[3.0, 0, 0, 0, 0, 1.0]]), "wrench")
    drive = Drive.by(world, world.thrust_path.over_steps(log, np.array([0.0, 0.1])), 0.1)
    np.testing.assert_allclose(drive.wrench[0], [3, 0, 0, 0, 0, 1])
    assert drive.engine_columns(None).shape == (1, 1)


def test_a_model_file_keeps_such_a_vehicle(tmp_path):
    table = {"tables": {"volts": {12: {"command": [-1, 1], "force": [-5, 5]}}}}
    screw = SCREW | {"units": [SCREW["units"][0] | {"force_curve": table}]}
    world = nominal(
        vehicle(
            surfaces=[STERN, RUDDER],
            thrusters=screw,
            waterplane={"heave": 3.0},
            cross_flow={"Yuv": -1.0},
            degrees_of_freedom=["surge", "sway", "heave", "roll", "pitch"],
        )
    )
    write_model(world, tmp_path / "m.yaml")
    again = build_model(read_yaml(tmp_path / "m.yaml"), tmp_path / "m.yaml", built_in())
    assert again.vehicle == world.vehicle
