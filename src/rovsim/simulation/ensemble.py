"""One step at a time, with a band: many possible models are stepped side by side.

ensemble = Ensemble(model)
states = ensemble.start(state)
while running:
    states = ensemble.step(states, command, 0.01)
    low, high = ensemble.band(states)
"""

from math import inf

import numpy as np
from numpy import ndarray as Array

from rovsim.core import gauss_markov
from rovsim.core.errors import BadInput
from rovsim.core.run import CommandKind, Site
from rovsim.dynamics.model import Model
from rovsim.simulation.bands import DRAWS, band_ends
from rovsim.simulation.noise_draws import NoiseDraws
from rovsim.simulation.stepper import Stepper


class Ensemble:
    """Steppers of possible models, with effects, values and disturbances drawn from a posterior.

    The initial state of the vehicle is not drawn, because the caller may know it better or worse
    than a motion capture would. Where it is uncertain, vary the states that `start` returns.

    Args:
        model: with the uncertainty that `rovsim add` writes into a model after a diagnosis.
        kind: what commands are; see `Stepper`.
        site: walls of the tank, where an effect needs them.
        duration: of the whole run, s; see `Stepper`.
        draws: number of possible models.
        seed: of the draws.

    Raises:
        BadInput: the model file does not say how sure it is, or the model cannot be stepped.
    """

    def __init__(
        self,
        model: Model,
        kind: CommandKind = "thruster",
        site: Site | None = None,
        duration: float = inf,
        draws: int = DRAWS,
        seed: int = 0,
    ) -> None:
        random = np.random.default_rng(seed)
        noise = model.uncertainty and NoiseDraws.of(model.uncertainty.noise, random)
        if not noise:
            raise BadInput(
                "it does not say how sure it is",
                where=f"model {model.name}",
                expected="a model with `uncertainty`, as `rovsim add` makes it of a diagnosis",
                remedy="Diagnose a campaign with this model, and add what was found.",
            )
        self.noise = noise
        models = [model.draw(random) for _ in range(draws)]
        self.members = [Stepper(drawn, kind, site, duration) for drawn in models]
        self._drawn = random.normal(size=(draws, 6))

    def start(self, state: Array) -> Array:
        """States (draws, 13) of all models, equal to the state (13,) in which the run begins."""
        return np.tile(np.asarray(state, dtype=np.float64), (len(self.members), 1))

    def step(self, states: Array, command: Array, dt: float) -> Array:
        """Step all models by dt s under a command that is given now and held.

        The disturbance is held for dt as well, so take steps shorter than its correlation time,
        which is some 0.5 s.

        Args:
            states: of all models (draws, 13), in NED and FRD as those of `Stepper`.
            command: (c,) in the unit of its kind; see `Stepper`.
            dt: length of the step, s.

        Returns:
            The states (draws, 13) after the step.

        Raises:
            BadInput: a command or states of another shape, or dt that is not positive.
        """
        accelerations = self.noise.disturbance_std * self._drawn
        next_states = [
            member.step(state, command, dt, member.model.M @ acceleration)
            for member, state, acceleration in zip(self.members, states, accelerations, strict=True)
        ]
        fade = gauss_markov.decay(dt / self.noise.correlation_time)
        normal = self.noise.random.normal(size=(1, *accelerations.shape))
        self._drawn = gauss_markov.propagate(fade[None, None], normal, self._drawn)[0]
        return np.array(next_states)

    @staticmethod
    def band(states: Array) -> Array:
        """Lower and upper end (2, 13) of the band that holds 90 % of each number of the state."""
        return band_ends(states)
