"""Every vehicle of conf/vehicle against what was published of it, written here once more."""

from pathlib import Path

import numpy as np
import pytest
import yaml
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.signal import find_peaks

from pages import fenced
from rovsim.core.rotations import from_euler
from rovsim.core.run import Commands, Site
from rovsim.core.shipped import conf_names
from rovsim.dynamics.engine.types import NO_MEMORY
from rovsim.dynamics.model import nominal
from rovsim.dynamics.vehicle import build_vehicle, load_vehicle
from rovsim.simulation.batch import Batch
from rovsim.simulation.drive import Drive
from rovsim.simulation.replay import simulate
from rovsim.simulation.settings import ReplaySettings
from worlds import at_rest, motion

KNOT = 1852.0 / 3600.0
KGF = 9.80665


def acceleration(world, command, nu, eta=(0.0, 0.0, 0.0)):
    """Acceleration (6,) at a velocity under a logged command."""
    state = np.concatenate([np.zeros(3), from_euler(*eta), nu])
    log = Commands(np.zeros(1), np.atleast_2d(np.asarray(command, float)), "thruster")
    drive = Drive.by(world, world.thrust_path.over_steps(log, np.array([0.0, 1.0])), 1.0)
    batch = Batch([world], Site.unknown())
    return batch.accelerations(drive, np.zeros(1), state[None], NO_MEMORY)[0]


def flown(world, command, seconds, start=None):
    """States (n, 13) every 10 ms under a command that holds."""
    start = at_rest() if start is None else start
    run = motion(np.atleast_2d(np.asarray(command, float)), seconds=seconds, start=start)
    return simulate(world, run, [(0, round(100 * seconds), start)], ReplaySettings())[0]


def steady_speed(world, command):
    """Speed straight ahead, m/s, at which a command neither speeds up nor slows down."""
    return brentq(lambda u: acceleration(world, command, u * np.eye(6)[0])[0], 0.1, 5.0)


@pytest.mark.parametrize("name", conf_names("vehicle"))
def test_it_holds_together_and_loses_energy(name):
    """M is positive definite; adrift, velocities decay."""
    world = nominal(load_vehicle(name))
    assert world.body.least_inertia > 0
    rng = np.random.default_rng(0)
    columns = world.thrust_path.columns("thruster")
    for nu in rng.uniform(-0.5, 0.5, (20, 6)) * world.body.free:
        still = acceleration(world, np.zeros(columns), 0 * nu)
        lost = nu @ world.body.M @ (acceleration(world, np.zeros(columns), nu) - still)
        assert lost < 0


# Prestero 2001, appendix: combined coefficients, and its equations (p. 46)
W, B, ZG = 299.0, 306.0, 0.0196
MASS, IXX, IYY, IZZ = 30.48, 0.177, 3.45, 3.45


def prestero(nu, rudder, stern, thrust):
    """Acceleration (6,) of a level REMUS."""
    u, v, w, p, q, r = nu
    m, zg = MASS, ZG
    X = (
        -1.62 * u * abs(u)
        + (-35.5 - m) * w * q
        - 1.93 * q**2
        + (35.5 + m) * v * r
        - 1.93 * r**2
        - m * zg * p * r
        + thrust
    )
    Y = (
        -1310 * v * abs(v)
        + 0.632 * r * abs(r)
        - 28.6 * u * v
        + (35.5 + m) * w * p
        + (5.22 - m) * u * r
        - m * zg * q * r
        + 1.93 * p * q
        + 9.64 * u**2 * rudder
    )
    Z = (
        W
        - B
        - 1310 * w * abs(w)
        - 0.632 * q * abs(q)
        - 28.6 * u * w
        + (-5.22 + m) * u * q
        + (-35.5 - m) * v * p
        + m * zg * (p**2 + q**2)
        + 1.93 * r * p
        - 9.64 * u**2 * stern
    )
    K = -0.13 * p * abs(p) - (IZZ - IYY) * q * r - m * zg * w * p + m * zg * u * r
    M = (
        3.18 * w * abs(w)
        - 188 * q * abs(q)
        + (4.86 - (IXX - IZZ)) * r * p
        + m * zg * v * r
        - m * zg * w * q
        - 2.0 * u * q
        + 24.0 * u * w
        - 1.93 * v * p
        - 6.15 * u**2 * stern
    )
    N = (
        -3.18 * v * abs(v)
        - 94 * r * abs(r)
        - 24.0 * u * v
        + (-4.86 - (IYY - IXX)) * p * q
        - 1.93 * w * p
        - 2.0 * u * r
        - 6.15 * u**2 * rudder
    )
    A = np.diag([m + 0.93, m + 35.5, m + 35.5, IXX + 0.0704, IYY + 4.88, IZZ + 4.88])
    A[0, 4] = A[4, 0] = m * zg
    A[1, 3] = A[3, 1] = -m * zg
    A[1, 5] = A[5, 1] = -1.93
    A[2, 4] = A[4, 2] = 1.93
    return np.linalg.solve(A, [X, Y, Z, K, M, N])


