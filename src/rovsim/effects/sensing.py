"""How the motion capture sees the vehicle: what it calls the body, and what it calls level."""

import numpy as np

from rovsim.effects.base import Parameter, Sensing
from rovsim.frames import Rigid


class MarkerOffset(Sensing):
    """The rigid body was defined about a point that is not CO."""

    id = "marker_offset"
    equation = r"p_\text{measured} = p_{CO} + R\,r"
    neglects = "markers that move on the vehicle"
    source = "definition"
    parameters = tuple(Parameter(axis, "m", f"r_{axis}", scale=0.05) for axis in "xyz")

    def transforms(self) -> tuple[Rigid, Rigid]:
        """A shift of the body's origin."""
        return Rigid.by(), Rigid.by(shift=self.values)


class MarkerMisalignment(Sensing):
    """The rigid body was defined with axes that are not the vehicle's."""

    id = "marker_misalignment"
    rank = 1  # the offset is along the vehicle's own axes
    equation = r"R_\text{measured} = R\,\exp([\theta]_\times)"
    neglects = "markers that move on the vehicle"
    source = "definition"
    parameters = tuple(
        Parameter(axis, "rad", rf"\theta_{axis}", low=-np.pi, high=np.pi, scale=0.03)
        for axis in ("roll", "pitch", "yaw")
    )

    def transforms(self) -> tuple[Rigid, Rigid]:
        """A turn of the body's axes by a rotation vector."""
        return Rigid.by(), Rigid.by(turn=self.values)


class WorldTilt(Sensing):
    """The room was calibrated with an L-frame that did not stand level."""

    id = "world_tilt"
    equation = r"p, R \text{ measured} = \exp([\theta]_\times) \cdot \text{true, in NED}"
    neglects = "the tilt of the tank's walls and of anchors: these are taken as level"
    source = "definition"
    parameters = tuple(
        Parameter(axis, "rad", rf"\theta_{axis}", low=-np.pi, high=np.pi, scale=0.02)
        for axis in ("roll", "pitch")
    )

    def transforms(self) -> tuple[Rigid, Rigid]:
        """A turn of the world about its origin."""
        return Rigid.by(turn=np.append(self.values, 0.0)), Rigid.by()
