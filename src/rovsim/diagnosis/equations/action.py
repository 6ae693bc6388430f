"""On which axis a law acts, how strongly, and whether it leaves structure there."""

from math import sqrt
from typing import Iterable, NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.axes import AXES
from rovsim.diagnosis.equations.form import Form, get_law, split_law
from rovsim.diagnosis.structure.residual import Structure
from rovsim.dynamics.effects.base import Effect
from rovsim.dynamics.model import Model
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.innovations import accelerate
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.simulation.measured_states import undo_mocap_view

# Of the law: less is left by a law that is right, but for details (at which force thrusters begin,
# how they move within a step): 0.7 and 1.5 % in two recordings of thrust at a limited rate. Of 58
# development cases of laws and disturbances the nearest is a false law, for a weight that rolls
# about, which left 5.1 %.
MAX_REMAINDER = 0.03


class Action(NamedTuple):
    """How strongly a law acts.

    Attributes:
        sizes: RMS of each of its terms, N or N m.
        axis: on which the whole law stands out most from the disturbance.
        prominence: RMS of the whole law there, over that of the disturbance.
    """

    sizes: tuple[float, ...]
    axis: str
    prominence: float

    def leaves_structure(self, structures: Iterable[Structure], margin: float = 1.0) -> bool:
        """Whether a law leaves structure on its axis that is not small beside the law itself.

        Args:
            structures: what the fit with the law leaves, on all axes.
            margin: times what chance allows.
        """
        return any(
            s.times_limit > margin and sqrt(s.share) > MAX_REMAINDER * self.prominence
            for s in structures
            if s.axis == self.axis
        )


def find_action(form: Form, fit: Fit, runs: Sequence[ObservedRun]) -> Action:
    """Evaluate how strongly a fitted law acts at the measured states of runs.

    Args:
        form: of the law.
        fit: of a hypothesis with the law; its noise says how large the disturbance is.
        runs: at whose readings the law is evaluated.
    """
    model, parts = split_law(fit.hypothesis)[0].model, form.divide(get_law(fit.hypothesis))
    accelerations = np.concatenate(
        [_evaluate_accelerations(model, parts, run) for run in runs], axis=1
    )
    rms = np.sqrt(np.mean(accelerations.sum(axis=0) ** 2, axis=0))
    sizes = np.sqrt(np.mean(np.sum((accelerations @ model.M.T) ** 2, axis=2), axis=1))
    prominence = rms / fit.noise.disturbance_std
    axis = int(np.argmax(prominence))
    return Action(tuple(sizes.tolist()), AXES[axis], float(prominence[axis]))


def _evaluate_accelerations(model: Model, effects: Sequence[Effect], run: ObservedRun) -> Array:
    """Accelerations that effects add to a model at the measured states of a run.

    Args:
        model: without the effects.
        effects: k effects, each added by itself.
        run: of which the n readings with a measured state are used.

    Returns:
        Body accelerations (k, n, 6), m/s2 and rad/s2.
    """
    state = undo_mocap_view(model, run.motion).state[run.innovation_samples]
    finite = np.isfinite(state).all(axis=1)
    index, states = run.innovation_samples[finite], state[None, finite]
    accelerations = [accelerate(model + effect, run, index, states)[0] for effect in effects]
    return np.stack(accelerations) - accelerate(model, run, index, states)
