"""Software that smooths poses: its inverse, its delay, and replay and training behind it."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from rovsim.core.rotations import exp, log, multiply, normalized
from rovsim.diagnosis.selection.filter_delay import (
    SearchStart,
    absorb_delay,
    search_with_consistent_filter,
    with_camera_filter,
)
from rovsim.diagnosis.selection.search_result import SearchResult
from rovsim.dynamics.effects.clocks import InputDelay
from rovsim.dynamics.effects.pose_filter import PoseFilter
from rovsim.dynamics.effects.sensing import MarkerOffset, WorldTilt
from rovsim.dynamics.effects.thrusters import ThrusterLag
from rovsim.dynamics.low_pass import LowPass, in_body, in_world
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.camera import Smoothing
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.noise import FIRST_NOISE
from rovsim.estimation.observer.residual_source import Linearised
from rovsim.measurement.signals.binned import backward_difference
from rovsim.measurement.signals.chain import SignalSettings, filter_and_differentiate
from rovsim.measurement.signals.filter import Butterworth
from rovsim.simulation.measured_states import true_states, undo_mocap_view
from rovsim.simulation.replay import replay, simulate
from rovsim.simulation.samples import sample_run
from rovsim.simulation.settings import ReplaySettings, SimulationSettings
from worlds import at_rest, model, motion, sticks

OPEN = SimulationSettings(signals=SignalSettings(filter=Butterworth(cutoff=40.0)))
cutoffs = st.floats(0.5, 40.0)
series = arrays(float, (30, 3), elements=st.floats(-10, 10))


def low_pass(cutoff):
    return model(PoseFilter(cutoff=cutoff)).mocap_view.low_pass


@given(x=series, cutoff=cutoffs)
def test_it_is_the_formula_of_the_catalogue(x, cutoff):
    a, once, twice = np.exp(-2 * np.pi * cutoff * 0.01), x[0], x[0]
    for k, found in enumerate(low_pass(cutoff).smooth(x, 0.01)):
        if k:
            once = a * once + (1 - a) * x[k]
            twice = a * twice + (1 - a) * once
        np.testing.assert_allclose(found, twice, atol=1e-12)


@given(x=series, cutoff=cutoffs)
def test_sharpened_and_smoothed_again_are_inverse(x, cutoff):
    low = low_pass(cutoff)
    stages = low.stages(low.smooth(x, 0.01), 0.01)
    np.testing.assert_allclose(stages[0, 2:], x[2:], atol=1e-6)  # a stage amplifies 30-fold twice
    again = low.smooth(stages[0, 5:], 0.01, first=stages[1:, 5])
    np.testing.assert_allclose(again, stages[-1, 5:], atol=1e-9)


@pytest.mark.parametrize("straight", [False, True])
def test_slow_motions_come_two_time_constants_late(straight):
    t, T, dt = np.arange(0.0, 20.0, 0.002), 1 / (2 * np.pi * 4.0), 0.002
    x = np.sin(2 * np.pi * 0.2 * t)[:, None]
    late = 2 * T - (0 if straight else dt)
    expected = np.sin(2 * np.pi * 0.2 * (t - late))
    found = low_pass(4.0).smooth(x, dt, straight=straight)[:, 0]
    np.testing.assert_allclose(found[2000:], expected[2000:], atol=3e-3)
    assert np.abs(x[2000:, 0] - expected[2000:]).max() > 0.05


@given(x=series, cutoff=cutoffs)
def test_on_straight_lines_it_does_not_depend_on_the_step(x, cutoff):
    fine = np.stack([np.interp(np.arange(0, 29.01, 0.25), np.arange(30), c) for c in x.T], axis=1)
    low = low_pass(cutoff)
    coarse = low.smooth(fine, 0.01, straight=True)[::4]
    whole = LowPass(low.time_constants[:1]).smooth(x, 0.04, straight=True)
    first = LowPass(low.time_constants[:1]).smooth(fine, 0.01, straight=True)[::4]
    np.testing.assert_allclose(first, whole, atol=1e-9)
    assert coarse.shape == x.shape


def test_derivatives_far_apart_turn_a_parabola_back():
    t, low = np.arange(0.0, 3.0, 0.1), LowPass((0.2, 0.3))
    y = np.stack([t * t, 2 * t, 2 + 0 * t, 0 * t])[..., None]
    x = low.stages_of_derivatives(y)[0, 0, :, 0]
    np.testing.assert_allclose(x, t * t + 0.5 * 2 * t + 0.06 * 2)  # (1 + 0.2 D)(1 + 0.3 D)


@given(arrays(float, 19, elements=st.floats(-1, 1)).filter(lambda s: np.linalg.norm(s[3:7]) > 0.1))
def test_world_and_body_are_inverse(state):
    state[3:7] = normalized(state[3:7])
    eta, nu, nu_dot = state[:7], state[7:13], state[13:]
    found = in_body(in_world(eta, nu, nu_dot))
    for one, other in zip(found, (eta, nu, nu_dot), strict=True):
        np.testing.assert_allclose(one, other, atol=1e-12)
    np.testing.assert_array_equal(in_world(eta, nu), in_world(eta, nu, nu_dot)[:14])


def test_none_gives_back_the_same_array():
    for world in (model(), model(PoseFilter())):
        state = np.random.default_rng(0).normal(size=(5, 13))
        assert world.mocap_view.report(state, 0.01) is state
        assert world.mocap_view.smooth(state, 0.01) is state
        assert world.mocap_view.sharpen(state, 0.01) is state


@cache
def driven(world, seconds=6.0):
    """True states of a run, and the run as ideal cameras and this model's software report it."""
    start = at_rest()
    start[3:7] = multiply(exp(np.array([0.0, 0.0, 0.6])), start[3:7])
    run = motion(0.6 * sticks(7, 3), seconds=seconds, start=start)
    true = simulate(world, run, [(0, len(run.time) - 1, start)], ReplaySettings())[0]
    shown = world.mocap_view.report(true, 0.01)
    nu, nu_dot = filter_and_differentiate(shown[:, :7], 0.01, OPEN.signals)
    usable = (run.time > 0.2) & (run.time < seconds - 0.2)
    return true, replace(
        run, eta=shown[:, :7], nu=nu, nu_dot=nu_dot, state_nu=shown[:, 7:], usable=usable
    )