@pytest.fixture(scope="module")
def remus():
    return nominal(load_vehicle("remus100"))


@pytest.mark.parametrize("seed", range(20))
def test_remus_moves_by_presteros_equations(remus, seed):
    """At angles of attack of a few degrees; his fins are linear, and have no drag of their own."""
    rng = np.random.default_rng(seed)
    nu = np.array([1.54, *rng.uniform(-0.05, 0.05, 2), *rng.uniform(-0.1, 0.1, 3)])
    rudder, stern = rng.uniform(-0.07, 0.07, 2)
    found = acceleration(remus, [1.0, rudder, stern], nu)
    expected = prestero(nu, rudder, stern, 3.86)
    assert np.abs(found - expected).max() < 0.02 * max(1.0, np.abs(expected).max())


def test_remus_reaches_three_knots_at_1500_rpm(remus):
    """Prestero 2001: 1.54 m/s (3 knots) at 1500 rpm."""
    assert steady_speed(remus, [1.0, 0.0, 0.0]) == pytest.approx(3 * KNOT, abs=0.01)


def test_remus_turns_at_the_rate_of_presteros_equations(remus):
    """Rudder hard over by 4 degrees for 10 s in the horizontal plane."""
    angle = np.deg2rad(-4.0)
    plane = [0, 1, 5]

    def slope(t, x):
        nu = np.zeros(6)
        nu[plane] = x
        return prestero(nu, angle, 0.0, 3.86)[plane]

    arc = solve_ivp(slope, (0, 10), [1.54, 0.0, 0.0], rtol=1e-8)
    start = at_rest()
    start[7] = 1.54
    held = remus.vehicle.model_copy(update={"degrees_of_freedom": ("surge", "sway", "yaw")})
    end = flown(nominal(held), [1.0, angle, 0.0], 10.0, start)[-1]
    assert end[12] == pytest.approx(arc.y[2, -1], rel=0.02)
    assert end[7] == pytest.approx(arc.y[0, -1], rel=0.02)
    assert 0.05 < end[12] < 0.3  # a rudder to port turns to starboard


def skjetne(nu, force):
    """Acceleration (3,) of CyberShip II: Skjetne, Smogeli, Fossen 2004, eq. 1 to 14."""
    u, v, r = nu
    M = np.array([[25.8, 0, 0], [0, 33.8, 23.8 * 0.046], [0, 23.8 * 0.046, 2.76]])
    c13, c23 = -(33.8 * v + 23.8 * 0.046 * r), 25.8 * u
    C = np.array([[0, 0, c13], [0, 0, c23], [-c13, -c23, 0]])
    a, b = abs(v), abs(r)
    D = np.array(
        [
            [0.72253 + 1.32742 * abs(u) + 5.86643 * u * u, 0, 0],
            [0, 0.88965 + 36.47287 * a + 0.805 * b, 7.250 + 0.845 * a + 3.450 * b],
            [0, -0.03130 - 3.95645 * a - 0.130 * b, 1.900 - 0.080 * a + 0.750 * b],
        ]
    )
    tau = np.array([force[0] + force[1], 0.0, 0.078 * (force[0] - force[1])])
    return np.linalg.solve(M, tau - C @ nu - D @ nu)


