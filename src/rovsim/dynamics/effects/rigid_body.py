"""Mass and weight: the dry vehicle, and what was bolted to it."""

import numpy as np

from rovsim.dynamics.body import Body
from rovsim.dynamics.effects.base import Coefficients, Parameter
from rovsim.dynamics.effects.parameters import Signature

PLACE = tuple(Parameter(axis, "m", axis, scale=0.1) for axis in "xyz")


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
        *PLACE,
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


class Payload(Coefficients):
    """A point mass without volume, carried along."""

    id = "payload"
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
    parameters = (Parameter("mass", "kg", "m", low=0.0, scale=0.5), *PLACE)
    # without a mass its place means nothing; so: at CO, and at the ends of a frame 0.4 m long
    starts = (
        {"mass": 0.3},
        *({"mass": 0.3, axis: place} for axis in "xyz" for place in (-0.15, 0.15)),
    )

    def enter(self, body: Body) -> None:
        """Add the point mass and its weight."""
        body.add_mass(self["mass"], self.values[1:], np.zeros((3, 3)))
