"""Which quaternions and matrices of a file are rotations."""

from typing import Callable

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.core.rotations import normalized

# A rotation matrix printed to six digits is orthonormal to about 1e-6; a cut or damaged line is
# not. The same bound holds for the length of quaternions.
ORTHONORMAL_WITHIN = UNIT_WITHIN = 0.1


def finite_rows(*arrays: Array) -> Array:
    """Mask (n,) of the rows in which every number of all `arrays` (n, k) is finite."""
    return np.logical_and.reduce([np.isfinite(a).all(axis=1) for a in arrays])


def unit_quaternions(values: Array) -> tuple[Array, Array]:
    """Scale quaternions (n, 4) to unit length, and say which of them (n,) are rotations.

    Those far from unit length are not: trackers write zeros where the body was not found. They
    become the unit quaternion without rotation.
    """
    valid = finite_rows(values) & (np.abs(_length(values) - 1.0) < UNIT_WITHIN)
    return normalized(np.where(valid[:, None], values, [1.0, 0.0, 0.0, 0.0])), valid


def check_unit_length(values: Array, place: Callable[[int], str]) -> tuple[str, ...]:
    """Warn about quaternions (n, 4) whose length is neither 1 nor 0.

    Args:
        values: the quaternions as they were read.
        place: says where a row stands in the file, for people.

    Returns:
        Sentences about such quaternions.

    Raises:
        BadInput: most of those that are not zero have not length 1.
    """
    nonzero = finite_rows(values) & values.any(axis=1)
    length = _length(values)
    invalid = np.flatnonzero(nonzero & ~(np.abs(length - 1.0) < UNIT_WITHIN))
    if 2 * len(invalid) > nonzero.sum():
        raise BadInput(
            f"a quaternion of length {length[invalid[0]]:.3g} ({len(invalid)} of {nonzero.sum()} "
            "have not length 1)",
            where=place(int(invalid[0])),
            expected="quaternions of length 1, or zeros where the body was not found",
            remedy="Check which columns hold it, and that all four have the same scale; if they "
            "are a multiple of it, divide them by their length.",
        )
    if not len(invalid):
        return ()
    return (f"{len(invalid)} lines whose quaternion has not length 1 count as not found.",)


def _length(values: Array) -> Array:
    """Length (n,) of rows (n, k)."""
    with np.errstate(over="ignore"):
        return np.linalg.norm(values, axis=1)


def orthonormal(R: Array) -> Array:
    """Mask (n,) of the matrices (n, 3, 3) that are rotations: orthonormal and right-handed."""
    with np.errstate(invalid="ignore", over="ignore"):
        deviation = np.abs(np.swapaxes(R, 1, 2) @ R - np.eye(3)).max(axis=(1, 2))
        return (deviation < ORTHONORMAL_WITHIN) & (np.linalg.det(R) > 0.0)
