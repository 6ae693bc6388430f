"""Physics that no effect of the catalogue describes, in the form of effects.

They are not listed: no model file can name them and no diagnosis can select them. The right answer
to them is that something is left unexplained.
"""

from math import cos, exp, floor, pi, sin, tanh

import numpy as np

from rovsim.benchmarks.blind.laws_of_thrusters import Backlash
from rovsim.core.rounding import rounded
from rovsim.dynamics.effects.base import Effect, Parameter, Wrench


class SquareWave(Wrench):
    """Something on board switches on and off: a pump, a gripper, a second thruster loop."""

    id = "square_wave"
    listed = False
    equation = r"X = \pm a \text{ every half period}"
    neglects = "how it switches"
    source = "definition"
    parameters = (
        Parameter("force", "N", "a", scale=3.0),
        Parameter("period", "s", "T", low=0.1, default=8.0, scale=1.0),
    )

    @staticmethod
    def wrench(at, p):
        """A sway force of alternating sign."""
        half = floor(2.0 * at.t / p.period)
        return 0.0, p.force * (1.0 - 2.0 * (half % 2.0)), 0.0, 0.0, 0.0, 0.0


class Tone(Wrench):
    """A periodic force: sloshing, or a wave maker next door."""

    id = "tone"
    listed = False
    equation = r"X = a \sin 2\pi f t"
    neglects = "harmonics"
    source = "definition"
    parameters = (
        Parameter("force", "N", "a", scale=3.0),
        Parameter("frequency", "Hz", "f", low=0.0, default=0.4, scale=0.1),
    )

    @staticmethod
    def wrench(at, p):
        """Surge force and a yaw moment, a quarter period apart."""
        a = 2.0 * pi * p.frequency * at.t
        return p.force * sin(a), 0.0, 0.0, 0.0, 0.0, 0.05 * p.force * cos(a)


class Shedding(Wrench):
    """Vortices shed from the frame: a side force that grows with speed squared."""

    id = "shedding"
    listed = False
    equation = r"Y = c\,u^2 \sin 2\pi f t"
    neglects = "lock-in; the frequency's change with speed"
    source = "Blevins 1990, ch. 3"
    parameters = (
        Parameter("coefficient", "kg/m", "c", scale=150.0),
        Parameter("frequency", "Hz", "f", low=0.0, default=0.5, scale=0.1),
    )

    @staticmethod
    def wrench(at, p):
        """Sway force at the shedding frequency."""
        u = at.nu_r[0]
        side = p.coefficient * u * u * sin(2.0 * pi * p.frequency * at.t)
        return 0.0, side, 0.0, 0.0, 0.0, 0.0


class Squat(Wrench):
    """A hull of uneven height sucks itself down, whichever way it moves."""

    id = "squat"
    listed = False
    equation = r"Z = c\,(u^2 + v^2)"
    neglects = "the moment that comes with it"
    source = "Bernoulli's equation; Barrass 1979 on ships in shallow water"
    parameters = (Parameter("coefficient", "kg/m", "c", scale=40.0),)

    @staticmethod
    def wrench(at, p):
        """Heave force."""
        u, v = at.nu_r[0], at.nu_r[1]
        return 0.0, 0.0, p.coefficient * (u * u + v * v), 0.0, 0.0, 0.0


class LooseBallast(Wrench):
    """A weight that came loose: it lies at the lower end of its slot, whichever that is."""

    id = "loose_ballast"
    listed = False
    equation = r"r_b = s\,(\tanh(-\sin\theta / 0.05), \tanh(\cos\theta \sin\phi / 0.05), 0)"
    neglects = "the inertia of the weight, and the time that it slides"
    source = "definition"
    parameters = (
        Parameter("weight", "N", "W", scale=4.0),
        Parameter("travel", "m", "s", low=0.0, default=0.15, scale=0.03),
    )

    @staticmethod
    def wrench(at, p):
        """Moments of a weight that hangs at one end of the slot; its mean is trimmed out."""
        down = at.R[2]
        x, y = p.travel * tanh(20.0 * down[0]), p.travel * tanh(20.0 * down[1])
        K, M = y * down[2], -x * down[2]
        return 0.0, 0.0, 0.0, p.weight * K, p.weight * M, p.weight * (x * down[1] - y * down[0])


