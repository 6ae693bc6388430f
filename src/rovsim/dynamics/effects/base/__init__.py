"""What an effect is: one declaration that simulates, fits, is reported and documented.

An effect is a subclass of one of the classes below, which says on what it acts, and implements the
method of that class. Effects are immutable, and a model is a list of them.

    base class         acts on                               method
    Coefficients       the constants of Fossen's equation    enter(body)
    Wrench             the forces at one instant (compiled)  wrench(at, p) -> 6 numbers
    StochasticCurrent  the water, at random                  draw(ticks, dt, random) -> current
    CommandTiming      when a logged command takes effect    effective_time(time) -> time
    DemandTransform    the demand before the mixer           mixer_demand(demand) -> demand
    Autopilot          demands in place of the mixer         mixer_demand(demand) -> demand;
                                                             demanded_wrench(...) -> wrench
    CommandTransform   the thruster command                  thruster_command(command) -> command
    ThrustCurveShape   the shape of the static force curve   reshaped_force(force, full) -> force
    ThrustScaling      the static thruster force             scaled_force(force, t, ...) -> force
    ThrusterDynamics   the dynamic thruster force            respond(force, h, state) -> ...
    FrameMisalignment  what the motion capture reports       transforms() -> two rigid transforms
    MeasurementFilter  what its software makes of that       time_constants() -> of low-passes

effect      what every effect has: parameters, values, where fits begin, what it needs
kinds       the base classes above
parameters  declarations of parameters, and of how the catalogue page shows an effect
kernels     the kernel of a wrench effect, compiled alone and inspected
"""

from rovsim.dynamics.effects.base.effect import Actuated, Effect, Requirement
from rovsim.dynamics.effects.base.kinds import (
    Autopilot,
    Coefficients,
    CommandTiming,
    CommandTransform,
    DemandTransform,
    FrameMisalignment,
    MeasurementFilter,
    StochasticCurrent,
    ThrustCurveShape,
    ThrusterDynamics,
    ThrustScaling,
    Wrench,
)
from rovsim.dynamics.effects.base.parameters import (
    REFERENCE_MASS,
    STAMP_STEP,
    Parameter,
    Signature,
    per_axis,
)

__all__ = [
    "REFERENCE_MASS",
    "STAMP_STEP",
    "Actuated",
    "Autopilot",
    "Coefficients",
    "CommandTiming",
    "CommandTransform",
    "DemandTransform",
    "Effect",
    "FrameMisalignment",
    "MeasurementFilter",
    "Parameter",
    "Requirement",
    "Signature",
    "StochasticCurrent",
    "ThrustCurveShape",
    "ThrustScaling",
    "ThrusterDynamics",
    "Wrench",
    "per_axis",
]