@pytest.mark.parametrize("seed", range(10))
def test_cybership_moves_by_skjetnes_equations(seed):
    rng = np.random.default_rng(seed)
    nu, n = rng.uniform(-0.5, 0.5, 3), rng.uniform(-1.0, 1.0, 2) * 2000.0 / 60.0
    force = np.where(n > 0, 3.65034e-3, 5.10256e-3) * n * np.abs(n)
    world = nominal(load_vehicle("cybership2"))
    found = acceleration(world, n / (2000.0 / 60.0), np.array([*nu[:2], 0, 0, 0, nu[2]]))
    np.testing.assert_allclose(found[[0, 1, 5]], skjetne(nu, force), rtol=1e-5, atol=1e-6)


def test_cybership_at_full_speed_drags_as_its_cubic_says():
    """2 * 4.056 N = 0.72253 u + 1.32742 u^2 + 5.86643 u^3: 1.01 m/s."""
    u = brentq(lambda u: 0.72253 * u + 1.32742 * u**2 + 5.86643 * u**3 - 8.11186, 0.1, 3.0)
    assert u == pytest.approx(1.01, abs=0.01)
    assert steady_speed(nominal(load_vehicle("cybership2")), [1.0, 1.0]) == pytest.approx(u)


def test_cybership_turns_as_skjetnes_equations_do():
    """One propeller ahead for 20 s, from rest."""
    force = np.array([3.65034e-3 * (1600.0 / 60.0) ** 2, 0.0])
    arc = solve_ivp(lambda t, x: skjetne(x, force), (0, 20), np.zeros(3), rtol=1e-9, atol=1e-9)
    end = flown(nominal(load_vehicle("cybership2")), [0.8, 0.0], 20.0)[-1]
    np.testing.assert_allclose(end[[7, 8, 12]], arc.y[:, -1], rtol=1e-3)


def otter():
    """The numbers of MSS's otter.m without payload, from its main data."""
    g, rho, L, beam, m = 9.81, 1025.0, 2.0, 1.08, 55.0
    rg, pontoon, place, Cw, Cb = np.array([0.2, 0, -0.2]), 0.25, 0.395, 0.75, 0.4
    volume = m / rho
    draught = volume / (2 * Cb * pontoon * L)
    about_cg = m * np.array([0.4 * beam, 0.25 * L, 0.25 * L]) ** 2
    inertia = about_cg + m * (rg @ rg - rg**2)
    added = np.array(
        [2.7 * rho * volume ** (5 / 3) / L**2, 1.5 * m, m, *([0.2, 0.8, 1.7] * inertia)]
    )
    M = np.array([m, m, m, *inertia]) + added
    area = 2 * Cw * L * pontoon
    shape = 6 * Cw**3 / ((1 + Cw) * (1 + 2 * Cw))
    I_T = 2 / 12 * L * pontoon**3 * shape + area * place**2
    I_L = 0.8 * 2 / 12 * pontoon * L**3
    KB = (5 * draught / 2 - 0.5 * volume / (L * pontoon)) / 3
    KG = draught - rg[2]
    heave, GM_T, GM_L = rho * g * area, KB + I_T / volume - KG, KB + I_L / volume - KG
    roll, pitch = rho * g * volume * GM_T, rho * g * volume * GM_L
    w = np.sqrt(np.array([heave, roll, pitch]) / M[2:5])
    damping = [24.4 * g / (6 * 0.5144), M[1], *([0.6, 0.4, 0.8] * w * M[2:5]), M[5]]
    strip = 0.5 * rho * draught * 0.84704  # Hoerner at a beam of 0.93 times twice the draught
    quadratic = [0, strip * L, 0, 0, 0, 10 * M[5] + strip * L**4 / 32]
    return about_cg, added, damping, quadratic, [heave, roll, pitch + heave * 0.2**2]


