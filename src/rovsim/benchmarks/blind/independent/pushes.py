"""Forces on the hull: the catalogue's effects, stated once more.

Each is a function of one instant and returns a body wrench (6,) about CO, N and N m.
"""

from dataclasses import dataclass
from functools import partial
from typing import Callable, Mapping

import numpy as np
from numpy import ndarray as Array

from rovsim.benchmarks.blind.independent.vehicle import MOCAP_TO_NED, Constants, Hidden

Given = Mapping[str, float]
FRICTION_SPEED = 0.01  # m/s, rad/s: within it dry friction has its sign (docs/catalogue.md)
# 1 and kappa, m2, of fluid_memory (catalogue.md)
MEMORY_SCALE = np.array([1.0, 1.0, 1.0, 0.02, 0.02, 0.02])


@dataclass(frozen=True, eq=False)
class Instant:
    """Where the vehicle is, and how it moves through the water.

    Attributes:
        place: of CO (3,), m, NED.
        R: rotation matrix (3, 3) from body to world.
        v: velocity (6,) through the water, body axes, m/s and rad/s.
    """

    place: Array
    R: Array
    v: Array


ForceLaw = Callable[[Instant], Array]


def cross(a: Array, b: Array) -> Array:
    """Return a x b (3,); NumPy's takes ten times as long for one pair."""
    ax, ay, az = a.tolist()
    bx, by, bz = b.tolist()
    return np.array([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx])


def list_force_laws(own: Constants, hidden: Hidden, tank: Array) -> list[ForceLaw]:
    """List the forces of water and tether; `tank` (3, 2) is low and high, m, NED."""
    laws: list[ForceLaw] = [partial(drag, own, hidden, tank)]
    laws += [partial(law, hidden[name]) for name, law in LAWS.items() if name in hidden]
    if "tether_drag" in hidden:
        laws.append(partial(tow, hidden["tether_drag"], tank))
    return laws


def drag(own: Constants, hidden: Hidden, tank: Array, at: Instant) -> Array:
    """Return damping: diagonal, larger near walls and surface, and coupled and cubic."""
    speed = np.abs(at.v)
    diagonal = (own.linear + own.quadratic * speed) * _damping_factor(hidden, tank, at.place)
    wrench = -(diagonal + own.cubic * speed * speed) * at.v
    if "coupled_damping" in hidden:
        wrench = wrench - own.coupled[0] @ at.v - own.coupled[1] @ (speed * at.v)
    return wrench


def _damping_factor(hidden: Hidden, tank: Array, place: Array) -> float:
    """Return the factor of linear and quadratic damping near walls and surface."""
    factor = 1.0
    if "wall_proximity" in hidden:
        parameters = hidden["wall_proximity"]
        gaps = np.maximum(np.min(np.abs(tank[:2] - place[:2, None]), axis=1), 0.0)
        factor += parameters["gain"] * np.sum(np.exp(-gaps / parameters.get("length_scale", 0.5)))
    if "surface_proximity" in hidden:
        parameters = hidden["surface_proximity"]
        depth = max(place[2] - tank[2, 0], 0.0)
        factor += parameters["gain"] * np.exp(-depth / parameters.get("length_scale", 0.4))
    return float(factor)


def friction(given: Given, at: Instant) -> Array:
    """Return dry friction, -c tanh(v / FRICTION_SPEED) on each axis."""
    return -_axes(given) * np.tanh(at.v / FRICTION_SPEED)


def trim(given: Given, at: Instant) -> Array:
    """Return a constant body wrench."""
    return _axes(given)


def lift(given: Given, at: Instant) -> Array:
    """Return forces across a flow in surge, -c |u| v and -c |u| w."""
    c = given["coefficient"] * abs(at.v[0])
    return np.array([0.0, -c * at.v[1], -c * at.v[2], 0.0, 0.0, 0.0])


def pull(given: Given, at: Instant) -> Array:
    """Return the tension of an elastic tether, from its attachment towards its anchor."""
    attachment = _attachment(given)
    line = at.R.T @ (_anchor(given, np.zeros(3)) - at.place) - attachment
    length = float(np.sqrt(line @ line))
    stretch = max(0.0, length - given.get("slack_length", 0.0))
    return _wrench_at(given["stiffness"] * stretch * line / max(length, 1e-9), attachment)


def tow(given: Given, tank: Array, at: Instant) -> Array:
    """Return the drag of a wet tether in tow, which grows with the distance to its anchor."""
    middle = np.array([*tank[:2].mean(axis=1), tank[2, 0]])
    reach = _anchor(given, MOCAP_TO_NED * middle) - at.place
    v = at.v[:3]
    size = given["coefficient"] * np.sqrt(reach @ reach) * np.sqrt(v @ v)
    return _wrench_at(-size * v, _attachment(given))


LAWS: Mapping[str, Callable[[Given, Instant], Array]] = {
    "dry_friction": friction,
    "constant_wrench": trim,
    "lift": lift,
    "tether_tension": pull,
}


def _axes(given: Given) -> Array:
    """Return the parameters of an effect that has one for each axis (6,)."""
    names = ("surge", "sway", "heave", "roll", "pitch", "yaw")
    return np.array([given.get(name, 0.0) for name in names])


def _attachment(given: Given) -> Array:
    """Return where the tether is attached (3,), m, FRD."""
    default = {"x": -0.2, "y": 0.0, "z": 0.0}  # docs/catalogue.md
    return np.array([given.get(f"attachment_{k}", v) for k, v in default.items()])


def _anchor(given: Given, otherwise: Array) -> Array:
    """Return where the anchor is (3,), m, NED; parameters and `otherwise` are in MoCap axes."""
    anchor = [given.get(f"anchor_{k}", v) for k, v in zip("xyz", otherwise, strict=True)]
    return MOCAP_TO_NED * np.array(anchor)


def _wrench_at(force: Array, place: Array) -> Array:
    """Return the wrench (6,) of a force at a place of the body."""
    return np.concatenate([force, cross(place, force)])
