"""The library of the sparse regressions: how small steps of each effect change accelerations.

The target is the acceleration residual a_res = a_real - a_sim of the nominal model at the measured
states. A column is the change of a_sim, computed by the engine itself, when one parameter of the
catalogue moves by its scale from its default. Where the derivative is zero there (a lag, a
deadband, a slack tether), the effect is moved to one of its starts instead. So every effect is in
the library under its own name, as the filter of the measurement shows it.

Filters of the poses themselves are left out. Their column is the sharpened noise of the poses, and
so is most of the target: every regression would name them.
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

SAMPLE_STRIDE = 10  # samples: the filter passes a few Hz, frames come at 100


@dataclass(frozen=True)
class LibraryColumn:
    """One column of the library.

    Attributes:
        effect: its id.
        step: what a coefficient of 1 adds to the effect's parameters, in their units.
    """

    effect: str
    step: Mapping[str, float]


@dataclass(frozen=True, eq=False)
class Problem:
    """A regression problem over n samples, with c columns.

    Attributes:
        columns: of the library.
        target: acceleration residual (n, 6), in units of the RMS acceleration of each axis.
        matrix: change of the acceleration (n, 6, c) by each column, in the same units.
    """

    columns: tuple[LibraryColumn, ...]
    target: Array
    matrix: Array


def problem(
    model: Model, motions: Sequence[Motion], effects: Mapping[str, type[Effect]]
) -> Problem:
    """Make target and library of some runs.

    An effect that the log or the tank lacks an input for has no column.
    """
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
    return sample_run(model, motion, SimulationSettings()).a_res[::SAMPLE_STRIDE]


def steps(
    site: Site, effects: Mapping[str, type[Effect]]
) -> Iterator[tuple[LibraryColumn, Effect]]:
    """Yield every column, and the effect at the values of its step."""
    included = ((n, e) for n, e in effects.items() if not issubclass(e, MeasurementFilter))
    for name, cls in included:
        for start in cls.starts_at(site):
            if start:
                yield LibraryColumn(name, start), cls(**start)
                continue
            for p in cls.parameters:
                if p.fitted:
                    yield (
                        LibraryColumn(name, {p.name: p.scale}),
                        cls(**{p.name: p.default + p.scale}),
                    )
