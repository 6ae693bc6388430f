"""Rotations and axis conventions.

Inside rovsim the world is NED and the body FRD (Fossen 2021, sec. 2.1). Quaternions are unit,
scalar first (w, x, y, z), and rotate body vectors into the world: x_world = R(q) x_body.
Every function takes arrays with any leading axes. SciPy turns other forms into quaternions. What is
computed from quaternions is computed here, because SciPy refuses those of unseen frames (NaN) and
of models that diverged, scales all to unit length, and loses their sign.
"""

from typing import Literal, NamedTuple

import numpy as np
import scipy
from numpy import ndarray as Array

WorldAxes = Literal["z_up", "ned", "y_up"]
BodyAxes = Literal["flu", "frd", "fur"]

# A half turn about x: z-up <-> NED and FLU <-> FRD (docs/formats.md).
HALF_TURN_X = np.array([1.0, -1.0, -1.0])


def axes_signs(axes: WorldAxes | BodyAxes) -> Array:
    """Signs (3,) that turn components along `axes` into NED or FRD components, and back.

    For `y_up` and `fur` (forward, up, right) they are those of `z_up` and `flu`, into which readers
    have turned the data before.
    """
    return np.ones(3) if axes in ("ned", "frd") else HALF_TURN_X


def half_turn(signs: Array) -> Array:
    """Quaternion (4,) of the rotation diag(signs): identity, or a half turn about x."""
    return np.array([1.0, 0, 0, 0]) if signs[1] > 0 else np.array([0.0, 1, 0, 0])


def _elements(q: Array) -> tuple[Array, Array, Array, Array]:
    """w, x, y, z of quaternions (..., 4)."""
    return q[..., 0], q[..., 1], q[..., 2], q[..., 3]


def multiply(a: Array, b: Array) -> Array:
    """Hamilton product of quaternions (..., 4)."""
    aw, ax, ay, az = _elements(a)
    bw, bx, by, bz = _elements(b)
    return _joined(
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    )


def _joined(*parts: Array) -> Array:
    """Stack parts (...) along a new last axis; `np.stack` takes twice as long for few numbers."""
    stacked = np.empty((*parts[0].shape, len(parts)), parts[0].dtype)
    for i, part in enumerate(parts):
        stacked[..., i] = part
    return stacked


def conjugate(q: Array) -> Array:
    """Inverse of unit quaternions (..., 4)."""
    return q * np.array([1.0, -1.0, -1.0, -1.0])


def normalized(q: Array) -> Array:
    """Quaternions (..., 4) scaled to unit length."""
    return q / np.linalg.norm(q, axis=-1, keepdims=True)


def rotate(q: Array, x: Array) -> Array:
    """Rotate vectors x (..., 3) from body to world."""
    w, v = q[..., :1], q[..., 1:]
    t = 2.0 * _cross(v, x)
    return x + w * t + _cross(v, t)


def _cross(a: Array, b: Array) -> Array:
    """Cross product (..., 3); that of NumPy takes twice as long."""
    (x, y, z), (u, v, w) = (a[..., 0], a[..., 1], a[..., 2]), (b[..., 0], b[..., 1], b[..., 2])
    return _joined(y * w - z * v, z * u - x * w, x * v - y * u)


def unrotate(q: Array, x: Array) -> Array:
    """Rotate vectors x (..., 3) from world to body."""
    return rotate(conjugate(q), x)


def matrix(q: Array) -> Array:
    """Rotation matrices (..., 3, 3), body to world (Fossen 2021, eq. 2.73)."""
    w, x, y, z = _elements(q)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def from_matrix(R: Array) -> Array:
    """Quaternions (..., 4) with w >= 0 of the rotations nearest to R (..., 3, 3)."""
    return scipy.spatial.transform.Rotation.from_matrix(R).as_quat(
        canonical=True, scalar_first=True
    )


def continuous(q: Array) -> Array:
    """Flip signs of quaternions (time, 4) so that neighbours never have opposite signs."""
    flips = np.sign(np.sum(q[1:] * q[:-1], axis=-1))
    flips[flips == 0] = 1.0
    return q * np.concatenate([[1.0], np.cumprod(flips)])[:, None]


