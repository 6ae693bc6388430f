"""Wrong frames of the motion capture: body origin, body axes, and a world that is not level."""

import numpy as np

from rovsim.core.rotations import Rigid
from rovsim.dynamics.effects.base import FrameMisalignment, Parameter, Signature


class MarkerOffset(FrameMisalignment):
    """The rigid body was defined about a point that is not CO."""

    id = "marker_offset"
    differs_between_runs = True
    equation = r"p_\text{measured} = p_{CO} + R\,r"
    symbols = (
        (r"p_\text{measured}", "measured position"),
        ("p_{CO}", "position of CO"),
        ("r", "offset x, y, z"),
    )
    neglects = "markers that move on the vehicle"
    source = "definition"
    cause = "The rigid body was defined about another point, usually the middle of its markers."
    revealed_by = (
        "Turn on the spot about each axis at two rates: an offset makes the reported point go "
        "round a circle of the same radius at either rate, a coupling of drag or mass does not."
    )
    signature = Signature({"x": 0.1}, "surge", "yaw rate")
    parameters = tuple(Parameter(axis, "m", f"r_{axis}", scale=0.05) for axis in "xyz")

    def transforms(self) -> tuple[Rigid, Rigid]:
        """A shift of the body's origin."""
        return Rigid.by(), Rigid.by(shift=self.values)


class MarkerMisalignment(FrameMisalignment):
    """The rigid body was defined with axes that are not the vehicle's."""

    id = "marker_misalignment"
    differs_between_runs = True
    rank = 1  # the offset is along the vehicle's own axes
    equation = r"R_\text{measured} = R\,\exp([\theta]_\times)"
    symbols = (
        (r"R_\text{measured}", "measured attitude"),
        (r"[\theta]_\times", "cross product with the rotation vector roll, pitch, yaw"),
    )
    neglects = "markers that move on the vehicle"
    source = "definition"
    cause = "The vehicle was not parallel to the world axes when its rigid body was defined."
    revealed_by = (
        "Let it hang still at four headings, then drive straight ahead: the reported lean stays "
        "with the body and the course is off its nose by a constant angle, with a world tilt the "
        "lean changes with heading."
    )
    signature = Signature({"yaw": 0.2}, "sway", "surge thrust")
    parameters = tuple(
        Parameter(axis, "rad", rf"\theta_{{{axis}}}", low=-np.pi, high=np.pi, scale=0.03)
        for axis in ("roll", "pitch", "yaw")
    )

    def transforms(self) -> tuple[Rigid, Rigid]:
        """A turn of the body's axes by a rotation vector."""
        return Rigid.by(), Rigid.by(turn=self.values)


class WorldTilt(FrameMisalignment):
    """The room was calibrated with an L-frame that did not stand level."""

    id = "world_tilt"
    differs_between_runs = True
    equation = r"p, R \text{ measured} = \exp([\theta]_\times) \cdot \text{true, in NED}"
    symbols = (
        ("p", "position"),
        ("R", "attitude"),
        (r"[\theta]_\times", "cross product with the rotation vector roll, pitch"),
    )
    neglects = "the tilt of the tank's walls and of anchors: these are taken as level"
    source = "definition"
    cause = "The L-frame of the calibration did not stand level."
    revealed_by = (
        "Let it hang still at four headings without commands: the reported lean goes round with "
        "the heading if the world is tilted, and stays with the body if the markers or the centre "
        "of buoyancy are off."
    )
    signature = Signature({"roll": 0.05}, "roll", "heading")
    parameters = tuple(
        Parameter(axis, "rad", rf"\theta_{{{axis}}}", low=-np.pi, high=np.pi, scale=0.02)
        for axis in ("roll", "pitch")
    )

    def transforms(self) -> tuple[Rigid, Rigid]:
        """A turn of the world about its origin."""
        return Rigid.by(turn=np.append(self.values, 0.0)), Rigid.by()
