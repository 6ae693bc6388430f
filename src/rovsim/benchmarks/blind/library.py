"""The library of the sparse regressions: what one step of each effect would change.

The target is the acceleration residual a_res = a_real - a_sim of the nominal model at the measured
states. A column is the change of a_sim, computed by the engine itself, when one parameter of the
catalogue moves by its scale from its default; where zero is a flat place (a lag, a deadband, a
slack tether), when the effect stands at one of its starts. So every effect is in the library,
under its own name, through the filter of the measurement; but for a filter of the poses themselves.
Its column is their noise, sharpened, and so is most of the target: every regression would name it.
"""

from dataclasses import dataclass
from typing import Iterator, Mapping, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.core.run import Site
from rovsim.dynamics.effects.base import Effect, MeasurementFilter
from rovsim.dynamics.model import Model
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.samples import sample_run
from rovsim.simulation.settings import SimulationSettings

EVERY = 10  # samples: the filter passes a few Hz, frames come at 100


@dataclass(frozen=True)
class Column:
    """One column: an effect, and what a coefficient of 1 adds to its parameters."""

    effect: str
    step: Mapping[str, float]


@dataclass(frozen=True, eq=False)
class Problem:
    """`target` (n, 6) and `matrix` (n, 6, c), both divided by the RMS acceleration of each axis."""

    columns: tuple[Column, ...]
    target: Array
    matrix: Array


def problem(
    model: Model, motions: Sequence[Motion], effects: Mapping[str, type[Effect]]
) -> Problem:
    """Target and library of some runs; what the log or the tank cannot feed has no column."""
    residual = np.concatenate([_residual(model, m) for m in motions])
    acceleration = np.concatenate([m.nu_dot[m.usable] for m in motions])
    rms = np.sqrt(np.nanmean(np.square(acceleration), axis=0))
    columns, changes = [], []
    for column, effect in steps(motions[0].site, effects):
        try:
            shifted = np.concatenate([_residual(model + effect, m) for m in motions])
        except BadInput:
            continue
        columns.append(column)
        changes.append((residual - shifted) / rms)
    return Problem(tuple(columns), residual / rms, np.stack(changes, axis=-1))


def _residual(model: Model, motion: Motion) -> Array:
    return sample_run(model, motion, SimulationSettings()).a_res[::EVERY]


def steps(site: Site, effects: Mapping[str, type[Effect]]) -> Iterator[tuple[Column, Effect]]:
    """Every column with the effect that makes it."""
    included = ((n, e) for n, e in effects.items() if not issubclass(e, MeasurementFilter))
    for name, cls in included:
        for start in cls.starts_at(site):
            if start:
                yield Column(name, start), cls(**start)
                continue
            for p in cls.parameters:
                if p.fitted:
                    yield Column(name, {p.name: p.scale}), cls(**{p.name: p.default + p.scale})
