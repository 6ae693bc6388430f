"""Pushes that come at once are told from noise, but where nobody knows what thrusters did."""

from types import SimpleNamespace

import numpy as np
from scipy.signal import lfilter

from rovsim.diagnosis.structure.residual import AxisResidual
from rovsim.diagnosis.structure.sudden_pushes import find_kicks, find_sudden
from rovsim.estimation.kernels.axis import POSE
from rovsim.estimation.observer.kalman import AxisErrorDynamics, AxisNoise, design_filter

PERIOD, COUNT, KICK = 0.05, 1200, 600
NOISE = AxisNoise(disturbance_std=0.02, correlation_time=1.0, measurement_std=1e-3)


def residual_with(size, undecided, noise=1.0):
    """Noise and one push of 0.2 s, m/s2, in the innovations of an axis."""
    f = design_filter(POSE, PERIOD, AxisErrorDynamics(1.0), NOISE)
    push = np.zeros(COUNT)
    push[KICK : KICK + 4] = size
    shown = lfilter(*f.response, push)
    white = noise * np.random.default_rng(3).normal(size=COUNT) + shown
    return residual_of(white, f, undecided, np.zeros(COUNT, bool))


def residual_of(white, f, undecided, unlogged):
    """Innovations of an axis, as its filter left them."""
    time = PERIOD * np.arange(COUNT)
    run = SimpleNamespace(
        period=PERIOD,
        time=time,
        edges=time,
        settled=np.ones(COUNT, bool),
        motion=SimpleNamespace(run=SimpleNamespace(id="a"), measured=None),
    )
    nothing = np.empty((0, COUNT))
    return AxisResidual("surge", (white,), nothing, (run,), (f,), 0.02, (undecided,), (unlogged,))


def test_a_push_is_found_at_its_time():
    (found, *_) = find_kicks(residual_with(0.6, np.zeros(COUNT, bool)))
    assert found.moment
    assert "30.0 s in run a" in found.what


def test_noise_alone_is_no_push():
    assert not list(find_kicks(residual_with(0.0, np.zeros(COUNT, bool))))


def test_a_push_stands_out_of_turbulence_that_is_stronger_at_times():
    """Turbulence a seventh stronger reaches 5.6 standard deviations where even one reaches 4.9."""
    known = np.zeros(COUNT, bool)
    unit = residual_with(1.0, known, noise=0.0)
    deviations = float(np.linalg.norm(unit.white[0]))
    assert not list(find_kicks(residual_with(5.6 / deviations, known, noise=0.0)))
    assert list(find_kicks(residual_with(7.0 / deviations, known, noise=0.0)))


def test_a_push_while_a_thruster_was_at_the_edge_of_its_deadband_is_none():
    undecided = np.zeros(COUNT, bool)
    assert list(find_kicks(residual_with(0.25, undecided)))
    undecided[KICK - 4 : KICK + 8] = True
    assert not [one for one in find_kicks(residual_with(0.25, undecided)) if "0.2 s" in one.what]


def test_many_pushes_are_none_where_the_log_lost_what_thrusters_did():
    white = np.random.default_rng(3).normal(size=COUNT)
    pushed = np.zeros(COUNT, bool)
    for k in range(10, COUNT, 100):
        pushed[4 * (k // 4) : 4 * (k // 4) + 4] = True
    f = design_filter(POSE, PERIOD, AxisErrorDynamics(1.0), NOISE)
    white, known = white + 4.0 * pushed, np.zeros(COUNT, bool)
    (found,) = find_sudden(residual_of(white, f, known, known))
    assert "sudden pushes" in found.what
    assert not list(find_sudden(residual_of(white, f, known, pushed)))
    assert not list(find_sudden(residual_of(white, f, known, ~known)))
