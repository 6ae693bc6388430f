"""Find which parts of a model another simulator can hold, and which are left out, by name."""

from dataclasses import dataclass, replace
from typing import Callable, Iterator

from numpy import ndarray as Array

from rovsim.dynamics.effects.base import (
    Autopilot,
    CommandTiming,
    DemandTransform,
    Effect,
    FrameMisalignment,
    MeasurementFilter,
    StochasticCurrent,
    ThrusterDynamics,
    ThrustScaling,
)
from rovsim.dynamics.model import Model
from rovsim.dynamics.vehicle.file import HeldAxes
from rovsim.dynamics.vehicle.thrusters import Thrusters

# Ids of effects that are constants of the equation of motion, or part of a table of thrust.
RIGID_EFFECTS = ("rigid_body", "payload", "net_buoyancy", "buoyancy_center", "thrusters")
DAMPING_EFFECTS = ("linear_damping", "quadratic_damping", "coupled_damping")
INERTIA_EFFECTS = ("added_mass", "added_mass_coupling")
STATIC_THRUST_EFFECTS = (
    "thruster_order",
    "thruster_deadband",
    "force_curve",
    "thruster_gain",
    "thrust_asymmetry",
)
RESIDUAL_NAME = "learned residual"

LEFT_OUT_REASONS: tuple[tuple[type[Effect], str], ...] = (
    (FrameMisalignment, "what the motion capture reports; no force"),
    (MeasurementFilter, "what the motion capture reports; no force"),
    (StochasticCurrent, "a model has its mean, still water; no force"),
    (CommandTiming, "commands act when they are given"),
    (DemandTransform, "it takes forces or commands of thrusters, no demands"),
    (Autopilot, "it takes forces or commands of thrusters, no demands"),
    (ThrusterDynamics, "thrusters push at once"),
    (ThrustScaling, "thrust does not change with time"),
)

Hold = Callable[[Effect], tuple[Effect, str]]
Missing = Callable[[Model, Array], Array]


@dataclass(frozen=True, eq=False)
class OmittedPart:
    """A part of a model that a target leaves out.

    Attributes:
        name: of the part.
        why: it is left out.
        before: the model with this part.
        after: the model without it.
        missing: function (model, states (n, 13)) -> wrench (n, 6), N and N m: what is left out in
            addition to the difference of the two models; None: nothing.
    """

    name: str
    why: str
    before: Model
    after: Model
    missing: Missing | None = None


def whole(effect: Effect) -> tuple[Effect, str]:
    """Keep the whole effect; as a `Hold`."""
    return effect, ""


def nothing(effect: Effect) -> tuple[Effect, str]:
    """Keep nothing of an effect: return it at values that do nothing, and why, by its kind."""
    neutral = HeldAxes() if isinstance(effect, HeldAxes) else effect.neutral()
    return neutral, next(
        (reason for kind, reason in LEFT_OUT_REASONS if isinstance(effect, kind)),
        "it has no such term",
    )


class Fixed(Thrusters):
    """Thrusters that stay at the angle zero, whatever angles are commanded."""

    def resolved(
        self, force: Array, cosine: Array | None = None, sine: Array | None = None
    ) -> Array:
        """Resolve forces along the directions of the angle zero."""
        return super().resolved(force)


def unpowered(thrusters: Thrusters) -> tuple[Thrusters, str]:
    """Convert thrusters for a target without a battery: thrust is that at the nominal voltage.

    Returns:
        The thrusters, and what is left out; empty where thrust does not depend on voltage.
    """
    tables = [curve.tables for curve in thrusters.curves if curve.tables is not None]
    by_voltage = [table for table in tables if len(table.volts) > 1]
    if not by_voltage:
        return thrusters, ""
    layout = thrusters.layout
    units = [
        unit.model_copy(update={"force_curve": curve.at_nominal_voltage})
        for unit, curve in zip(layout.units, thrusters.curves, strict=True)
    ]
    volts = ", ".join(f"{v:g}" for v in sorted({table.usual for table in by_voltage}))
    converted = Thrusters(layout.model_copy(update={"units": tuple(units)}))
    return converted, f"thrust is that at {volts} V, whatever the battery has"


def fixed(thrusters: Thrusters) -> tuple[Thrusters, str]:
    """Convert thrusters for a target without a battery and without azimuth thrusters.

    Returns:
        The thrusters, and what is left out; empty where that is nothing.
    """
    converted, reason = unpowered(thrusters)
    if not thrusters.turning.any():
        return converted, reason
    note = "thrusters do not turn: they push along the angle zero"
    return Fixed(converted.layout), f"{note}; {reason}" if reason else note


def leave_out(model: Model, hold: Hold) -> Iterator[OmittedPart]:
    """List what a target leaves out of a model, one part after the other.

    The target can hold the last `after` as a whole. Effects that are left out stay in the model at
    values that do nothing, so that one compiled engine serves all these models.

    Args:
        model: that is exported.
        hold: returns what the target can hold of an effect, and why not all; empty: it is all.
    """
    held = model
    for k, effect in enumerate(model.effects):
        remainder, reason = hold(effect)
        if reason and acts(effect):
            before, held = held, held.with_effect(k, remainder)
            yield OmittedPart(effect.id, reason, before, held)
    if model.residual is not None:
        yield OmittedPart(
            RESIDUAL_NAME,
            "a trained residual is arrays, no term",
            held,
            replace(held, residual=None),
        )


def acts(effect: Effect) -> bool:
    """Whether an effect has other values than its defaults, which do nothing."""
    return not effect.listed or bool(effect.given())
