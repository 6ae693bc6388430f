"""Write for Gazebo: a world in SDF with gz-sim's plugins Hydrodynamics, Buoyancy and Thruster.

The world is that of a motion capture with z up: x, y, z = north, -east, -down; the body's axes are
x forward, y to port, z up. A force along or a moment about y or z changes its sign, and so does a
coefficient that couples an axis that turns with one that does not.

Added mass is `<fluid_added_mass>` of the link, which the physics engine (DART) puts into the
inertia, so its Coriolis terms follow; the plugin's own `xDotU` … are left out, whose Coriolis terms
have other signs in different versions.
"""

from collections import defaultdict
from typing import Mapping, Sequence
from xml.etree import ElementTree as ET

import numpy as np
from numpy import ndarray as Array

from rovsim.application.export.equation import Equation, RigidInertia
from rovsim.application.export.holding import (
    DAMPING_EFFECTS,
    INERTIA_EFFECTS,
    RIGID_EFFECTS,
    STATIC_THRUST_EFFECTS,
    OmittedPart,
    fixed,
    nothing,
    whole,
)
from rovsim.application.export.xml import comment, document, force_tables, number, numbers
from rovsim.core.rotations import matrix
from rovsim.dynamics.body import inertia_at
from rovsim.dynamics.effects.base import Effect
from rovsim.dynamics.effects.current import Current
from rovsim.dynamics.model import Model
from rovsim.dynamics.vehicle.cross_flow import CrossFlow, parse_product
from rovsim.dynamics.vehicle.thrusters import Thrusters

TITLE = "Gazebo (gz-sim)"
SUFFIX = ".sdf"
SOURCE = (
    "gz-sim, systems Hydrodynamics, Buoyancy and Thruster; SDFormat 1.11, fluid_added_mass: "
    "Gazebo Harmonic and later, with DART"
)
TAKES = "Thrusters take newtons, on the topics /model/NAME/joint/THRUSTER/cmd_thrust."

WHOLE_EFFECTS = {
    *RIGID_EFFECTS,
    *DAMPING_EFFECTS,
    *INERTIA_EFFECTS,
    *STATIC_THRUST_EFFECTS,
    "lift",
    "current",
}
AXIS_SIGNS = np.array([1.0, -1.0, -1.0, 1.0, -1.0, -1.0])  # FRD to FLU, NED to z up
FORCE_AXES, SPEED_AXES = "xyzkmn", "UVWPQR"  # SNAME, as the plugin writes them
MASS_AXES = "xyzpqr"  # as SDFormat writes rows and columns of the added mass
# share of the mass in each propeller: a joint needs a link, and a link a mass
PROPELLER_MASS_SHARE = 1e-4
PROPELLER_RADIUS_M = 0.03  # of gyration of that link: a propeller's size


def hold(effect: Effect) -> tuple[Effect, str]:
    """Return what Gazebo can hold of an effect, and why not the rest."""
    if isinstance(effect, Thrusters):
        return fixed(effect)
    if isinstance(effect, CrossFlow):
        return _split(effect)
    return whole(effect) if effect.id in WHOLE_EFFECTS else nothing(effect)


def further(model: Model) -> Sequence[OmittedPart]:
    """Return what a current does to added mass: the plugin applies a current to damping only."""
    if not model.body.current.any():
        return []
    water = next(e for e in model.effects if isinstance(e, Current) and e.given())
    reason = "it acts on the damping; added mass moves as in still water"
    return [OmittedPart(f"{water.id} on added mass", reason, model, model, still_added_mass)]


def still_added_mass(model: Model, state: Array) -> Array:
    """Compute the wrench on added mass in moving water minus that in still water.

    Args:
        model: with a current.
        state: (n, 13) position NED m, unit quaternion, body velocities FRD.

    Returns:
        (n, 6) N and N m, FRD.
    """
    R, nu = matrix(state[:, 3:7]), state[:, 7:]
    current = np.einsum("nji,j->ni", R, model.body.current)
    nu_r = nu - np.hstack([current, np.zeros_like(current)])
    rate = np.hstack([np.cross(current, nu[:, 3:]), np.zeros_like(current)])
    M_A = model.body.M_A
    return rate @ M_A.T - (_coriolis(M_A, nu_r) - _coriolis(M_A, nu))


