"""The nominal BlueROV2 against Fossen's textbook, written here once more from its vehicle file.

Nothing below calls the package for physics: matrices, restoring and allocation are typed from
Fossen, Handbook of Marine Craft Hydrodynamics and Motion Control, 2nd ed. 2021.
"""

from math import cos, sin

import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.integrate import solve_ivp

from rovsim.core.rotations import from_euler, matrix
from rovsim.core.run import Site
from rovsim.core.shipped import shipped
from rovsim.dynamics.actuation import Thrust
from rovsim.dynamics.engine.types import NO_MEMORY
from rovsim.simulation.batch import Batch
from rovsim.simulation.drive import Drive
from rovsim.simulation.replay import simulate
from rovsim.simulation.settings import ReplaySettings
from worlds import at_rest, model, motion

FILE = yaml.safe_load((shipped("conf/vehicle") / "bluerov2_heavy.yaml").read_text(encoding="utf-8"))
DRY, WATER, SET = FILE["rigid_body"], FILE["hydrodynamics"], FILE["thrusters"]
G, MASS = FILE["fluid"]["gravity"], DRY["mass"]
W = MASS * G
B = FILE["fluid"]["density"] * G * DRY["displaced_volume"]
RG, RB = np.array(DRY["center_of_gravity"]), np.array(DRY["center_of_buoyancy"])


def S(x):
    """Skew-symmetric matrix, eq. 2.10."""
    return np.array([[0, -x[2], x[1]], [x[2], 0, -x[0]], [-x[1], x[0], 0]])


def M_RB():
    """Eq. 3.49, with the inertia moved to CO by the parallel-axis theorem, eq. 3.42."""
    Ig = np.diag([DRY["inertia"][name] for name in ("Ixx", "Iyy", "Izz")])
    Ib = Ig - MASS * S(RG) @ S(RG)
    return np.block([[MASS * np.eye(3), -MASS * S(RG)], [MASS * S(RG), Ib]])


M_A = np.diag(WATER["added_mass"])


def C(M, nu):
    """Eq. 6.43 and 6.44."""
    a = M[:3, :3] @ nu[:3] + M[:3, 3:] @ nu[3:]
    b = M[3:, :3] @ nu[:3] + M[3:, 3:] @ nu[3:]
    return np.block([[np.zeros((3, 3)), -S(a)], [-S(a), -S(b)]])


def g(roll, pitch):
    """Restoring vector, eq. 4.6, in Euler angles."""
    (sf, cf), (st_, ct) = (sin(roll), cos(roll)), (sin(pitch), cos(pitch))
    x, y, z = W * RG - B * RB
    return np.array(
        [
            (W - B) * st_,
            -(W - B) * ct * sf,
            -(W - B) * ct * cf,
            -y * ct * cf + z * ct * sf,
            z * st_ + x * ct * cf,
            -x * ct * sf - y * st_,
        ]
    )


def wrench(command):
    """Eq. 9.77: each thruster's force along its direction, and its moment."""
    tau = np.zeros(6)
    for c, unit in zip(command, SET["units"], strict=True):
        # published curve, typed from the vehicle file's comment
        F = 8.9 * c + 176 * c**3 - 404.1 * c**5 + 389.9 * c**7 - 140.3 * c**9
        along, place = np.array(unit["direction"]), np.array(unit["position"])
        tau += F * np.concatenate([along, np.cross(place, along)])
    return tau


def nu_dot(nu, restoring, tau):
    """Eq. 6.1 solved for the acceleration; restoring is g(eta)."""
    D = np.diag(WATER["linear_damping"]) + np.diag(WATER["quadratic_damping"] * np.abs(nu))
    M = M_RB() + M_A
    return np.linalg.solve(M, tau - C(M, nu) @ nu - D @ nu - restoring)


def slope(x, tau):
    """Position, rotation matrix (eq. 2.32) and velocity; no angles, so no singularity."""
    R, nu = x[3:12].reshape(3, 3), x[12:]
    d = R[2]
    restoring = -np.concatenate([(W - B) * d, np.cross(W * RG - B * RB, d)])
    return np.concatenate([R @ nu[:3], (R @ S(nu[3:])).ravel(), nu_dot(nu, restoring, tau)])


def engine_acceleration(state, command, world=None):
    """nu_dot (6,) of the compiled engine at one state under one thruster command."""
    world = world or model()
    force = world.thrust_path.thrusters.static_force(np.asarray(command, float))[None]
    drive = Drive.by(world, Thrust(force, np.zeros((1, 6)), np.full((1, 6), np.nan)), 1.0)
    batch = Batch([world], Site.unknown())
    return batch.accelerations(drive, np.zeros(1), state[None], NO_MEMORY)[0]


