"""Damping that grows near a wall or the surface; no effect where the tank is not known."""

from math import exp

from rovsim.dynamics.compilation.compiled import inlined
from rovsim.dynamics.effects.base import Parameter, Signature, Wrench


@inlined
def nearness(distance, length):
    """exp(-d/l), with d clipped at 0; 0 where the distance is NaN (not known)."""
    return exp(-max(distance, 0.0) / length) if distance == distance else 0.0


@inlined
def times(factor, tau):
    """A wrench (6) times a factor."""
    return (
        factor * tau[0],
        factor * tau[1],
        factor * tau[2],
        factor * tau[3],
        factor * tau[4],
        factor * tau[5],
    )


def _length(default: float) -> Parameter:
    # at usual distances, the data fix the effect of gain and length together, hardly the length
    return Parameter(
        "length_scale", "m", "l", low=0.01, default=default, scale=0.2, fitted=False, shape=True
    )


class WallProximity(Wrench):
    """Water displaced near a wall has less room: all diagonal damping grows."""

    id = "wall_proximity"
    equation = r"d_i \to d_i\,(1 + g\,(e^{-d_x/l} + e^{-d_y/l}))"
    symbols = (
        ("d_i", "damping along axis i"),
        ("d_x", "distance to the nearer wall along x"),
        ("d_y", "distance to the nearer wall along y"),
    )
    neglects = "the floor, and forces towards or along the wall"
    source = "empirical: fades exponentially with the distance"
    cause = "The vehicle worked close to a wall, where the water it displaces has little room."
    revealed_by = (
        "Drive along two opposite walls at one steady speed, 0.2, 0.5 and 2 m away from them: a "
        "wall brakes on either side alike, a tether more on the side far from its anchor."
    )
    signature = Signature(
        {"gain": 8.0, "length_scale": 0.25}, "surge", "distance to the nearest wall", size=True
    )
    parameters = (Parameter("gain", "1", "g", low=0.0, scale=0.5), _length(0.5))
    starts = ({"gain": 0.3}, {"gain": 1.0})

    @staticmethod
    def wrench(at, p):
        """The additional damping by the nearer wall along x and along y."""
        near = 0.0
        for axis in range(2):
            low, high = at.tank[axis]
            place = at.position[axis]
            near += nearness(min(place - low, high - place), p.length_scale)
        return times(p.gain * near, at.drag)


class SurfaceProximity(Wrench):
    """Near the surface the vehicle makes waves: all diagonal damping grows."""

    id = "surface_proximity"
    equation = r"d_i \to d_i\,(1 + g\,e^{-d_z/l})"
    symbols = (
        ("d_i", "damping along axis i"),
        ("d_z", "distance to the surface"),
    )
    neglects = "suction, and waves that come back"
    source = "empirical: fades exponentially with the depth"
    cause = "The vehicle ran shallow and spent power on waves."
    revealed_by = (
        "Drive one course at one steady speed at depths of 0.2, 0.5 and 1.5 m, then hover at "
        "each: the surface brakes only what moves, buoyancy and a tether push a hovering vehicle "
        "too."
    )
    signature = Signature({"gain": 4.0}, "heave", "depth below the surface", size=True)
    parameters = (Parameter("gain", "1", "g", low=0.0, scale=0.5), _length(0.4))
    starts = ({"gain": 0.3}, {"gain": 1.0})

    @staticmethod
    def wrench(at, p):
        """The additional damping by the surface."""
        depth = at.position[2] - at.tank[2][0]
        return times(p.gain * nearness(depth, p.length_scale), at.drag)
