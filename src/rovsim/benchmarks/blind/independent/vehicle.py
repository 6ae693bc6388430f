"""The vehicle's constants from its file, and the hidden effects that change them."""

from dataclasses import dataclass
from typing import Any, Mapping

import numpy as np
from numpy import ndarray as Array

from rovsim.core.axes import AXES

Hidden = Mapping[str, Mapping[str, float]]  # values by effect and parameter

MOCAP_TO_NED = np.array([1.0, -1.0, -1.0])  # between MoCap axes (z up) and NED, either way


@dataclass(frozen=True, eq=False)
class Constants:
    """What does not change during a run, in SI units, FRD at CO; axes are surge to yaw.

    Attributes:
        M: inertia (6, 6) with added mass.
        weights: (w, 4), each a force down in N, negative for buoyancy, and where it acts.
        linear: damping (6,).
        quadratic: damping (6,).
        cubic: damping (6,).
        coupled: linear and quadratic damping (2, 6, 6) on the axis of the row by the velocity of
            the column.
        position: of the thrusters (n, 3).
        direction: of their force (n, 3).
        spin: of their propellers (n,), 1 or -1; 0: none.
    """

    M: Array
    weights: Array
    linear: Array
    quadratic: Array
    cubic: Array
    coupled: Array
    position: Array
    direction: Array
    spin: Array


def skew(r: Array) -> Array:
    """Return the matrix (3, 3) of the cross product r x."""
    x, y, z = r.tolist()
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def kinetic(mass: float, place: Array, inertia: Array) -> Array:
    """Return the inertia matrix (6, 6) of a body about CO.

    Args:
        mass: of the body, kg.
        place: of its centre (3,), m.
        inertia: (3, 3) about its centre, kg m2.
    """
    of_centre = np.hstack([np.eye(3), -skew(place)])
    M = mass * of_centre.T @ of_centre
    M[3:, 3:] += inertia
    return M


def read_constants(file: Mapping[str, Any], hidden: Hidden) -> Constants:
    """Return the constants of a vehicle file, changed by the hidden effects."""
    body, water, g = file["rigid_body"], file["hydrodynamics"], float(file["fluid"]["gravity"])
    inertia = np.diag([float(body["inertia"][name]) for name in ("Ixx", "Iyy", "Izz")])
    masses = [(float(body["mass"]), np.array(body["center_of_gravity"], float), inertia)]
    load = hidden.get("payload", {})
    masses.append((load.get("mass", 0.0), _triple(load), np.zeros((3, 3))))
    M = sum(kinetic(*part) for part in masses) + np.diag(np.array(water["added_mass"], float))
    M += np.diag(_six_parameters(hidden, "added_mass")) + _pairs(
        hidden.get("added_mass_coupling", {})
    )
    buoyancy = float(file["fluid"]["density"]) * g * float(body["displaced_volume"])
    buoyancy += hidden.get("net_buoyancy", {}).get("force", 0.0)
    center_of_buoyancy = np.array(body["center_of_buoyancy"], float)
    center_of_buoyancy = center_of_buoyancy + _triple(hidden.get("buoyancy_center", {}))
    weights = [[m * g, *place] for m, place, _ in masses] + [[-buoyancy, *center_of_buoyancy]]
    units = file["thrusters"]["units"]
    return Constants(
        M=M,
        weights=np.array(weights),
        linear=np.array(water["linear_damping"], float) + _six_parameters(hidden, "linear_damping"),
        quadratic=np.array(water["quadratic_damping"], float)
        + _six_parameters(hidden, "quadratic_damping"),
        cubic=_six_parameters(hidden, "cubic_damping"),
        coupled=_couplings(hidden.get("coupled_damping", {})),
        position=np.array([u["position"] for u in units], float),
        direction=np.array([u["direction"] for u in units], float),
        spin=np.array([u.get("spin", 0) for u in units], float),
    )


def _six_parameters(hidden: Hidden, effect: str) -> Array:
    """Return the parameters (6,) of an effect, one for each axis."""
    parameters = hidden.get(effect, {})
    return np.array([parameters.get(axis, 0.0) for axis in AXES])


def _triple(given: Mapping[str, float]) -> Array:
    """Return the parameters x, y, z (3,)."""
    return np.array([given.get(axis, 0.0) for axis in "xyz"])


def _pairs(given: Mapping[str, float]) -> Array:
    """Return the symmetric matrix (6, 6) of pairs of axes, such as `surge_pitch`."""
    M = np.zeros((6, 6))
    for name, value in given.items():
        i, j = (AXES.index(axis) for axis in name.split("_"))
        M[i, j] = M[j, i] = value
    return M


def _couplings(given: Mapping[str, float]) -> Array:
    """Return linear and quadratic damping (2, 6, 6) of ordered pairs of axes.

    They are called for example `yaw_from_sway` and `yaw_from_sway_quadratic`.
    """
    D = np.zeros((2, 6, 6))
    for name, value in given.items():
        row, column = name.removesuffix("_quadratic").split("_from_")
        D[int(name.endswith("_quadratic")), AXES.index(row), AXES.index(column)] = value
    return D