def _coriolis(M: Array, nu: Array) -> Array:
    """C(nu) nu (n, 6) of velocities (n, 6) (Fossen 2021, eq. 6.43)."""
    h = nu @ M.T
    force = np.cross(nu[:, 3:], h[:, :3])
    moment = np.cross(nu[:, :3], h[:, :3]) + np.cross(nu[:, 3:], h[:, 3:])
    return np.hstack([force, moment])


def _split(flow: CrossFlow) -> tuple[Effect, str]:
    """Keep the products of velocities that the plugin has a name for; say which are lost."""
    products = {name: c for name, c in flow.products.items() if _element(name) is not None}
    unnamed = [name for name in flow.products if name not in products]
    return CrossFlow(products), f"no name for {', '.join(unnamed)}" if unnamed else ""


def _element(name: str) -> tuple[str, float] | None:
    """Return the plugin's element for a product of velocities, and the sign of its coefficient.

    The sign is that from FRD to Gazebo's axes. None where the plugin has no such element.
    """
    axis, *factors = parse_product(name)
    factors = [f for f in factors if f >= 0]
    if len(factors) != 2:
        return None
    first, second = sorted(factors)  # absolute values (6 and more) come last
    if first >= 6 and first != second:
        return None
    sizes = first < 6 <= second
    i, j = first % 6, second % 6
    # |v| keeps its sign between the axes; v |v| changes it as v does, and |v| |v| does not
    sign = AXIS_SIGNS[axis] * AXIS_SIGNS[i] * (1.0 if sizes else AXIS_SIGNS[j])
    return f"{FORCE_AXES[axis]}{SPEED_AXES[i]}{'abs' if sizes else ''}{SPEED_AXES[j]}", float(sign)


def text(equation: Equation, notes: Sequence[str]) -> str:
    """Return the text of a world with the vehicle in it."""
    sdf = ET.Element("sdf", version="1.11")
    comment(sdf, [*notes, *force_tables(equation)])
    world = ET.SubElement(sdf, "world", name="water")
    _tree(world, {"gravity": numbers([0.0, 0.0, -equation.body.gravity])})
    for system in ("Physics", "UserCommands", "SceneBroadcaster"):
        _plugin(world, system)
    density = number(equation.model.vehicle.density)
    _plugin(world, "Buoyancy", {"uniform_fluid_density": density})
    world.append(_vehicle(equation))
    return document(sdf)


def _vehicle(equation: Equation) -> ET.Element:
    vehicle = ET.Element("model", name=equation.model.name)
    inertia = np.array(equation.body.M_RB)
    units = equation.model.vehicle.thrusters.units
    share = PROPELLER_MASS_SHARE * equation.rigid.mass
    propeller = share * PROPELLER_RADIUS_M**2 * np.eye(3)
    for unit in units:
        inertia -= inertia_at(share, np.array(unit.position), propeller)
    base = ET.SubElement(vehicle, "link", name="base_link")
    base.append(_inertial(RigidInertia.of(inertia), equation.body.M_A))
    for kind in ("collision", "visual"):
        shape = _displaced(equation, kind)
        if shape is not None:
            base.append(shape)
    for unit in units:
        link = ET.SubElement(vehicle, "link", name=f"{unit.name}_propeller")
        _tree(link, {"pose": numbers([*_turned(unit.position), 0, 0, 0])})
        link.append(_inertial(RigidInertia(share, np.zeros(3), propeller)))
        joint = ET.SubElement(vehicle, "joint", name=unit.name, type="revolute")
        _tree(joint, {"parent": "base_link", "child": f"{unit.name}_propeller"})
        _tree(ET.SubElement(joint, "axis"), {"xyz": numbers(_turned(unit.direction))})
    _plugin(vehicle, "Hydrodynamics", {"link_name": "base_link", **_water(equation)})
    for unit, force in zip(units, equation.most, strict=True):
        _plugin(
            vehicle,
            "Thruster",
            {
                "namespace": equation.model.name,
                "joint_name": unit.name,
                "propeller_diameter": number(unit.diameter or 2.0 * PROPELLER_RADIUS_M),
                "velocity_control": "true",
                "max_thrust_cmd": number(force),
                "min_thrust_cmd": number(-force),
            },
        )
    return vehicle


