"""Laws of integration: order, conservation, determinism, and what a compiled engine is made of."""

import importlib.util
import os
import subprocess
import sys
from dataclasses import replace

import numba
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from flown import observed
from rovsim.core.rotations import from_euler, matrix, rotate, unrotate
from rovsim.dynamics.body import Body, packed
from rovsim.dynamics.effects.buoyancy import NetBuoyancy
from rovsim.dynamics.effects.damping import QuadraticDamping
from rovsim.dynamics.engine.modules import engine
from rovsim.dynamics.engine.types import (
    Constants,
    Inputs,
    Jobs,
    SiteArrays,
    World,
    WrenchParameters,
)
from rovsim.dynamics.model import zero_acceleration
from rovsim.evaluation.error_metrics import rms, subtract
from rovsim.evaluation.score_collector import score_replay
from rovsim.measurement.signals.chain import SignalSettings
from rovsim.measurement.signals.filter import Butterworth
from rovsim.simulation.batch import run_jobs
from rovsim.simulation.prediction import Replay
from rovsim.simulation.replay import replay, simulate
from rovsim.simulation.settings import ReplaySettings, SimulationSettings
from rovsim.simulation.synthetic_tank.settings import Camera, Turbulence
from rovsim.simulation.windows import find_windows
from worlds import at_rest, model, motion, sticks

DOWN = np.array([0.0, 0.0, 1.0])
moving = arrays(float, 6, elements=st.floats(-1, 1))
few = settings(max_examples=20, deadline=None)


def some_body(seed, drag=0.0):
    """A body with full inertia matrices, heavy by a few newtons, its centres apart."""
    rng = np.random.default_rng(seed)
    body = Body(gravity=9.81)
    body.add_mass(10.0, rng.uniform(-0.05, 0.05, 3), np.diag(rng.uniform(0.3, 0.6, 3)))
    root = rng.uniform(-0.4, 0.4, (6, 6)) + np.diag([3, 3, 4, 0.5, 0.5, 0.5])
    body.M_A += root @ root.T
    body.linear = body.linear + drag
    body.buoyancy = body.weight - 3.0
    body.center_of_buoyancy = rng.uniform(-0.05, 0.05, 3)
    return body


def arrange(bodies, states, steps):
    """Arguments of `integrate` for one trajectory of every state with every body."""
    count, jobs = len(bodies), len(bodies) * len(states)
    member, whole = np.repeat(np.arange(count), len(states)), np.zeros(jobs, np.int64)
    inputs = Inputs(
        np.zeros((1, steps, 6)),
        np.zeros((1, steps, 0)),
        np.full((steps, 6), np.nan),
        np.zeros(count, np.int64),
        np.ones(steps),
    )
    return Jobs(
        np.tile(states, (count, 1)),
        whole,
        whole + steps,
        member,
        np.arange(jobs) * steps,
    ), inputs


def drift(bodies, states, h, steps, how=lambda kernel, *given: kernel(*given)):
    """States (j, steps, 13) of bodies left alone."""
    jobs, inputs = arrange(bodies, states, steps)
    out = np.empty((len(jobs.first) * steps, 13))
    world = World(
        Constants.stacked([packed(body) for body in bodies]),
        inputs,
        WrenchParameters(np.empty((len(bodies), 0))),
        None,
        SiteArrays(np.full((3, 2), np.nan), np.ones(3)),
    )
    how(engine([]).integrate, jobs, h * np.arange(steps + 1), 1, world, out)
    return out.reshape(-1, steps, 13)


def state(nu, roll=0.4, pitch=-0.3):
    return np.concatenate([[1.0, -2.0, 0.5], from_euler(roll, pitch, 0.7), nu])


def total_energy(body, x):
    """Kinetic energy and the potential of weight and buoyancy at their centres (NED: z down)."""
    nu, place = x[..., 7:], x[..., :3]
    centre = rotate(x[..., 3:7], body.weight_moment / body.weight)
    bubble = rotate(x[..., 3:7], np.broadcast_to(body.center_of_buoyancy, place.shape))
    high = body.buoyancy * (place + bubble)[..., 2] - body.weight * (place + centre)[..., 2]
    return 0.5 * np.einsum("...i,ij,...j->...", nu, body.M, nu) + high


