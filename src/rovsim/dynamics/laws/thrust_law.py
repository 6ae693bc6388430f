"""A push that follows the thrust: one of the laws that a diagnosis may propose, its term as data.

The term is a coefficient, the axis it acts on, the thrust along an axis (a row of the allocation
matrix times the forces of the thrusters) or its absolute value, and perhaps one more factor: a
velocity, its absolute value, or the thrust along another axis.
"""

from rovsim.dynamics.compilation.compiled import inlined
from rovsim.dynamics.effects.base import Parameter, Wrench
from rovsim.dynamics.laws.codes import NO_FACTOR, SIZE

MAX_THRUSTERS = 12  # a vehicle with more has no such law
# Where a row of the allocation begins among the parameters.
FIRST_ROW, SECOND_ROW = 5, 5 + MAX_THRUSTERS
# Code of a second thrust as the further factor; below, velocities and their sizes.
SECOND_THRUST = 12


@inlined
def along(force, p, first):
    """Thrust along an axis, N or N m: p[first:], a row of the allocation, times the forces."""
    thrust = 0.0
    for i in range(min(force.size, MAX_THRUSTERS)):
        thrust += p[first + i] * force[i]
    return thrust


class ThrustLaw(Wrench):
    """The thrust along one axis pushes along another, or with the motion."""

    id = "thrust_law"
    listed = False
    requires = "thrusters"
    equation = r"\tau_i = c\,|T_j|\,\nu_k"
    neglects = "what differs between thrusters"
    source = "definition"
    parameters = (
        Parameter("c", "1", "c", scale=1.0),
        *(
            Parameter(name, "1", name, default=float(NO_FACTOR), scale=1.0, fitted=False)
            for name in ("size", "on", "unsigned", "factor")
        ),
        *(Parameter(f"b{i}", "1", "b", scale=1.0, fitted=False) for i in range(MAX_THRUSTERS)),
        *(Parameter(f"d{i}", "1", "d", scale=1.0, fitted=False) for i in range(MAX_THRUSTERS)),
    )

    @staticmethod
    def wrench(at, p):
        """The term, along its axis."""
        force = at.actuators.force
        value, k = along(force, p, FIRST_ROW), int(p.factor)
        if p.unsigned > 0.0:
            value = abs(value)
        if k == SECOND_THRUST:
            value *= along(force, p, SECOND_ROW)
        elif k >= SIZE:
            value *= abs(at.nu_r[k - SIZE])
        elif k != NO_FACTOR:
            value *= at.nu_r[k]
        value *= p.c * p.size
        on = int(p.on)
        return (
            value if on == 0 else 0.0,
            value if on == 1 else 0.0,
            value if on == 2 else 0.0,
            value if on == 3 else 0.0,
            value if on == 4 else 0.0,
            value if on == 5 else 0.0,
        )