class Jet(Wrench):
    """The inlet of the tank: a stream along the y axis in one region of it."""

    id = "jet"
    listed = False
    equation = r"F = a\,e^{-((x - x_0)^2 + (y - y_0)^2)/2 s^2} \hat e"
    neglects = "that it depends on the vehicle's speed"
    source = "Gaussian profile of a round jet"
    parameters = (
        Parameter("force", "N", "a", scale=5.0),
        Parameter("x", "m", "x_0", default=5.0, scale=0.5),
        Parameter("y", "m", "y_0", default=2.5, scale=0.5),
        Parameter("width", "m", "s", low=0.05, default=0.4, scale=0.2),
    )

    @staticmethod
    def wrench(at, p):
        """A world-fixed horizontal force near one place."""
        north = at.position[0] - p.x * at.axes[0]
        east = at.position[1] - p.y * at.axes[1]
        F = p.force * exp(-(north * north + east * east) / (2.0 * p.width * p.width))
        return F * at.R[1][0], F * at.R[1][1], F * at.R[1][2], 0.0, 0.0, 0.0


class Kicks(Wrench):
    """Now and then something hits the vehicle: a swimmer, a snagged tether that comes free."""

    id = "kicks"
    listed = False
    equation = r"X = \pm a \text{ for } 0.3\,s \text{ now and then}"
    neglects = "everything but its size"
    source = "definition"
    parameters = (
        Parameter("force", "N", "a", scale=15.0),
        Parameter("period", "s", "T", low=1.0, default=7.0, scale=1.0),
    )

    @staticmethod
    def wrench(at, p):
        """A short push at an instant and in a direction that look random."""
        k = floor(at.t / p.period)
        chance = 0.5 + 0.5 * sin(12.9898 * k + 4.0)
        angle, begin = 78.233 * k, chance * (p.period - 0.3)
        here = at.t - k * p.period
        a = p.force if begin <= here < begin + 0.3 else 0.0
        return a * cos(angle), a * sin(angle), 0.0, 0.0, 0.0, 0.0


class Ingress(Wrench):
    """Water enters a compartment: the vehicle grows heavier all the time."""

    id = "ingress"
    listed = False
    equation = r"Z = a\,t / T_\text{run}"
    neglects = "the inertia of that water, and where it gathers"
    source = "definition"
    parameters = (Parameter("force", "N", "a", scale=6.0),)

    @staticmethod
    def wrench(at, p):
        """A weight that grows linearly from nothing."""
        F = p.force * at.t / at.duration
        return F * at.R[2][0], F * at.R[2][1], F * at.R[2][2], 0.0, 0.0, 0.0


class Compression(Wrench):
    """Foam that is squeezed at depth: buoyancy falls with depth."""

    id = "compression"
    listed = False
    equation = r"Z = k\,(z - 1.5\,m)"
    neglects = "creep of the foam"
    source = "Hooke's law"
    parameters = (Parameter("stiffness", "N/m", "k", scale=6.0),)

    @staticmethod
    def wrench(at, p):
        """A weight proportional to depth, zero at the depth it was trimmed at."""
        F = p.stiffness * (at.position[2] - at.tank[2][0] - 1.5)
        return F * at.R[2][0], F * at.R[2][1], F * at.R[2][2], 0.0, 0.0, 0.0


OUTSIDE_EFFECTS: dict[str, type[Effect]] = {
    cls.id: cls
    for cls in (
        SquareWave,
        Tone,
        Shedding,
        Squat,
        LooseBallast,
        Jet,
        Kicks,
        Ingress,
        Compression,
        Backlash,
    )
}
SIZE_RANGE = (0.7, 1.5)  # at strength 1, in scales of the first parameter


def drawn_outside(name: str, strength: float, random: np.random.Generator) -> Effect:
    """Draw physics outside the catalogue, its first parameter about `strength` times its scale."""
    return drawn(OUTSIDE_EFFECTS[name], strength, random)


def drawn(cls: type[Effect], strength: float, random: np.random.Generator) -> Effect:
    """Draw an effect: its first parameter is its size, the others vary about their defaults.

    Args:
        cls: class of the effect.
        strength: factor of the size.
        random: from which values are drawn.
    """
    first, *others = cls.parameters
    values = {first.name: float(random.uniform(*SIZE_RANGE)) * strength * first.scale}
    values |= {p.name: p.default + float(random.uniform(-1, 1)) * p.scale for p in others}
    return cls(**{k: rounded(v, 4) for k, v in values.items()})