@few
@given(seed=st.integers(0, 1000), nu=moving)
def test_energy_is_kept_with_weight_and_buoyancy(seed, nu):
    body = some_body(seed)
    path = drift([body], state(nu)[None], 0.005, 400)[0]
    energy = total_energy(body, path)
    np.testing.assert_allclose(energy, total_energy(body, state(nu)), rtol=0, atol=1e-6)


@few
@given(seed=st.integers(0, 1000), nu=moving)
def test_drag_takes_total_energy_at_every_step(seed, nu):
    body = some_body(seed, drag=3.0)
    energy = total_energy(body, drift([body], state(nu)[None], 0.005, 400)[0])
    assert np.all(np.diff(energy) <= 1e-10)


@few
@given(seed=st.integers(0, 1000), nu=moving)
def test_impulse_is_kept_without_forces(seed, nu):
    """Kirchhoff: R p, and R L + x times R p, of a body and its added mass stay (Lamb, art. 124)."""
    body = some_body(seed)
    body.buoyancy, body.center_of_buoyancy = body.weight, body.weight_moment / body.weight
    path = drift([body], state(nu)[None], 0.005, 400)[0]
    h = np.vstack([state(nu), path])[:, 7:] @ body.M
    q, x = np.vstack([state(nu), path])[:, 3:7], np.vstack([state(nu), path])[:, :3]
    linear = rotate(q, h[:, :3])
    angular = rotate(q, h[:, 3:]) + np.cross(x, linear)
    np.testing.assert_allclose(linear, np.tile(linear[0], (401, 1)), atol=1e-6)
    np.testing.assert_allclose(angular, np.tile(angular[0], (401, 1)), atol=1e-6)


def test_energy_drift_falls_with_the_fourth_power_of_the_step():
    body, start = some_body(3), state(np.array([0.8, -0.6, 0.5, 0.9, -0.7, 0.8]))
    errors = [
        abs(
            total_energy(body, drift([body], start[None], h, round(4 / h))[0, -1])
            - total_energy(body, start)
        )
        for h in (0.08, 0.04, 0.02)
    ]
    assert errors[0] / errors[1] > 14
    assert errors[1] / errors[2] > 14


@few
@given(nu=moving)
def test_attitude_stays_a_rotation(nu):
    path = drift([some_body(1)], state(nu)[None], 0.02, 200)[0]
    np.testing.assert_allclose(np.linalg.norm(path[:, 3:7], axis=1), 1.0, atol=1e-14)


def test_smooth_motion_converges_with_fourth_order():
    """Drag linear and steady thrust: nothing has a kink, so the order shows at 40, 20, 10 ms."""
    body, start = some_body(5, drag=4.0), state(np.array([0.5, -0.4, 0.3, 0.6, -0.5, 0.4]))
    ends = [drift([body], start[None], h, round(2 / h))[0, -1] for h in (0.04, 0.02, 0.01, 0.001)]
    errors = [np.abs(end - ends[-1]).max() for end in ends[:-1]]
    assert errors[0] / errors[1] == pytest.approx(16, rel=0.15)
    assert errors[1] / errors[2] == pytest.approx(16, rel=0.15)


def test_static_equilibrium_stays():
    """Neutral and upright, the vehicle has no reason to move."""
    body = model().body
    world = model(NetBuoyancy(force=float(body.weight - body.buoyancy)))
    run = motion(np.zeros((1, 8)))
    path = simulate(world, run, [(0, 200, at_rest())], ReplaySettings())[0]
    np.testing.assert_allclose(path, np.tile(at_rest(), (201, 1)), atol=1e-12)


