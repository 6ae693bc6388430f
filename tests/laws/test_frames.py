"""Laws of rotations and of the axes conventions."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from rovsim.core import rotations
from rovsim.core.run import Commands, RunInfo, Site
from rovsim.measurement.campaign_file import Mocap
from rovsim.measurement.recording.exports import Export
from rovsim.measurement.recording.run_files import to_ned

numbers = st.floats(-1.0, 1.0, allow_subnormal=False)
vectors = arrays(float, 3, elements=numbers)


@st.composite
def quaternions(draw):
    q = draw(arrays(float, 4, elements=numbers))
    assume(np.linalg.norm(q) > 0.1)
    return rotations.normalized(q)


@given(quaternions())
def test_a_matrix_and_its_quaternion_are_the_same_rotation(q):
    R = rotations.matrix(q)
    np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(R) == pytest.approx(1.0)
    np.testing.assert_allclose(rotations.matrix(rotations.from_matrix(R)), R, atol=1e-12)


@given(quaternions(), vectors)
def test_rotate_is_the_matrix_and_unrotate_undoes_it(q, x):
    np.testing.assert_allclose(rotations.rotate(q, x), rotations.matrix(q) @ x, atol=1e-12)
    np.testing.assert_allclose(rotations.unrotate(q, rotations.rotate(q, x)), x, atol=1e-12)


@given(quaternions(), quaternions())
def test_products_compose_as_matrices_do(a, b):
    product = rotations.matrix(rotations.multiply(a, b))
    np.testing.assert_allclose(product, rotations.matrix(a) @ rotations.matrix(b), atol=1e-12)


@given(vectors)
def test_log_undoes_exp(x):
    turned = rotations.log(rotations.exp(3.0 * x / np.sqrt(3.0)))
    np.testing.assert_allclose(turned, np.sqrt(3.0) * x, atol=1e-9)


@given(st.floats(-3.1, 3.1), st.floats(-1.5, 1.5), st.floats(-3.1, 3.1))
def test_euler_angles_come_back_and_follow_their_order(roll, pitch, yaw):
    q = rotations.from_euler(roll, pitch, yaw)
    np.testing.assert_allclose(rotations.to_euler(q), [roll, pitch, yaw], atol=1e-7)
    x, y, z = np.eye(3)
    in_turn = rotations.multiply(
        rotations.multiply(rotations.exp(yaw * z), rotations.exp(pitch * y)),
        rotations.exp(roll * x),
    )
    np.testing.assert_allclose(rotations.matrix(q), rotations.matrix(in_turn), atol=1e-12)


@given(quaternions(), st.floats(-0.02, 0.02), st.integers(0, 8))
def test_noise_in_a_matrix_still_gives_a_rotation_nearby(q, noise, place):
    R = rotations.matrix(q)
    R.ravel()[place] += noise
    found = rotations.matrix(rotations.from_matrix(R))
    assert np.abs(found - rotations.matrix(q)).max() <= abs(noise) + 1e-9


@given(vectors, quaternions())
def test_body_rates_are_the_turning_speed(omega, q):
    half = rotations.multiply(q, np.concatenate([[0.0], 0.5 * omega]))  # q_dot (Fossen eq. 2.78)
    np.testing.assert_allclose(rotations.body_rates(q, half), omega, atol=1e-12)


def read(position, q, world_axes, body_axes, nu=None):
    """One pose (repeated) through the conversion of the readers."""
    twice = Export(
        np.array([0.0, 1.0]),
        np.tile(position, (2, 1)),
        np.tile(q, (2, 1)),
        np.ones(2, bool),
        nu=None if nu is None else np.tile(nu, (2, 1)),
    )
    mocap = Mocap(format="csv", world_axes=world_axes, body_axes=body_axes)
    commands = Commands(np.zeros(1), np.zeros((1, 1)), "thruster")
    return to_ned(twice, mocap, RunInfo("a", "6dof", "train"), Site.unknown(), commands)


@given(vectors, quaternions(), st.sampled_from(["z_up", "ned"]), st.sampled_from(["flu", "frd"]))
def test_conversion_keeps_right_handedness_and_undoes_itself(p, q, world, body):
    once = read(p, q, world, body)
    R = rotations.matrix(once.attitude[0])
    assert np.linalg.det(R) == pytest.approx(1.0)
    again = read(once.position[0], once.attitude[0], world, body)
    np.testing.assert_allclose(again.position[0], p, atol=1e-12)
    np.testing.assert_allclose(rotations.matrix(again.attitude[0]), rotations.matrix(q), atol=1e-12)


@given(
    vectors,
    vectors,
    quaternions(),
    st.sampled_from(["z_up", "ned"]),
    st.sampled_from(["flu", "frd"]),
)
def test_a_point_on_the_body_lands_in_the_same_place(p, point, q, world, body):
    in_file = rotations.axes_signs(world) * (p + rotations.rotate(q, point))
    once = read(p, q, world, body)
    on_body = rotations.axes_signs(body) * point
    converted = once.position[0] + rotations.rotate(once.attitude[0], on_body)
    np.testing.assert_allclose(converted, in_file, atol=1e-12)


def test_axes_have_the_meaning_of_their_names():
    level = np.array([1.0, 0, 0, 0])
    nu = np.array([1.0, 2.0, 3.0, 0.1, 0.2, 0.3])
    up = read(np.array([1.0, 2.0, 3.0]), level, "z_up", "flu", nu)
    np.testing.assert_allclose(up.position[0], [1, -2, -3])
    np.testing.assert_allclose(up.attitude[0], level, atol=1e-15)
    np.testing.assert_allclose(up.nu[0], [1, -2, -3, 0.1, -0.2, -0.3])
    # in a z-up world an FRD body that is level has its z axis against the world's
    mixed = read(np.zeros(3), rotations.exp(np.array([np.pi, 0, 0])), "z_up", "frd", nu)
    np.testing.assert_allclose(rotations.matrix(mixed.attitude[0]), np.eye(3), atol=1e-12)
    np.testing.assert_allclose(mixed.nu[0], nu)