LAG = ThrusterLag(time_constant=0.1)
FILTERED = model(LAG, MarkerOffset(x=0.1), WorldTilt(roll=0.03), PoseFilter(cutoff=3.0))
CLEAR = model(LAG, MarkerOffset(x=0.1), WorldTilt(roll=0.03))
MOVING = ("eta", "nu", "nu_dot", "state_nu")


def missed(world, run):
    """Errors (RMS) of velocity and pose in windows of 2 s."""
    found = replay(world, run, OPEN).horizons["2"]
    both = run.usable & np.isfinite(found.nu[:, 0])
    assert both.sum() > 300
    return [np.sqrt(np.mean(e[both] ** 2)) for e in (found.nu - run.nu, found.eta - run.eta)]


def test_a_replay_behind_the_filter_is_as_good_as_one_without():
    _, smoothed = driven(FILTERED)
    _, plain = driven(CLEAR)
    for with_it, without in zip(missed(FILTERED, smoothed), missed(CLEAR, plain), strict=True):
        assert with_it < 2.0 * without + 2e-4
    assert missed(CLEAR, smoothed)[0] > 10 * missed(FILTERED, smoothed)[0]


def test_the_motion_behind_it_is_the_true_one():
    true, run = driven(FILTERED)
    found, clear = undo_mocap_view(FILTERED, run), undo_mocap_view(CLEAR, run)
    inside = run.usable
    turn = log(multiply(found.eta[:, 3:] * [1, -1, -1, -1], true[:, 3:7]))[inside]
    assert np.abs(turn).max() < 1e-4  # the filter changed the quaternion's length
    np.testing.assert_allclose(found.eta[inside, :3], true[inside, :3], atol=1e-5)
    error, blind = (np.abs(one.nu - true[:, 7:])[inside].max() for one in (found, clear))
    assert error < 0.02 * blind


@given(lost=st.sets(st.integers(0, 59), max_size=20))
def test_one_state_of_the_motion_behind_it_needs_no_more_than_its_neighbours(lost):
    _, run = driven(FILTERED)
    run, seen = run.part(slice(300, 360)), np.isin(np.arange(60), list(lost), invert=True)
    gappy = {name: np.where(seen[:, None], getattr(run, name), np.nan) for name in MOVING}
    run, index = replace(run, usable=seen, **gappy), np.flatnonzero(seen)
    for base in (FILTERED, model(PoseFilter(cutoff=3.0)), CLEAR, model(LAG)):
        found, whole = true_states(base, run, index), undo_mocap_view(base, run).state_at(index)
        np.testing.assert_allclose(found, whole, rtol=1e-9, atol=1e-9)


def test_a_residual_has_nothing_left_to_learn():
    _, run = driven(FILTERED)
    found, blind = (sample_run(world, run, OPEN) for world in (FILTERED, CLEAR))
    inner = (found.index > 100) & (found.index < 500)
    size = [np.sqrt(np.mean(one.a_res[inner] ** 2)) for one in (found, blind)]
    assert size[0] < 0.2 * size[1]


def test_binned_recordings_are_turned_back_too():
    true, run = driven(FILTERED)
    time = run.time[:-1:10]
    means = np.add.reduceat(run.state_nu[:-1], np.arange(0, 600, 10)) / 10
    bins = replace(
        run,
        time=time,
        eta=run.eta[:-1:10],
        nu=means,
        nu_dot=backward_difference(means, time),
        usable=run.usable[:-1:10],
        state_nu=run.state_nu[:-1:10],
        binned=True,
        end=float(run.time[-1]),
    )
    errors = []
    for world in (FILTERED, CLEAR):
        found = replay(world, bins, OPEN).horizons["2"]
        known = bins.usable & np.isfinite(found.nu[:, 0])
        assert known.sum() > 30
        errors.append(np.sqrt(np.mean((found.nu - means)[known] ** 2)))
    assert errors[0] < 0.3 * errors[1]
    seen = undo_mocap_view(FILTERED, bins)
    inside = slice(5, -5)
    late, back = (np.abs(one.state_nu - true[:-1:10, 7:])[inside] for one in (bins, seen))
    assert back.mean() < 0.3 * late.mean()