def _inertial(rigid: RigidInertia, added: Array | None = None) -> ET.Element:
    """Make the element `inertial`: mass, centre of gravity and inertia, in Gazebo's axes.

    Products of inertia have the sign that they have in the matrix (SDFormat).

    Args:
        rigid: in FRD.
        added: added mass (6, 6) in FRD, if any.
    """
    turn = AXIS_SIGNS[:3]
    moments = turn[:, None] * rigid.inertia * turn
    part = ET.Element("inertial")
    _tree(part, {"mass": number(rigid.mass), "pose": numbers([*_turned(rigid.center), 0, 0, 0])})
    pairs = [(i, j) for i in range(3) for j in range(i, 3)]
    names = {f"i{'xyz'[i]}{'xyz'[j]}": number(moments[i, j]) for i, j in pairs}
    _tree(ET.SubElement(part, "inertia"), names)
    if added is not None:
        added_mass = AXIS_SIGNS[:, None] * added * AXIS_SIGNS
        rows = [(i, j) for i in range(6) for j in range(i, 6)]
        water = {f"{MASS_AXES[i]}{MASS_AXES[j]}": number(added_mass[i, j]) for i, j in rows}
        _tree(ET.SubElement(part, "fluid_added_mass"), water)
    return part


def _displaced(equation: Equation, kind: str) -> ET.Element | None:
    """Make a cube of the displaced volume at the centre of buoyancy: all that the plugin reads.

    None where the model has no buoyancy.
    """
    body, density = equation.body, equation.model.vehicle.density
    volume = body.buoyancy / (density * body.gravity)
    if volume <= 0.0:
        return None
    part = ET.Element(kind, name="displaced")
    _tree(part, {"pose": numbers([*_turned(body.center_of_buoyancy), 0, 0, 0])})
    box = ET.SubElement(ET.SubElement(part, "geometry"), "box")
    _tree(box, {"size": numbers([np.cbrt(volume)] * 3)})
    return part


def _water(equation: Equation) -> dict[str, str]:
    """Return the elements of the plugin Hydrodynamics; damping is negative there (SNAME)."""
    elements: defaultdict[str, float] = defaultdict(float)  # damping and a product may share one
    for size, D in ((False, equation.linear), (True, equation.quadratic)):
        for i, j in zip(*np.nonzero(D), strict=True):
            name = f"{FORCE_AXES[i]}{SPEED_AXES[j]}" + (f"abs{SPEED_AXES[j]}" if size else "")
            elements[name] -= AXIS_SIGNS[i] * AXIS_SIGNS[j] * D[i, j]
    for product, c in equation.products.items():
        element = _element(product)
        assert element is not None  # `_split` left out the others
        elements[element[0]] += element[1] * c
    current = equation.body.current
    current_element = {"default_current": numbers(_turned(current))} if current.any() else {}
    return {name: number(value) for name, value in elements.items()} | current_element


def _plugin(parent: ET.Element, system: str, content: Mapping[str, str] | None = None) -> None:
    kebab_case = "".join(f"-{c.lower()}" if c.isupper() else c for c in system).lstrip("-")
    names = {"filename": f"gz-sim-{kebab_case}-system", "name": f"gz::sim::systems::{system}"}
    _tree(ET.SubElement(parent, "plugin", names), content or {})


def _tree(parent: ET.Element, content: Mapping[str, str]) -> None:
    for name, value in content.items():
        ET.SubElement(parent, name).text = value


def _turned(place: Sequence[float] | Array) -> Array:
    """Turn a position or direction (3,) from FRD or NED into Gazebo's axes."""
    return np.asarray(place, dtype=float) * AXIS_SIGNS[:3]