def test_the_otters_numbers_follow_from_its_main_data():
    file = load_vehicle("otter")
    inertia, added, damping, quadratic, stiffness = otter()
    moments = file.rigid_body.inertia
    np.testing.assert_allclose([moments.Ixx, moments.Iyy, moments.Izz], inertia, rtol=1e-5)
    np.testing.assert_allclose(file.hydrodynamics.added_mass, added, rtol=1e-5)
    np.testing.assert_allclose(file.hydrodynamics.linear_damping, damping, rtol=1e-5)
    np.testing.assert_allclose(file.hydrodynamics.quadratic_damping, quadratic, rtol=1e-5)
    np.testing.assert_allclose(list(dict(file.waterplane).values()), stiffness, rtol=1e-5)


def test_the_otter_reaches_six_knots():
    """Maritime Robotics: 6 knots, MSS otter.m under 24.4 kgf."""
    world = nominal(load_vehicle("otter"))
    assert steady_speed(world, [1.0, 1.0]) == pytest.approx(6 * KNOT, rel=1e-3)


def test_the_otter_heaves_at_its_natural_frequency():
    """MSS otter.m: 8.28 rad/s, relative damping 0.3; pitch goes along and lengthens it."""
    start = at_rest()
    start[2] = 0.02
    z = flown(nominal(load_vehicle("otter")), [0.0, 0.0], 3.0, start)[:, 2]
    peaks = find_peaks(z)[0]
    assert 0.01 * np.diff(peaks)[0] == pytest.approx(
        2 * np.pi / (8.28 * np.sqrt(1 - 0.3**2)), rel=0.06
    )


def test_the_bluerov2_rises_by_its_drag():
    """Wu 2018: 2 N of buoyancy against 5.18 w + 36.99 w^2: 0.173 m/s."""
    end = flown(nominal(load_vehicle("bluerov2")), np.zeros(6), 20.0)[-1]
    w = brentq(lambda w: 5.18 * w + 36.99 * w * w - 2.0, 0.0, 1.0)
    assert -end[9] == pytest.approx(w, rel=0.02)
    assert w == pytest.approx(0.173, abs=0.001)


@pytest.mark.parametrize("name", ["bluerov2", "bluerov2_heavy_t200"])
def test_t200_thrusters_push_as_the_manufacturer_says(name):
    """Full ahead at 16 V: two pull with 5.25 kgf, two push back with 4.07 kgf, at 45 degrees."""
    world = nominal(load_vehicle(name))
    command = np.zeros(world.thrust_path.columns("thruster"))
    command[:4] = [1.0, 1.0, -1.0, -1.0]
    log = Commands(np.zeros(1), command[None], "thruster")
    drive = Drive.by(world, world.thrust_path.over_steps(log, np.array([0.0, 1.0])), 1.0)
    expected = 2 * (5.25 + 4.07) * KGF * np.sqrt(0.5)
    assert drive.wrench[0, 0] == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize(
    ("volts", "ahead", "astern"),
    [(12, 3.71, 2.92), (16, 5.25, 4.07), (14, 4.52, 3.52), (20, 6.7, 5.05)],
)
def test_t200_tables_meet_the_data_sheet_at_every_voltage(volts, ahead, astern):
    """Blue Robotics, full throttle; 14 V is between two tables."""
    curve = load_vehicle("bluerov2_heavy_t200").thrusters.force_curve
    found = curve.force(np.array([[1.0, -1.0]]), np.array([float(volts)]))[0] / KGF
    np.testing.assert_allclose(found, [ahead, -astern], rtol=0.015)


def test_the_page_about_vehicles_shows_a_file_that_works():
    page = Path(__file__).parents[2].joinpath("docs", "vehicles.md").read_text(encoding="utf-8")
    content = {}
    for block in fenced(page, "yaml"):
        content |= yaml.safe_load(block)
    found = build_vehicle(content, "docs/vehicles.md")
    assert found.command_columns == ("t1", "pod", "pod_angle", "rudder", "stern")
    assert all(f"`{name}`" in page for name in conf_names("vehicle"))