def test_batches_do_not_change_the_numbers(monkeypatch):
    bodies = [some_body(seed, drag=1.0) for seed in range(4)]
    states = np.array([state(nu) for nu in np.random.default_rng(0).uniform(-1, 1, (5, 6))])
    serial = drift(bodies, states, 0.01, 100)
    monkeypatch.setattr(numba.config, "NUMBA_NUM_THREADS", 3)
    parallel = drift(bodies, states, 0.01, 100, run_jobs)
    again = drift(bodies[::-1], states[::-1], 0.01, 100, run_jobs)[::-1]
    alone = np.concatenate([drift([b], s[None], 0.01, 100) for b in bodies for s in states])
    assert serial.tobytes() == parallel.tobytes() == again.tobytes() == alone.tobytes()


CHILD = """
from worlds import model, motion, at_rest, sticks
from rovsim.dynamics.engine.modules import engine
from rovsim.simulation.replay import simulate
from rovsim.simulation.settings import ReplaySettings
simulate(model(), motion(sticks()), [(0, 5, at_rest())], ReplaySettings())
stats = engine([]).integrate.stats
print(engine([]).__name__, sum(stats.cache_hits.values()), sum(stats.cache_misses.values()))
"""


def test_another_process_uses_the_compiled_engine():
    simulate(model(), motion(sticks()), [(0, 5, at_rest())], ReplaySettings())  # fill the cache
    env = os.environ | {"PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    done = subprocess.run([sys.executable, "-c", CHILD], env=env, capture_output=True, text=True)
    assert done.stdout.split() == [engine([]).__name__, "1", "0"], done.stderr


KERNEL = """
from rovsim.dynamics.effects.base import Parameter, Wrench
class Push(Wrench):
    id, listed, equation, neglects, source = "push", False, "-", "-", "test"
    parameters = (Parameter("force", "N", "F", scale=1.0),)
    @staticmethod
    def wrench(at, p):
        return {factor} * p.force, 0.0, 0.0, 0.0, 0.0, 0.0
"""


def kernel(path, factor):
    """The effect of a file that says `factor`."""
    path.write_text(KERNEL.format(factor=factor))
    spec = importlib.util.spec_from_file_location("pushing", path)
    module = importlib.util.module_from_spec(spec)
    sys.modules["pushing"] = module
    spec.loader.exec_module(module)
    return module.Push


def test_an_edited_kernel_is_compiled_anew(tmp_path):
    names = [engine([kernel(tmp_path / f"{i}.py", f)]).__name__ for i, f in enumerate([1, 2, 1])]
    assert names[0] == names[2] != names[1]


def simulated(seconds=6.0, gap=None):
    """A run measured without error: what the nominal model itself did."""
    start = state(np.array([0.2, 0.1, -0.1, 0.1, 0.2, -0.2]), 0.1, -0.1)
    run = motion(sticks(7, 30), seconds=seconds, start=start)
    count = len(run.time)
    path = simulate(model(), run, [(0, count - 1, start)], ReplaySettings())[0]
    usable = np.ones(count, bool)
    if gap:
        usable[slice(*gap)] = False
    nu = path[:, 7:]
    return replace(run, eta=path[:, :7], nu=nu, state_nu=nu, usable=usable)


# motion of the pilot only: a cut-off far above it leaves the prediction as it was
OPEN = SimulationSettings(signals=SignalSettings(filter=Butterworth(cutoff=40.0)))
SHORT = SimulationSettings().only(0.5)


def test_the_model_that_moved_the_vehicle_predicts_it():
    run = simulated()
    found = replay(model(), run, OPEN)
    assert list(found.horizons) == ["open_loop", "0.5", "2", "5"]
    for prediction in found.horizons.values():
        known = np.isfinite(prediction.eta[:, 0])
        assert known.sum() >= 500
        np.testing.assert_allclose(prediction.eta[known], run.eta[known], atol=1e-9)
        assert np.sqrt(np.nanmean((prediction.nu - run.nu) ** 2)) < 0.01


def test_windows_of_a_perfect_model_have_no_edges(tmp_path):
    """A window filtered by itself errs by 5 to 10 % of the acceleration's spread (measured)."""
    calm = Camera(position_noise=0, attitude_noise=0, bursts_per_minute=0, outliers_per_minute=0)
    still = Turbulence(force=0.0, moment=0.0)
    truth, (run,) = observed(tmp_path, duration=12.0, camera=calm, turbulence=still)
    for prediction in replay(truth, run.motion, SHORT).horizons.values():
        errors, usable = subtract(run.motion, prediction), run.motion.usable
        assert np.all(rms(errors.nu) < 0.01 * np.std(run.motion.nu[usable], axis=0))
        assert np.all(rms(errors.nu_dot) < 0.015 * np.std(run.motion.nu_dot[usable], axis=0))


@pytest.mark.parametrize("split", [75, 80, 120])
def test_what_happened_in_another_stretch_is_no_neighbourhood(split):
    """Windows before a gap are predicted as if the run ended there."""
    whole, cut = simulated(gap=(split, split + 40)), simulated(gap=(split, split + 40))
    cut.nu[split:], cut.eta[split + 40 :, :3] = np.nan, 7.0
    whole.nu[split : split + 40] = np.nan
    one, other = (replay(model(), r, SHORT).horizons["0.5"] for r in (whole, cut))
    np.testing.assert_array_equal(one.nu_dot[:split], other.nu_dot[:split])


def test_windows_stay_inside_usable_stretches():
    run = simulated(gap=(250, 300))
    for a, b in find_windows(run, 0.5):
        assert b - a == 50
        assert run.usable[a : b + 1].all()
    assert [a for a, _ in find_windows(run, 2.0)] == [0, 300]
    found = replay(model(), run, OPEN).horizons["2"]
    known = np.flatnonzero(np.isfinite(found.eta[:, 0]))
    assert known.tolist() == [*range(1, 201), *range(301, 501)]


def test_a_horizon_below_half_a_sample_has_no_windows():
    found = replay(model(), simulated(), OPEN.only(0.004, 2.0)).horizons
    assert np.isnan(found["0.004"].nu).all()
    assert np.isfinite(found["2"].nu).any()


def test_a_run_without_a_usable_sample_predicts_nothing():
    run = simulated(seconds=1.0, gap=(0, 101))
    for prediction in replay(model(), run, OPEN).horizons.values():
        assert np.isnan(prediction.nu).all()


def test_a_replay_comes_back_from_its_file(tmp_path):
    found = replay(model(), simulated(), OPEN)
    found.write(tmp_path / "r.npz")
    again = Replay.read(tmp_path / "r.npz")
    assert (again.model, again.run, list(again.horizons)) == (
        found.model,
        found.run,
        list(found.horizons),
    )
    for horizon, prediction in found.horizons.items():
        for name in ("eta", "nu", "nu_dot"):
            one, two = getattr(prediction, name), getattr(again.horizons[horizon], name)
            assert one.tobytes() == two.tobytes()


def test_zero_acceleration_keeps_the_body_velocity():
    start = state(np.array([0.3, 0.2, -0.1, 0.0, 0.0, 0.4]), 0.0, 0.0)
    run = motion(sticks(), start=start)
    world = zero_acceleration(model().vehicle)
    path = simulate(world, run, [(0, 200, start)], ReplaySettings())[0]
    np.testing.assert_array_equal(path[:, 7:], np.tile(start[7:], (201, 1)))
    turned = matrix(path[-1, 3:7]) @ matrix(start[3:7]).T
    assert np.arctan2(turned[1, 0], turned[0, 0]) == pytest.approx(0.8)  # 0.4 rad/s for 2 s
    np.testing.assert_allclose(unrotate(path[:, 3:7], DOWN), np.tile(DOWN, (201, 1)), atol=1e-12)


@pytest.mark.parametrize("binned", [False, True])
def test_a_model_that_diverges_has_no_score_rather_than_that_of_its_first_seconds(binned):
    run = replace(simulated(), binned=binned, end=10.0)
    wild = model(QuadraticDamping(surge=-5e4, sway=-5e4, heave=-5e4))
    found = score_replay(run, replay(wild, run, OPEN)).open_loop
    assert found.velocity_rmse["surge"] is None
    assert found.velocity_mae["surge"] is None
    assert found.acceleration_rmse["surge"] is None
    assert found.position_rmse_m is None
