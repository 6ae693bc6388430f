"""Laws that hold whatever the numbers are."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from rovsim.core.errors import BadInput
from rovsim.core.rotations import exp, multiply, rotate
from rovsim.dynamics.body import Body, cross_matrix, inertia_at, packed
from rovsim.dynamics.effects.added_mass import AddedMass, AddedMassCoupling
from rovsim.dynamics.effects.current import Current
from rovsim.dynamics.effects.proximity import SurfaceProximity, WallProximity
from rovsim.dynamics.engine.equation import coriolis
from rovsim.dynamics.engine.vectors import matrix6
from rovsim.simulation.replay import simulate
from rovsim.simulation.settings import ReplaySettings
from worlds import at_rest, model, motion, sticks, tank

speeds = arrays(float, 6, elements=st.floats(-2, 2))
factors = arrays(float, (6, 6), elements=st.floats(-1, 1))


def rows(M):
    return tuple(tuple(float(x) for x in row) for row in M)


def fossen_coriolis(M, nu):
    """Fossen 2021, eq. 6.43: C from the blocks of a symmetric M."""
    a = M[:3, :3] @ nu[:3] + M[:3, 3:] @ nu[3:]
    b = M[3:, :3] @ nu[:3] + M[3:, 3:] @ nu[3:]
    top = np.hstack([np.zeros((3, 3)), -cross_matrix(a)])
    return np.vstack([top, np.hstack([-cross_matrix(a), -cross_matrix(b)])])


@given(A=factors, nu=speeds)
def test_coriolis_does_no_work_and_is_fossens(A, nu):
    M = A @ A.T + np.eye(6)
    tau = np.array(coriolis.py_func(rows(M), tuple(float(x) for x in nu)))
    assert abs(nu @ tau) < 1e-9
    np.testing.assert_allclose(tau, fossen_coriolis(M, nu) @ nu, atol=1e-9)


@given(values=arrays(float, 15, elements=st.floats(-0.1, 0.1)))
def test_coupled_added_mass_is_symmetric_and_exists(values):
    names = [p.name for p in AddedMassCoupling.parameters]
    M = model(AddedMassCoupling(**dict(zip(names, values, strict=True)))).body.M
    np.testing.assert_array_equal(M, M.T)
    assert np.linalg.eigvalsh(M).min() > 0


@settings(max_examples=15, deadline=None)
@given(nu=speeds, place=arrays(float, 3, elements=st.floats(-3, 3)))
def test_boundaries_only_take_energy(nu, place):
    """Whatever the place, even outside: the damping grows, by no more than the gains allow."""
    start, still = at_rest(), ReplaySettings(step=1e-4)
    start[:3], start[7:] = place, 0.2 * nu
    run = motion(np.zeros((1, 8)), seconds=0.1, start=start, site=tank())
    run = replace(run, time=run.time * 0.01)  # one step of 0.1 ms
    near = model(WallProximity(gain=1.0), SurfaceProximity(gain=2.0))
    rates = [
        (simulate(world, run, [(0, 1, start)], still)[0][1, 7:] - start[7:]) / 1e-4
        for world in (near, model())
    ]
    extra = (rates[0] - rates[1]) @ model().body.M @ start[7:]
    v, body = start[7:], model().body
    drag = (body.linear + body.quadratic * np.abs(v)) @ (v * v)
    assert -4.01 * drag - 1e-6 <= extra <= 1e-6


def test_matrix6_keeps_rows():
    M = np.arange(36.0).reshape(6, 6)
    assert np.array(matrix6(M)).tolist() == M.tolist()


def test_parallel_axis_theorem_gives_the_kinetic_energy_of_a_point_mass():
    r, nu = np.array([0.3, -0.2, 0.1]), np.array([0.4, -0.1, 0.2, 0.5, -0.6, 0.7])
    v = nu[:3] + np.cross(nu[3:], r)
    M = inertia_at(2.5, r, np.zeros((3, 3)))
    assert nu @ M @ nu == pytest.approx(2.5 * v @ v)


def test_a_body_that_cannot_exist_is_refused():
    with pytest.raises(BadInput, match="positive definite"):
        _ = model(AddedMass(surge=-25.0)).body.M
    with pytest.raises(BadInput, match="eigenvalue"):
        packed(Body(gravity=9.82))


def path(world, start, seconds=2.0, step=0.01, commands=None):
    value = np.zeros((1, 8)) if commands is None else commands
    run = motion(value, seconds=seconds, start=start)
    found = simulate(world, run, [(0, len(run.time) - 1, start)], ReplaySettings(step=step))
    return found[0]


@settings(max_examples=15, deadline=None)
@given(heading=st.floats(-3, 3), shift=arrays(float, 3, elements=st.floats(-5, 5)))
def test_turning_and_moving_the_world_turns_and_moves_the_path(heading, shift):
    start, turn = at_rest(), exp(np.array([0.0, 0.0, heading]))
    start[7:] = [0.3, -0.2, 0.1, 0.4, -0.3, 0.2]
    turned = start.copy()
    turned[:3], turned[3:7] = shift, multiply(turn, start[3:7])
    one = path(model(), start, commands=sticks())
    two = path(model(), turned, commands=sticks())
    np.testing.assert_allclose(two[:, :3], rotate(turn, one[:, :3]) + shift, atol=1e-9)
    np.testing.assert_allclose(two[:, 7:], one[:, 7:], atol=1e-9)


@settings(max_examples=15, deadline=None)
@given(c=arrays(float, 3, elements=st.floats(-0.3, 0.3)))
def test_a_current_is_a_moving_frame(c):
    """Galileo: rigid-body inertia is felt in the inertial frame too, so this must hold exactly."""
    start = at_rest()
    start[7:] = [0.2, 0.1, -0.1, 0.3, 0.2, -0.4]
    drifting = start.copy()
    drifting[7:10] += c  # level at the start: body and world axes coincide
    still = path(model(), start, commands=sticks())
    moved = path(model(Current(north=c[0], east=c[1], down=c[2])), drifting, commands=sticks())
    t = np.arange(len(still))[:, None] * 0.01
    np.testing.assert_allclose(moved[:, :3], still[:, :3] + c * t, atol=2e-7)
    np.testing.assert_allclose(moved[:, 10:], still[:, 10:], atol=2e-6)


def test_the_vehicle_rights_itself_and_sinks():
    start = at_rest()
    start[3:7] = exp(np.array([0.5, 0.3, 0.0]))
    found = path(model(), start, seconds=1.0)
    assert found[-1, 10] < 0 > found[-1, 11]  # rolls and pitches back
    assert found[-1, 2] > 0  # weight exceeds buoyancy by 0.98 N (vehicle file)
