"""Force budget: the generalized force of every part of a model along a run, and what is missing.

Parts are put into the equation of motion one after the other. The force of a part is by how much
it changes the right-hand side, so that also a new effect has a force, and all parts add up:

    M nu_dot = Coriolis + weight and buoyancy + added-mass Coriolis + damping + thrusters + effects

Inertia is on the left-hand side. Of an effect that changes it, only the changes of the Coriolis
force and of the weight are seen here. Where two effects multiply (a current and a damping), the
product counts as force of the later one.
"""

from dataclasses import replace
from typing import Iterator

import numpy as np
from numpy import ndarray as Array

from rovsim.dynamics.effects.base import Effect
from rovsim.dynamics.model import Model
from rovsim.measurement.signals.measured import blank
from rovsim.measurement.signals.motion import Motion
from rovsim.results.force_budget import ForceBudget
from rovsim.simulation.drive import Drive
from rovsim.simulation.measured_states import (
    accelerate_as_logged,
    accelerate_as_measured,
    drive_as_measured,
    undo_mocap_view,
)
from rovsim.simulation.samples import sample_run
from rovsim.simulation.settings import ReplaySettings, SimulationSettings

CORIOLIS, RESTORING, THRUSTERS = "Coriolis", "weight and buoyancy", "thrusters"
RESIDUAL_NAME = "learned residual"
# Names of the vehicle's own effects as parts, in the order in which they are put in. An effect that
# is not listed comes after them, under its id.
NOMINAL_PARTS = {
    "net_buoyancy": RESTORING,
    "buoyancy_center": RESTORING,
    "waterplane_stiffness": RESTORING,
    "added_mass": "added-mass Coriolis",
    "added_mass_coupling": "added-mass Coriolis",
    "linear_damping": "linear damping",
    "quadratic_damping": "quadratic damping",
    "coupled_damping": "coupled damping",
    "cross_flow": "cross-flow",
    "surfaces": "control surfaces",
}


def balance_forces(model: Model, motion: Motion, settings: SimulationSettings) -> ForceBudget:
    """Compute the forces of a model's parts at the measured states of a run.

    Args:
        model: the model.
        motion: the run.
        settings: of the filter of the measurement, and of how commands are held.
    """
    samples = sample_run(model, motion, settings)
    parts: dict[str, Array] = {}
    previous = np.zeros((len(motion.time), 6))
    for name, force in _cumulative(model, undo_mocap_view(model, motion), settings.replay):
        parts[name] = parts.get(name, 0.0) + force - previous
        previous = force
    missing = np.full((len(motion.time), 6), np.nan)
    missing[samples.index] = blank(motion.measured, samples.a_res @ model.M.T, np.nan)
    return ForceBudget(model.name, motion.run.id, motion.time, parts, missing)


def _cumulative(
    model: Model, motion: Motion, settings: ReplaySettings
) -> Iterator[tuple[str, Array]]:
    """Put in parts one by one; yield the name of each, and the force (n, 6) of all so far.

    Forces are in N and N m, FRD at CO.
    """
    so_far = replace(
        model,
        vehicle_effects=tuple(effect.neutral() for effect in model.vehicle_effects),
        added=tuple(effect.neutral() for effect in model.added),
        residual=None,
    )
    no_thrust = drive_as_measured(so_far, motion, settings).idle()
    at_rest = replace(motion, state_nu=0 * motion.state_nu)
    yield RESTORING, _force(so_far, at_rest, no_thrust)
    yield CORIOLIS, _force(so_far, motion, no_thrust)
    for k, effect in sorted(
        enumerate(model.vehicle_effects), key=lambda pair: _part_order(pair[1])
    ):
        if so_far.effects[k] is not effect:  # else every vehicle has it: in from the start
            so_far = so_far.with_effect(k, effect)
            yield NOMINAL_PARTS.get(effect.id, effect.id), _force(so_far, motion, no_thrust)
    yield THRUSTERS, _inertial_force(so_far, motion, settings)
    for k, effect in enumerate(model.added, start=len(model.vehicle_effects)):
        so_far = so_far.with_effect(k, effect)
        yield f"+{effect.id}", _inertial_force(so_far, motion, settings)
    if model.residual is not None:
        yield RESIDUAL_NAME, _inertial_force(model, motion, settings)


def _part_order(effect: Effect) -> int:
    """Position of an effect of the vehicle in the order of parts."""
    return (
        list(NOMINAL_PARTS).index(effect.id) if effect.id in NOMINAL_PARTS else len(NOMINAL_PARTS)
    )


def _inertial_force(model: Model, motion: Motion, settings: ReplaySettings) -> Array:
    """M nu_dot (n, 6) of a model at the measured states, under the logged commands."""
    return accelerate_as_logged(model, motion, settings) @ model.M.T


def _force(model: Model, motion: Motion, drive: Drive) -> Array:
    """M nu_dot (n, 6) of a model at the measured states, driven by `drive`."""
    return accelerate_as_measured(model, motion, drive) @ model.M.T
