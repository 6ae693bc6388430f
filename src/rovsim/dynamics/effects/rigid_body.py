"""Mass and weight: the dry vehicle, and what was bolted to it."""

from functools import cache

import numpy as np

from rovsim.dynamics.body import Body
from rovsim.dynamics.effects.base import (
    REFERENCE_MASS,
    Actuated,
    Coefficients,
    Effect,
    Parameter,
    Signature,
)

# Where the fit of a payload begins on a BlueROV2 Heavy: kg, m from its middle.
START_MASS, START_OFFSET = 0.3, 0.15
POSITION_PARAMETERS = tuple(Parameter(axis, "m", axis, scale=0.1) for axis in "xyz")


class RigidBody(Coefficients):
    """The dry vehicle: mass, inertia about its centre of gravity, and weight."""

    id = "rigid_body"
    listed = False
    equation = r"M_{RB}\dot\nu + C_{RB}(\nu)\nu"
    neglects = "nothing of a rigid body"
    source = "Fossen 2021, sec. 3.3"
    parameters = (
        Parameter("mass", "kg", "m", low=0.0, scale=1.0),
        *(
            Parameter(name, "kg m2", f"I_{name[1:]}", low=0.0, scale=0.05)
            for name in ("Ixx", "Iyy", "Izz")
        ),
        *POSITION_PARAMETERS,
        *(
            Parameter(name, "kg m2", f"I_{{{name[1:]}}}", scale=0.05)
            for name in ("Ixy", "Ixz", "Iyz")
        ),
    )

    def enter(self, body: Body) -> None:
        """Add mass, inertia and weight at the centre of gravity (Fossen 2021, eq. 3.25)."""
        mass, *moments = self.values[:4]
        xy, xz, yz = self.values[7:]
        products = np.array([[0.0, xy, xz], [xy, 0.0, yz], [xz, yz, 0.0]])
        body.add_mass(mass, self.values[4:7], np.diag(moments) - products)


def _places(mass: float, reach: float) -> tuple[dict[str, float], ...]:
    """Starts of a payload's fit: at CO, and `reach` m away along each axis.

    The place is not identifiable at zero mass, so that fits do not begin there.
    """
    offsets = ({axis: position} for axis in "xyz" for position in (-reach, reach))
    return tuple({"mass": mass} | position for position in ({}, *offsets))


class Payload(Coefficients):
    """A point mass without volume, carried along."""

    id = "payload"
    differs_between_runs = True
    equation = r"M_{RB} \to M_{RB} + m H^\top(r) H(r),\quad \text{weight } m g \text{ at } r"
    symbols = (
        ("M_{RB}", "matrix of mass and inertia"),
        ("H", "matrix that moves a velocity from CO to r"),
        ("r", "place x, y, z"),
        ("g", "gravity"),
    )
    neglects = "its displaced water and its drag"
    source = "Fossen 2021, sec. 3.3 (parallel-axis theorem)"
    cause = (
        "Something is carried that the vehicle file does not know: a gripper, a camera, a lead "
        "weight."
    )
    revealed_by = (
        "Let it sink without thrust, then step surge and yaw hard from rest: a payload weighs it "
        "down and also slows every start, lost buoyancy only weighs it down."
    )
    signature = Signature({"mass": 1.0, "x": 0.1, "z": 0.15}, "pitch", "pitch angle")
    parameters = (Parameter("mass", "kg", "m", low=0.0, scale=0.5), *POSITION_PARAMETERS)
    starts = _places(START_MASS, START_OFFSET)

    @classmethod
    def on(cls, vehicle: Actuated) -> type[Effect]:
        """With starts that suit the size of the vehicle."""
        return _on_a_vehicle_of(vehicle.dry_mass)

    def enter(self, body: Body) -> None:
        """Add the point mass and its weight."""
        body.add_mass(self["mass"], self.values[1:], np.zeros((3, 3)))


@cache
def _on_a_vehicle_of(mass: float) -> type[Payload]:
    """With the starts of a BlueROV2 Heavy scaled to a vehicle of this mass, kg."""
    size = mass / REFERENCE_MASS
    return Payload.adapted(starts=_places(START_MASS * size, START_OFFSET * size ** (1.0 / 3.0)))
