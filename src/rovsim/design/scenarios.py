"""Predict the paths of a flight for all that is not yet known: models, disturbances, starts."""

from dataclasses import dataclass
from functools import cached_property
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core import gauss_markov
from rovsim.core.rotations import exp, multiply
from rovsim.design.prior_information import PriorInformation
from rovsim.design.recording_setup import RecordingSetup
from rovsim.dynamics.model import Model
from rovsim.simulation.batch import Batch, Starts
from rovsim.simulation.drive import Drives
from rovsim.simulation.rest import PLACEMENT_STD_M, PLACEMENT_STD_RAD


@dataclass(frozen=True, eq=False)
class Scenarios:
    """s ways in which a flight might go.

    The first of each rival has its likeliest model, no random disturbance and no error of the
    start; only the mean of the low-frequency disturbance acts in it.

    Attributes:
        models: s possible models.
        disturbances: accelerations (s, k, 6) over k steps, m/s2 and rad/s2, body axes.
        shift: error (s, 3) of the place of the start, m NED.
        turn: error (s,) of the heading of the start, rad.
        setup: how the flight would be recorded.
    """

    models: Sequence[Model]
    disturbances: Array
    shift: Array
    turn: Array
    setup: RecordingSetup

    def split(self, count: int) -> tuple["Scenarios", "Scenarios"]:
        """The first `count` scenarios, and all others."""
        parts = (slice(0, count), slice(count, None))
        first, rest = (
            Scenarios(self.models[p], self.disturbances[p], self.shift[p], self.turn[p], self.setup)
            for p in parts
        )
        return first, rest

    def predict(self, drives: Drives, start: Array) -> Array:
        """Predict states (s, k+1, 13) under one command log, from near a state (13,)."""
        models, edges = self.models, self.setup.edges
        pairs = zip(drives.of(models), self._wrenches, strict=True)
        disturbed = [drive.with_wrench(wrench) for drive, wrench in pairs]
        states = np.tile(start, (len(models), 1, 1))
        floats = models[0].vehicle.floats
        states[:, 0, :3] += self.shift * np.where(np.arange(3) == 2, not floats, 1)
        states[:, 0, 3:7] = multiply(self._turns, states[:, 0, 3:7])
        steps = np.array([len(edges) - 1])
        starts = Starts(states, np.zeros(1, np.int64), steps, np.zeros((len(models), 1, 6)))
        return np.array([path[0] for path in self._batch.trajectories(disturbed, starts, edges)])

    @cached_property
    def _batch(self) -> Batch:
        setup = self.setup
        return Batch(self.models, setup.site, candidates=setup.wrenches, learned=False)

    @cached_property
    def _wrenches(self) -> list[Array]:
        """The disturbance of each scenario as a wrench (k, 6), N and N m."""
        pairs = zip(self.disturbances, self.models, strict=True)
        return [disturbance @ model.M.T for disturbance, model in pairs]

    @cached_property
    def _turns(self) -> Array:
        return exp(self.turn[:, None] * np.array([0.0, 0.0, 1.0]))


def draw_scenarios(
    each: Sequence[Sequence[Model]],
    prior: PriorInformation,
    setup: RecordingSetup,
    random: np.random.Generator,
) -> Scenarios:
    """Draw scenarios for possible models, with disturbances as the train runs show them.

    Args:
        each: possible models of each rival, the likeliest first.
        prior: what the train runs tell of the noise and of the low-frequency disturbance.
        setup: how the flight would be recorded.
        random: generator.

    Returns:
        The likeliest scenario of each rival first, then all others.
    """
    scenarios = [_draw_of(group, prior, k, setup, random) for k, group in enumerate(each)]
    parts = [s.split(1) for s in scenarios]
    ordered = [first for first, _ in parts] + [rest for _, rest in parts]
    disturbances, shift, turn = (
        np.concatenate([getattr(s, name) for s in ordered])
        for name in ("disturbances", "shift", "turn")
    )
    models = [model for s in ordered for model in s.models]
    return Scenarios(models, disturbances, shift, turn, setup)


def _draw_of(
    models: Sequence[Model],
    prior: PriorInformation,
    rival: int,
    setup: RecordingSetup,
    random: np.random.Generator,
) -> Scenarios:
    """Draw scenarios for the models of one rival: noise-like and low-frequency disturbances."""
    count, steps, h = len(models), len(setup.edges) - 1, setup.step
    noise, slow = prior.noise, prior.low_frequency[rival]
    std = noise.disturbance_std * models[0].body.free
    correlation_time = float(np.median(noise.correlation_time))
    disturbances = np.array(
        [
            std * gauss_markov.draw(steps, h / correlation_time, random)
            + slow.draw(steps, h, random)
            for _ in models
        ]
    )
    shift, turn = (
        PLACEMENT_STD_M * random.normal(size=(count, 3)),
        PLACEMENT_STD_RAD * random.normal(size=count),
    )
    disturbances[0], shift[0], turn[0] = slow.mean, 0.0, 0.0
    return Scenarios(models, disturbances, shift, turn, setup)
