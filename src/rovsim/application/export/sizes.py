"""Measure how large a force is that a target leaves out, over recorded runs or a typical flight.

The force is M (nu_dot - nu_dot'), with the accelerations of the model before and after a part is
left out, at the same states and commands: with this force added, both would accelerate alike.
"""

from dataclasses import dataclass, replace
from typing import Iterable, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.application.export.holding import OmittedPart
from rovsim.core.axes import AXES
from rovsim.core.rotations import HALF_TURN_X
from rovsim.core.run import RunInfo, Site
from rovsim.dynamics.effects.base import (
    Autopilot,
    DemandTransform,
    FrameMisalignment,
    MeasurementFilter,
)
from rovsim.dynamics.model import Model
from rovsim.dynamics.vehicle import Vehicle
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.measured_states import accelerate_as_logged, undo_mocap_view
from rovsim.simulation.settings import ReplaySettings
from rovsim.simulation.synthetic_tank.settings import (
    SUITABLE_TANKS,
    Box,
    Log,
    TankSettings,
    Turbulence,
)
from rovsim.simulation.synthetic_tank.true_run import Flight, LeftTank, fly_run

FLIGHT_SEED = 20260101  # of the typical flight; any will do
SAMPLE_STRIDE = 10  # of its steps of 1 ms: samples at the 100 Hz of a motion capture
FREE_SPACE_M = 30.0  # each way, where the vehicle does not stay in the tank


@dataclass(frozen=True)
class Sized:
    """A part of a model that is left out, and the size of its force.

    Attributes:
        name: of the part.
        why: it is left out.
        rms: (6,) of its force by axis, N and N m, FRD.
    """

    name: str
    why: str
    rms: tuple[float, ...]

    @property
    def acts(self) -> bool:
        """Whether its force was ever different from zero."""
        return any(self.rms)


def size_all(left: Sequence[OmittedPart], motions: Sequence[Motion]) -> list[Sized]:
    """Measure the force of each part over some true motions."""
    return [Sized(part.name, part.why, _rms(part, motions)) for part in left]


def flights(model: Model, motions: Iterable[Motion] | None) -> list[Motion]:
    """Return true motions: measured ones corrected by the model's view of the motion capture.

    Args:
        model: that is exported.
        motions: as measured; None: a typical flight is simulated instead.
    """
    if motions is None:
        return [typical_flight(model)]
    return [undo_mocap_view(model, motion) for motion in motions]


def typical_flight(model: Model) -> Motion:
    """Simulate a minute in which a pilot flies a model about, in the default tank or open water.

    The model's effects act, its residual does not. The commands of the thrusters are logged, or
    demands per axis where an effect acts on these.
    """
    demands = any(isinstance(effect, Autopilot | DemandTransform) for effect in model.effects)
    plant = replace(model, residual=None).with_added(
        e.neutral() if isinstance(e, FrameMisalignment | MeasurementFilter) else e
        for e in model.added
    )
    settings = _calm(model.vehicle, demands)
    try:
        return _fly(plant, settings)
    except LeftTank:
        sides = {axis: (-FREE_SPACE_M, FREE_SPACE_M) for axis in "xyz"}
        return _fly(plant, settings.model_copy(update={"tank": Box(**sides)}))


def _calm(vehicle: Vehicle, demands: bool) -> TankSettings:
    """Return a tank that suits a vehicle, without turbulence, which no model describes."""
    suitable = SUITABLE_TANKS["surfaces"] if vehicle.surfaces else {}
    suitable = SUITABLE_TANKS["waterplane"] if vehicle.floats else suitable
    box = Box(**suitable["tank"]) if suitable else Box()
    still_water = Turbulence(force=0.0, moment=0.0)
    return TankSettings(
        tank=box, turbulence=still_water, log=Log(kind="demand" if demands else "pwm")
    )


def _fly(model: Model, settings: TankSettings) -> Motion:
    truth = fly_run(model, settings, Flight("6dof"), np.random.default_rng(FLIGHT_SEED))
    state, time = truth.state[::SAMPLE_STRIDE], np.round(truth.time[::SAMPLE_STRIDE], 9)
    tank = settings.tank.ned
    site = Site(tank, HALF_TURN_X, float(tank[2, 0]))
    return Motion(
        RunInfo("flight", "6dof", "train"),
        site,
        time,
        state[:, :7],
        state[:, 7:],
        np.gradient(state[:, 7:], time, axis=0),
        state[:, 7:],
        np.ones(len(time), bool),
        truth.commands,
        False,
        float(time[-1]),
    )


def _rms(left: OmittedPart, motions: Sequence[Motion]) -> tuple[float, ...]:
    force = np.concatenate([_force(left, motion)[motion.usable] for motion in motions])
    force = force[np.isfinite(force).all(axis=1)]
    size = np.sqrt(np.mean(force**2, axis=0)) if len(force) else np.zeros(len(AXES))
    return tuple(float(v) if v > 1e-12 else 0.0 for v in size)


def _force(left: OmittedPart, motion: Motion) -> Array:
    """Compute the wrench (n, 6), N and N m, that is left out at the states of a motion."""
    models = (left.before, left.after)
    full, reduced = (accelerate_as_logged(model, motion, ReplaySettings()) for model in models)
    force = (full - reduced) @ left.before.M.T
    if left.missing is not None:
        force = force + left.missing(left.before, motion.state)
    return np.asarray(force)