def unwrapped(angles: Array) -> Array:
    """Unwrap angles (time, c) in rad along time, also across gaps (NaN)."""
    result = angles.copy()
    for column in result.T:
        finite = np.isfinite(column)
        column[finite] = np.unwrap(column[finite])
    return result


def from_euler(roll: Array, pitch: Array, yaw: Array) -> Array:
    """Quaternions (..., 4) of the angles R = Rz(yaw) Ry(pitch) Rx(roll) (Fossen 2021, eq. 2.31)."""
    angles = np.stack(np.broadcast_arrays(yaw, pitch, roll), axis=-1)
    return scipy.spatial.transform.Rotation.from_euler("ZYX", angles).as_quat(scalar_first=True)


def to_euler(q: Array) -> Array:
    """Roll, pitch, yaw (..., 3) in rad, pitch within +-pi/2. For display, never for rates."""
    w, x, y, z = _elements(q)
    roll = np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    pitch = np.arcsin(np.minimum(np.maximum(2 * (w * y - z * x), -1.0), 1.0))
    yaw = np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    return np.stack([roll, pitch, yaw], axis=-1)


def short_way(angle: Array | float) -> Array:
    """Wrap angles in rad to -pi .. pi."""
    return np.asarray((angle + np.pi) % (2.0 * np.pi) - np.pi)


def exp(rotation: Array) -> Array:
    """Quaternions (..., 4) of rotation vectors (..., 3) in rad."""
    if not np.any(rotation):  # as for every model without rotated frames; SciPy imports slowly
        return np.tile([1.0, 0.0, 0.0, 0.0], (*np.shape(rotation)[:-1], 1))
    # SciPy takes no read-only array
    return scipy.spatial.transform.Rotation.from_rotvec(np.array(rotation)).as_quat(
        scalar_first=True
    )


def log(q: Array) -> Array:
    """Rotation vectors (..., 3) in rad, length at most pi, of unit quaternions (..., 4)."""
    q = np.where(q[..., :1] < 0, -q, q)
    sine = np.linalg.norm(q[..., 1:], axis=-1, keepdims=True)
    angle = 2.0 * np.arctan2(sine, q[..., :1])
    ratio = np.where(sine > 1e-12, angle / np.maximum(sine, 1e-12), 2.0)
    return ratio * q[..., 1:]


def turns(q: Array) -> Array:
    """Rotation vectors (n - 1, 3) in rad, body axes, from each of the attitudes (n, 4) to the next.

    The shorter way round, whatever the signs of the quaternions.
    """
    return log(multiply(conjugate(q[:-1]), q[1:]))


def angle_between(a: Array, b: Array) -> Array:
    """Angle (...), rad, of the shorter turn between attitudes (..., 4)."""
    return 2.0 * np.arccos(np.minimum(np.abs(np.sum(a * b, axis=-1)), 1.0))


def body_rates(q: Array, q_dot: Array) -> Array:
    """Angular velocity (..., 3) in the body frame: omega = 2 q* q_dot (Fossen 2021, eq. 2.78)."""
    return 2.0 * multiply(conjugate(q), q_dot)[..., 1:]


def body_rate_derivative(q: Array, q_ddot: Array) -> Array:
    """Derivative (..., 3) of `body_rates`: the product q_dot* q_dot is real, so 2 q* q_ddot."""
    return 2.0 * multiply(conjugate(q), q_ddot)[..., 1:]


class Rigid(NamedTuple):
    """A rigid transform x -> R(rotation) x + translation; quaternion (4,) and vector (3,)."""

    rotation: Array
    translation: Array

    def after(self, first: "Rigid") -> "Rigid":
        """The transform that applies `first`, then this one."""
        shifted = rotate(self.rotation, first.translation) + self.translation
        return Rigid(multiply(self.rotation, first.rotation), shifted)

    @property
    def inverse(self) -> "Rigid":
        """The transform that undoes this one."""
        return Rigid(conjugate(self.rotation), -unrotate(self.rotation, self.translation))

    @staticmethod
    def by(turn: Array | float = 0.0, shift: Array | float = 0.0) -> "Rigid":
        """Make the transform of a turn by a rotation vector (3,) in rad, then a shift (3,) in m."""
        return Rigid(exp(np.zeros(3) + turn), np.zeros(3) + shift)
