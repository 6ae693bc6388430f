"""Who pushes how much over one run, by one model, and what is missing."""

from rovsim.application.sections import SimulationSettings
from rovsim.dynamics.model import Model
from rovsim.evaluation.budget import Budget
from rovsim.evaluation.force_balance import balance_forces
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.samples import sample_run


def balance_run(model: Model, motion: Motion, settings: SimulationSettings) -> Budget:
    """Budget of a model's forces at the measured states of a run, N and N m."""
    pairs = sample_run(model, motion, settings.signals, settings.replay)
    return balance_forces(model, motion, pairs, settings.replay)
