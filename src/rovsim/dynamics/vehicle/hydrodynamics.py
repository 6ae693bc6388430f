"""Added mass and damping of a vehicle file: six numbers on the diagonal, or whole matrices."""

from typing import Annotated, Any

import numpy as np
from numpy import ndarray as Array
from pydantic import Field, PlainValidator

from rovsim.core.axes import AXES
from rovsim.core.schema import Section
from rovsim.dynamics.effects.added_mass import PAIRS as MASS_PAIRS
from rovsim.dynamics.effects.added_mass import AddedMass, AddedMassCoupling
from rovsim.dynamics.effects.base import Effect
from rovsim.dynamics.effects.coupled_damping import PAIRS as DRAG_PAIRS
from rovsim.dynamics.effects.coupled_damping import CoupledDamping
from rovsim.dynamics.effects.damping import LinearDamping, QuadraticDamping
from rovsim.dynamics.vehicle.cross_flow import CrossFlow, Products

Numbers = tuple[float, ...] | tuple[tuple[float, ...], ...]


def _six_or_matrix(value: Any) -> Numbers:
    """Check six finite numbers, or six rows of six, with a diagonal that is not negative."""
    try:
        a = np.array(value, dtype=float)
    except (TypeError, ValueError):
        a = np.empty(0)
    if a.shape not in ((6,), (6, 6)) or not np.isfinite(a).all():
        raise ValueError("six finite numbers, or six rows of six")
    if np.any((a if a.ndim == 1 else np.diag(a)) < 0.0):
        raise ValueError("inertia and drag of at least 0 on the diagonal")
    return tuple(a.tolist()) if a.ndim == 1 else tuple(tuple(row) for row in a.tolist())


def _symmetric(value: Any) -> Numbers:
    """Check six numbers, or a matrix of six rows that is symmetric."""
    numbers = _six_or_matrix(value)
    a = matrix(numbers)
    if np.abs(a - a.T).max() > 1e-6 * np.abs(a).max():
        raise ValueError("a symmetric matrix (Fossen 2021, sec. 6.3)")
    return numbers


# `Any` instead of `Numbers`: pydantic would check these once more when it writes them
Diagonal = Annotated[Any, PlainValidator(_six_or_matrix)]
Symmetric = Annotated[Any, PlainValidator(_symmetric)]


def matrix(numbers: Numbers) -> Array:
    """The matrix (6, 6) of six numbers on its diagonal, or of six rows."""
    a = np.array(numbers, dtype=float)
    return np.diag(a) if a.ndim == 1 else a


class Hydrodynamics(Section):
    """Added mass and damping: six numbers on the diagonal, or a matrix; positive = inertia, drag.

    A matrix D of linear damping stands for tau_i = -sum_j D_ij nu_j. One of quadratic damping
    stands for tau_i = -sum_j D_ij |nu_j| nu_j: D_n(nu) of Fossen 2021, sec. 6.4, where each column
    is multiplied by the speed of its own axis. `cross_flow` has other products of velocities.
    """

    added_mass: Symmetric
    linear_damping: Diagonal
    quadratic_damping: Diagonal
    cross_flow: Products = Field(default_factory=dict)

    def effects(self) -> tuple[Effect, ...]:
        """The effects of these numbers; couplings that are all zero have no effect."""
        mass, linear, quadratic = (
            matrix(n) for n in (self.added_mass, self.linear_damping, self.quadratic_damping)
        )
        couplings = (
            AddedMassCoupling(**{f"{AXES[i]}_{AXES[j]}": mass[i, j] for i, j in MASS_PAIRS}),
            CoupledDamping(**_couplings(linear, ""), **_couplings(quadratic, "_quadratic")),
        )
        return (
            AddedMass(**_by_axis(mass)),
            LinearDamping(**_by_axis(linear)),
            QuadraticDamping(**_by_axis(quadratic)),
            *(coupling for coupling in couplings if coupling.given()),
            *((CrossFlow(self.cross_flow),) if self.cross_flow else ()),
        )


def _by_axis(a: Array) -> dict[str, float]:
    """The diagonal of a matrix (6, 6), by axis."""
    return dict(zip(AXES, np.diag(a).tolist(), strict=True))


def _couplings(a: Array, suffix: str) -> dict[str, float]:
    """The off-diagonal elements of a matrix (6, 6), by parameter of `CoupledDamping`."""
    return {f"{AXES[i]}_from_{AXES[j]}{suffix}": a[i, j] for i, j in DRAG_PAIRS}
