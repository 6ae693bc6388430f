"""The factors that terms of a law may be made of, with their units and mirror symmetry.

Their order is that of `laws.codes`. Nearly every vehicle is symmetric between port and starboard.
When these are exchanged, sway, roll and yaw change sign, with the factors that are odd in them.
"""

from dataclasses import dataclass
from typing import Mapping

import numpy as np
from numpy import ndarray as Array

from rovsim.core.axes import AXES, VELOCITY
from rovsim.core.rotations import matrix
from rovsim.dynamics.laws.law import MIN_SPEED, SIGN_WIDTH, TILT_SIGN_WIDTH

# In kernels, where `p` are the parameters.
VELOCITIES_IN_CODE = ("u", "v", "w", "roll", "pitch", "yaw")
LATERAL_AXES = (1, 3, 5)  # axes that change sign when port and starboard are exchanged


@dataclass(frozen=True)
class Variable:
    """A factor of a term.

    Attributes:
        symbol: for results.
        latex: in LaTeX.
        code: expression in a kernel.
        meters: power of m in its unit.
        seconds: power of s in its unit.
        radians: power of rad in its unit.
        odd: whether it changes sign when port and starboard are exchanged; None for a place in the
            tank, to which that symmetry does not apply.
        meaning: words for sentences.
    """

    symbol: str
    latex: str
    code: str
    meters: int
    seconds: int
    radians: int
    odd: bool | None
    meaning: str


def _velocities() -> list[Variable]:
    """Velocity, absolute value and smooth sign of each of the six body axes."""
    signs = (r"\tanh({}/" + f"{SIGN_WIDTH:g})", "tanh({} / " + f"{SIGN_WIDTH:g})")
    kinds = (
        ("{}", "{}", "{}", "{} velocity"),
        ("|{}|", "|{}|", "abs({})", "{} speed"),
        ("sign({})", *signs, "the direction of {} motion"),
    )
    return [
        Variable(
            kind.format(VELOCITY[i]),
            latex.format(VELOCITY[i]),
            code.format(VELOCITIES_IN_CODE[i]),
            *_unit_of_velocity(i, kind),
            i in LATERAL_AXES and kind != "|{}|",
            meaning.format(axis),
        )
        for kind, latex, code, meaning in kinds
        for i, axis in enumerate(AXES)
    ]


def _unit_of_velocity(i: int, kind: str) -> tuple[int, int, int]:
    """Powers of m, s, rad; the sign of a velocity has none."""
    if kind.startswith("sign"):
        return 0, 0, 0
    return (0, -1, 1) if i >= 3 else (1, -1, 0)


def _attitudes() -> list[Variable]:
    """Components of the NED z axis in body axes, and their smooth signs."""
    signs = (r"\tanh(d_{}/" + f"{TILT_SIGN_WIDTH:g})", "tanh(d{} / " + f"{TILT_SIGN_WIDTH:g})")
    kinds = (("d_{}", "d_{}", "d{}"), ("sign(d_{})", *signs))
    return [
        Variable(symbol.format(x), latex.format(x), code.format(x), 0, 0, 0, x == "y", meaning)
        for symbol, latex, code in kinds
        for x, meaning in (("x", "pitch"), ("y", "roll"), ("z", "uprightness"))
    ]


VARIABLES: tuple[Variable, ...] = (
    *_velocities(),
    *_attitudes(),
    Variable("U", "U", "U", 1, -1, 0, False, "speed"),
    Variable("1/U", r"U^{-1}", f"(1.0 / sqrt(U * U + {MIN_SPEED**2:g}))", -1, 1, 0, False, "speed"),
    Variable("n", "(n - n_0)", "north", 1, 0, 0, None, "place along north"),
    Variable("e", "(e - e_0)", "east", 1, 0, 0, None, "place along east"),
    Variable("d", "(d - d_0)", "deep", 1, 0, 0, None, "depth"),
    Variable("near", r"e^{-((n-n_0)^2+(e-e_0)^2)/2s^2}", "near", 0, 0, 0, None, "one place"),
)


def tabulate(state: Array, place: Array) -> Array:
    """Evaluate all 30 factors at n states.

    Args:
        state: (n, 13) position in NED m, quaternion body to world, body velocity m/s and rad/s.
        place: (4,) place in NED and width, m, for the factors that depend on place.

    Returns:
        Values (30, n) in the order of `VARIABLES`.
    """
    nu, R = state[:, 7:].T, matrix(state[:, 3:7])
    down, U = R[:, 2].T, np.sqrt(np.sum(state[:, 7:10] ** 2, axis=1))
    n, e, d = state[:, :3].T - place[:3, None]
    proximity = np.exp(-(n**2 + e**2) / (2.0 * place[3] ** 2))
    extra = [U, 1.0 / np.sqrt(U**2 + MIN_SPEED**2), n, e, d, proximity]
    return np.vstack(
        [nu, np.abs(nu), np.tanh(nu / SIGN_WIDTH), down, np.tanh(down / TILT_SIGN_WIDTH), *extra]
    )


def write_unit(powers: Mapping[str, int], head: str = "") -> str:
    """Write a unit as the catalogue does, such as N s2/m2, N m s/rad or 1/s.

    Args:
        powers: of the units, by name.
        head: a unit that comes first, such as N or N m; empty for none.
    """
    numerators = [_power(name, k) for name, k in powers.items() if k > 0]
    denominators = [_power(name, -k) for name, k in powers.items() if k < 0]
    numerator = " ".join(([head] if head else []) + numerators) or "1"
    denominator = " ".join(denominators)
    return numerator + (
        f"/({denominator})" if len(denominators) > 1 else f"/{denominator}" if denominators else ""
    )


def _power(name: str, k: int) -> str:
    return name if k == 1 else f"{name}{k}"
