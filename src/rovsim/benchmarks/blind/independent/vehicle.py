"""The vehicle's constants from its file, and the hidden effects that change them."""

from dataclasses import dataclass
from typing import Any, Mapping

import numpy as np
from numpy import ndarray as Array

from rovsim import AXES

Hidden = Mapping[str, Mapping[str, float]]  # parameters given by effect

UPSIDE = np.array([1.0, -1.0, -1.0])  # MoCap axes z up, and NED


@dataclass(frozen=True, eq=False)
class Constants:
    """What does not change during a run; SI, FRD at CO, axes surge … yaw.

    `M` (6, 6) inertia with that of the water; `weights` (w, 4): newtons down and where they hang,
    buoyancy negative; `linear`, `quadratic`, `cubic` (6,), `coupled` (2, 6, 6) damping, the row
    pushed by the column; `position`, `direction` (n, 3), `spin` (n,) of the thrusters.
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
    """The matrix of a cross product, r x."""
    x, y, z = r.tolist()
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def kinetic(mass: float, place: Array, inertia: Array) -> Array:
    """Inertia (6, 6) of a body from its kinetic energy: of its centre, and about it."""
    of_centre = np.hstack([np.eye(3), -skew(place)])
    M = mass * of_centre.T @ of_centre
    M[3:, 3:] += inertia
    return M


def read_constants(file: Mapping[str, Any], hidden: Hidden) -> Constants:
    """Constants of a vehicle file with what is hidden in them."""
    body, water, g = file["rigid_body"], file["hydrodynamics"], float(file["fluid"]["gravity"])
    inertia = np.diag([float(body["inertia"][name]) for name in ("Ixx", "Iyy", "Izz")])
    masses = [(float(body["mass"]), np.array(body["center_of_gravity"], float), inertia)]
    load = hidden.get("payload", {})
    masses.append((load.get("mass", 0.0), _triple(load), np.zeros((3, 3))))
    M = sum(kinetic(*part) for part in masses) + np.diag(np.array(water["added_mass"], float))
    M += np.diag(_six(hidden, "added_mass")) + _pairs(hidden.get("added_mass_coupling", {}))
    buoyancy = float(file["fluid"]["density"]) * g * float(body["displaced_volume"])
    buoyancy += hidden.get("net_buoyancy", {}).get("force", 0.0)
    center_of_buoyancy = np.array(body["center_of_buoyancy"], float)
    center_of_buoyancy = center_of_buoyancy + _triple(hidden.get("buoyancy_center", {}))
    weights = [[m * g, *place] for m, place, _ in masses] + [[-buoyancy, *center_of_buoyancy]]
    units = file["thrusters"]["units"]
    return Constants(
        M=M,
        weights=np.array(weights),
        linear=np.array(water["linear_damping"], float) + _six(hidden, "linear_damping"),
        quadratic=np.array(water["quadratic_damping"], float) + _six(hidden, "quadratic_damping"),
        cubic=_six(hidden, "cubic_damping"),
        coupled=_couplings(hidden.get("coupled_damping", {})),
        position=np.array([u["position"] for u in units], float),
        direction=np.array([u["direction"] for u in units], float),
        spin=np.array([u.get("spin", 0) for u in units], float),
    )


def _six(hidden: Hidden, effect: str) -> Array:
    parameters = hidden.get(effect, {})
    return np.array([parameters.get(axis, 0.0) for axis in AXES])


def _triple(given: Mapping[str, float]) -> Array:
    return np.array([given.get(axis, 0.0) for axis in "xyz"])


def _pairs(given: Mapping[str, float]) -> Array:
    """A symmetric matrix (6, 6) of named pairs, `surge_pitch`."""
    M = np.zeros((6, 6))
    for name, value in given.items():
        i, j = (AXES.index(axis) for axis in name.split("_"))
        M[i, j] = M[j, i] = value
    return M


def _couplings(given: Mapping[str, float]) -> Array:
    """Damping (2, 6, 6) of named ordered pairs, `yaw_from_sway`, `yaw_from_sway_quadratic`."""
    D = np.zeros((2, 6, 6))
    for name, value in given.items():
        row, column = name.removesuffix("_quadratic").split("_from_")
        D[int(name.endswith("_quadratic")), AXES.index(row), AXES.index(column)] = value
    return D