@pytest.mark.parametrize(
    ("delay", "likelihood", "absorbed"),
    [
        (0.001, 10.0, True),
        (-0.007, 10.0, True),
        (0.009, 10.0, True),
        (0.001, -np.inf, False),
        (0.03, 10.0, False),
        (-0.02, 10.0, False),
        (-0.08, 10.0, False),
    ],
    ids=[
        "late",
        "early",
        "a frame late",
        "nothing is observed",
        "too late",
        "too early",
        "before the filter",
    ],
)
def test_a_delay_is_the_filters_where_the_noise_leaves_it_open(delay, likelihood, absorbed):
    smoothing, base = (
        Smoothing(
            6.0, std=0.3, lr_statistic=100.0, noise_cutoff=6.0, lowest=5.5, highest=7.0, frame=0.01
        ),
        model(),
    )
    delayed = Term(InputDelay(delay=delay), ("delay",))
    h = Hypothesis(with_camera_filter(base, smoothing), (delayed,))
    found = SimpleNamespace(hypothesis=h, columns=[[0]], std=np.array([0.01]))
    unmoved = SimpleNamespace(x=np.empty(0))
    rest = SimpleNamespace(is_finite=np.isfinite(likelihood), hypothesis=unmoved)
    workspace = SimpleNamespace(fit=lambda start: rest)
    selection = SearchResult(workspace, found, ())
    again, finer = absorb_delay(selection, base, smoothing)
    assert (again.best is rest) is absorbed
    assert (finer != smoothing) is absorbed
    late = finer.effect.effective_time(0.0) + 1.0 / (np.pi * finer.cutoff)
    assert late == pytest.approx(1.0 / (6.0 * np.pi) + absorbed * delay)
    assert (finer.latency != 0.0) is (delay == 0.009)  # the noise knows the cutoff far better


@pytest.mark.parametrize(
    ("lag", "likelier", "absorbed"),
    [(0.009, 10.0, True), (0.009, 1e3, False), (0.05, 10.0, False)],
    ids=["a frame", "a frame, and surely no delay", "far longer"],
)
def test_thrusters_that_lag_by_a_frame_are_the_filter(lag, likelier, absorbed):
    """`likelier`: by how much the lag is than the filter's latency, twice the log likelihood."""
    base = model()
    smoothing = Smoothing(
        6.0, std=0.3, lr_statistic=100.0, noise_cutoff=6.0, lowest=5.5, highest=7.0, frame=0.01
    )

    def found(start, score=0.0):
        covariance = np.diag(np.full(len(start.x), 0.01**2))
        return Fit(Linearised(start, [], []), FIRST_NOISE, score, covariance)

    def fit(start, prior_std=np.inf):
        if "thruster_lag" in (term.id for term in start.terms):
            return found(start)  # a delay beside it has nothing to explain
        late = (Term(InputDelay(delay=lag), ("delay",)),) if start.terms else ()
        return found(replace(start, terms=late), -likelier)

    h = Hypothesis(
        with_camera_filter(base, smoothing),
        (Term(ThrusterLag(time_constant=lag), ("time_constant",)),),
    )
    workspace = SimpleNamespace(fit=fit, score=lambda one: one.two_log_likelihood, penalty=0.0)
    again, finer = absorb_delay(SearchResult(workspace, found(h), ()), base, smoothing)
    assert (again.best.hypothesis.terms == ()) is absorbed
    assert finer.latency == pytest.approx(lag if absorbed else 0.0)


@pytest.mark.parametrize(
    ("ended", "delayed", "chosen"),
    [
        ((8.8, 13.0), False, 0),
        ((11.0, 13.0), False, 1),
        ((8.8, 13.0), True, 1),
        ((20.0, 20.0), True, 1),
    ],
    ids=["as the noise tells", "far from that", "with a delay", "neither"],
)
def test_what_the_noise_tells_of_a_filter_holds_unless_the_motion_still_differs(
    ended, delayed, chosen
):
    """Dry friction passed for less delay, the filter for one of 13.7 Hz, and that for a lag."""
    filters = [
        Smoothing(
            f, std=0.1, lr_statistic=100.0, noise_cutoff=8.7, lowest=7.8, highest=14.4, frame=0.01
        )
        for f in (8.7, 13.7)
    ]
    starts = [SearchStart(None, None, one) for one in filters]
    late = (Term(InputDelay(delay=0.02), ("delay",)),) if delayed else ()

    def search_from(start):
        k = starts.index(start)
        best = SimpleNamespace(hypothesis=Hypothesis(model(), late))
        return SearchResult(None, best, ()), replace(start.smoothing, cutoff=ended[k])

    start, selection, smoothing = search_with_consistent_filter(starts, search_from)
    assert start is starts[chosen]
    assert smoothing.cutoff == ended[chosen]
    assert selection.best.hypothesis.terms == late
