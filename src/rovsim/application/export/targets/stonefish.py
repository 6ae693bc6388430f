"""Write for Stonefish: a scenario in XML with one robot, in NED and FRD as in rovsim.

Stonefish computes drag and added mass from the shape of a body and takes no coefficients for them.
Mass, inertia, weight, buoyancy and thrust are written; a box stands for the shape, which users
should replace by a mesh. Gravity is always 9.81 m/s2 there: the displaced volume and its centre are
chosen such that weight minus buoyancy, and their moment, are still those of the model.
"""

from typing import Sequence
from xml.etree import ElementTree as ET

import numpy as np
from numpy import ndarray as Array

from rovsim.application.export.equation import Equation
from rovsim.application.export.holding import (
    DAMPING_EFFECTS,
    INERTIA_EFFECTS,
    RIGID_EFFECTS,
    STATIC_THRUST_EFFECTS,
    fixed,
    nothing,
    whole,
)
from rovsim.application.export.xml import comment, document, force_tables, number, numbers
from rovsim.core.rotations import from_matrix, to_euler
from rovsim.dynamics.effects.base import Effect
from rovsim.dynamics.vehicle.thrusters import Thrusters

TITLE = "Stonefish"
SUFFIX = ".scn"
SOURCE = "Stonefish 1.x, documentation of scenarios, dynamic bodies, robots and actuators"
TAKES = "Thrusters are `push` actuators and take newtons."

WHOLE_EFFECTS = {*RIGID_EFFECTS, *STATIC_THRUST_EFFECTS, "current"}
BODY_SHAPE_EFFECTS = {*DAMPING_EFFECTS, *INERTIA_EFFECTS, "cross_flow", "lift", "cubic_damping"}
GRAVITY = 9.81  # m/s2, of every scenario (its SimulationManager)
START_DEPTH_M = 2.0  # under water


def hold(effect: Effect) -> tuple[Effect, str]:
    """Return what Stonefish can hold of an effect, and why not the rest."""
    if isinstance(effect, Thrusters):
        return fixed(effect)
    if effect.id in WHOLE_EFFECTS:
        return whole(effect)
    neutral, reason = nothing(effect)
    return (
        neutral,
        "it computes its own from the shape of the body"
        if effect.id in BODY_SHAPE_EFFECTS
        else reason,
    )


def text(equation: Equation, notes: Sequence[str]) -> str:
    """Return the text of a scenario with the vehicle in it."""
    scenario = ET.Element("scenario")
    comment(scenario, [*notes, *force_tables(equation)])
    environment = _tag(scenario, "environment")
    _tag(environment, "ned", latitude="0.0", longitude="0.0")
    ocean = _tag(environment, "ocean")
    _tag(ocean, "water", density=number(equation.model.vehicle.density), jerlov="0.2")
    _tag(ocean, "waves", height="0.0")
    if equation.body.current.any():
        current = _tag(ocean, "current", type="uniform")
        _tag(current, "velocity", xyz=numbers(equation.body.current))
    _tag(_tag(environment, "atmosphere"), "sun", azimuth="20.0", elevation="50.0")
    _surroundings(scenario)
    _robot(scenario, equation)
    return document(scenario)


def _surroundings(scenario: ET.Element) -> None:
    """Add a material and a look, which every scenario needs; neither changes the motion."""
    materials = _tag(scenario, "materials")
    _tag(materials, "material", name="Hull", density="1000.0", restitution="0.5")
    friction = {"material1": "Hull", "material2": "Hull", "static": "0.5", "dynamic": "0.3"}
    _tag(_tag(materials, "friction_table"), "friction", **friction)
    _tag(_tag(scenario, "looks"), "look", name="Yellow", rgb="1.0 0.9 0.0", roughness="0.3")


def _robot(scenario: ET.Element, equation: Equation) -> None:
    attributes = {"name": equation.model.name, "fixed": "false", "self_collisions": "false"}
    robot = _tag(scenario, "robot", **attributes)
    shape = {"name": "Vehicle", "type": "box", "physics": "submerged", "buoyant": "true"}
    base = _tag(robot, "base_link", **shape)
    volume, center = _displaced(equation)
    _tag(base, "dimensions", xyz=numbers([np.cbrt(volume)] * 3))
    _tag(base, "origin", xyz=numbers(center), rpy="0.0 0.0 0.0")
    _tag(base, "material", name="Hull")
    _tag(base, "look", name="Yellow")
    moments, rpy = _principal(equation.rigid.inertia)
    _tag(base, "mass", value=number(equation.rigid.mass))
    _tag(base, "inertia", xyz=numbers(moments))
    _tag(base, "cg", xyz=numbers(equation.rigid.center), rpy=numbers(rpy))
    for unit, force in zip(equation.model.vehicle.thrusters.units, equation.most, strict=True):
        push = _tag(robot, "actuator", name=unit.name, type="push")
        limits = {"lower_limit": number(-force), "upper_limit": number(force), "inverted": "false"}
        _tag(push, "specs", **limits)
        _tag(push, "origin", xyz=numbers(unit.position), rpy=numbers(_along(unit.direction)))
        _tag(push, "link", name="Vehicle")
    _tag(robot, "world_transform", xyz=numbers([0.0, 0.0, START_DEPTH_M]), rpy="0.0 0.0 0.0")


def _displaced(equation: Equation) -> tuple[float, Array]:
    """Choose the displaced volume, m3, and its centre (3,), m, FRD, for Stonefish's gravity.

    With these, weight minus buoyancy and their moment are those of the model.
    """
    body, weight = equation.body, equation.rigid.mass * GRAVITY
    buoyancy = weight - (body.weight - body.buoyancy)
    righting = body.weight_moment - body.buoyancy * body.center_of_buoyancy
    center = (weight * equation.rigid.center - righting) / buoyancy
    return buoyancy / (equation.model.vehicle.density * GRAVITY), center


def _principal(inertia: Array) -> tuple[Array, Array]:
    """Diagonalise an inertia (3, 3), kg m2, about the centre of gravity.

    Returns:
        Principal moments (3,), kg m2, and roll, pitch and yaw (3,) of the principal axes, rad.
    """
    if not np.any(inertia - np.diag(np.diag(inertia))):
        return np.diag(inertia), np.zeros(3)
    moments, axes = np.linalg.eigh(inertia)
    axes = axes * [1.0, 1.0, np.sign(np.linalg.det(axes))]  # right-handed
    return moments, to_euler(from_matrix(axes[None]))[0]


def _along(direction: Sequence[float]) -> tuple[float, float, float]:
    """Return roll, pitch and yaw, rad, of a frame whose x axis points along a direction (3,)."""
    x, y, z = direction
    return 0.0, float(-np.arctan2(z, np.hypot(x, y))), float(np.arctan2(y, x))


def _tag(parent: ET.Element, kind: str, /, **attributes: str) -> ET.Element:
    return ET.SubElement(parent, kind, attributes)