angles, speeds = st.floats(-1.4, 1.4), arrays(float, 6, elements=st.floats(-1.5, 1.5))
commands = arrays(float, 8, elements=st.floats(-1, 1))


@settings(deadline=None)
@given(roll=angles, pitch=angles, yaw=st.floats(-3.1, 3.1), nu=speeds, command=commands)
def test_the_acceleration_is_fossens_at_any_state(roll, pitch, yaw, nu, command):
    state = np.concatenate([np.zeros(3), from_euler(roll, pitch, yaw), nu])
    expected = nu_dot(nu, g(roll, pitch), wrench(command))
    np.testing.assert_allclose(engine_acceleration(state, command), expected, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("seed", range(3))
def test_held_random_commands_are_followed_within_a_micrometre(seed):
    """The step's error bound that ReplaySettings.step names, against DOP853 at 1e-10."""
    rng = np.random.default_rng(seed)
    value = rng.uniform(-0.6, 0.6, (20, 8))
    start = at_rest()
    start[3:7], start[7:] = from_euler(*rng.uniform(-0.5, 0.5, 3)), rng.uniform(-0.4, 0.4, 6)
    run = motion(value, seconds=2.0, start=start)
    x = np.concatenate([start[:3], matrix(start[3:7]).ravel(), start[7:]])
    for command in value:  # one line every 0.1 s
        tau = wrench(command)
        arc = solve_ivp(
            lambda t, x, tau=tau: slope(x, tau), (0, 0.1), x, "DOP853", rtol=1e-10, atol=1e-12
        )
        x = arc.y[:, -1]
    for step, bound in ((0.01, 1e-6), (0.001, 1e-9)):
        end = simulate(model(), run, [(0, 200, start)], ReplaySettings(step=step))[0][-1]
        np.testing.assert_allclose(end[:3], x[:3], atol=bound)
        np.testing.assert_allclose(matrix(end[3:7]), x[3:12].reshape(3, 3), atol=10 * bound)
        np.testing.assert_allclose(end[7:], x[12:], atol=20 * bound)


@pytest.mark.parametrize("thruster", range(8))
def test_each_thruster_turns_the_way_the_yaw_mixer_expects(thruster):
    """The published table's fourth angle (3 pi/4 for 3 pi/2) turns thruster 4 round."""
    tau = wrench(np.eye(8)[thruster] * 0.5)
    assert np.sign(np.round(tau[5], 6)) == np.sign(SET["mixer"]["yaw"][thruster])
    np.testing.assert_allclose(
        model().body.B[:, thruster], tau / np.linalg.norm(tau[:3]), atol=1e-4
    )


@pytest.mark.parametrize("axis", range(6))
def test_water_adds_inertia_and_takes_speed(axis):
    """An earlier port had M = m - 6.36 and anti-damping (design, section 9)."""
    dry = M_RB()[axis, axis]
    assert model().body.M[axis, axis] == dry + WATER["added_mass"][axis] > dry
    nu = np.zeros(6)
    nu[axis] = 0.7
    state = np.concatenate([[0, 0, 0, 1, 0, 0, 0], nu])
    coasting, still = (
        engine_acceleration(np.concatenate([state[:7], v]), np.zeros(8)) for v in (nu, 0 * nu)
    )
    assert (coasting - still)[axis] < 0


def test_published_coriolis_signs_at_roll_and_pitch():
    """C_RB(4,5) and (5,4), eq. 3.63: +Iz r and -Iz r; here seen as moments of a spinning body."""
    nu = np.array([0, 0, 0, 0, 0.8, 0.5])
    state = np.concatenate([[0, 0, 0, 1, 0, 0, 0], nu])
    Iyy, Izz = (DRY["inertia"]["Iyy"] + M_A[4, 4]), (DRY["inertia"]["Izz"] + M_A[5, 5])
    Ixx = DRY["inertia"]["Ixx"] + M_A[3, 3]
    roll = (Iyy - Izz) * 0.8 * 0.5 / Ixx  # Euler: Ixx p_dot = (Iyy - Izz) q r
    assert engine_acceleration(state, np.zeros(8))[3] == pytest.approx(roll, abs=1e-12)


def test_the_packed_numbers_are_those_of_the_file():
    body = model().body
    np.testing.assert_array_equal(body.linear, WATER["linear_damping"])
    np.testing.assert_array_equal(body.quadratic, WATER["quadratic_damping"])
    np.testing.assert_array_equal(body.M_A, M_A)
    np.testing.assert_allclose(body.M_RB, M_RB(), atol=1e-15)
    assert (body.weight, body.buoyancy) == pytest.approx((W, B), rel=1e-14)
