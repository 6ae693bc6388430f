"""What was fitted: values with their deviations, how these hang together, and the noise."""

from typing import Annotated, Literal, Self

import numpy as np
from numpy import ndarray as Array
from pydantic import AfterValidator, Field, model_validator

from rovsim.core.schema import Section
from rovsim.results.base import Sparse

EIGENVALUE_TOLERANCE = 1e-3  # by how much an eigenvalue of a correlation may miss zero


def _six(values: tuple) -> tuple:
    if len(values) not in (0, 6):
        raise ValueError("six values, one an axis, or none where nothing is known")
    return values


Size = Annotated[float, Field(ge=0.0)]
Seconds = Annotated[float, Field(gt=0.0)]
Probability = Annotated[float, Field(ge=0.0, le=1.0)]
SixSizes = Annotated[tuple[Size | None, ...], AfterValidator(_six)]
SixTimes = Annotated[tuple[Seconds | None, ...], AfterValidator(_six)]


class FittedValue(Sparse):
    """A parameter's value; `std` where it was fitted together with all others that act."""

    value: float | None
    std: Size | None = None
    unit: str | None = None


class FittedEffect(Section):
    """An effect with its values, the share of the error it removes, how likely its name is."""

    effect: str
    parameters: dict[str, FittedValue]
    error_reduction: float | None = None
    probability: float | None = None


# Why a name has no probability:
Doubt = Literal[
    "stand_in",  # an equation that was tried does without it, or changes it by more than half
    "unexplained",  # what is left unexplained may make more of the error
    "wanders",  # what is left unexplained may seem a current that wanders
    "looks_ahead",  # the cameras' filter may use later frames as well
    "depth_at_rest",  # another depth at rest would look like it
    "differs",  # it has another value in each run
    "autopilot",  # it only shows where an autopilot acts by a sensor better than the cameras
    "varies",  # its value varies from run to run more than noise lets it
    "negative",  # with it a coefficient is surely below zero
    "perhaps_absent",  # its values may all be those of its absence, as far as they are known
]


class SelectedEffect(FittedEffect):
    """An accepted effect; `doubt`: why its name has no probability, if not for want of rivals.

    Files of earlier versions have no `doubt`.
    """

    doubt: Doubt | None = None


class FittedNoise(Sparse):
    """Six values each: disturbance m/s2, rad/s2; its memory s; reading m, rad. Empty if unknown.

    `reading` is of readings `period_s` apart (of bins m/s, rad/s, whatever their length). `colour`
    m, rad and `colour_memory_s`: the cameras' slow error, where there is one.
    """

    disturbance: SixSizes = ()
    memory_s: SixTimes = ()
    reading: SixSizes = ()
    period_s: Seconds | None = None
    colour: SixSizes = ()
    colour_memory_s: SixTimes = ()


class Correlation(Section):
    """Of the errors of the values `between` (k of them, as `effect.parameter`).

    `rows` of its lower triangle: 1 number, 2, …, k; 1 on the diagonal.
    """

    between: tuple[str, ...] = ()
    rows: tuple[tuple[float, ...], ...] = ()

    @model_validator(mode="after")
    def _is_triangle(self) -> Self:
        k = len(self.between)
        if [len(row) for row in self.rows] != list(range(1, k + 1)):
            raise ValueError(f"{k} rows, of 1 to {k} numbers")
        if any(abs(r) > 1.0 for row in self.rows for r in row):
            raise ValueError("correlations from -1 to 1")
        if len(set(self.between)) < k:
            raise ValueError("names of values, each named once")
        if k and np.linalg.eigvalsh(self.lower).min() < -EIGENVALUE_TOLERANCE:
            raise ValueError("correlations that can hold all at once (no negative eigenvalue)")
        return self

    @property
    def lower(self) -> Array:
        """The matrix (k, k), zero above its diagonal."""
        k = len(self.between)
        lower = np.zeros((k, k))
        lower[np.tril_indices(k)] = [r for row in self.rows for r in row]
        return lower


class Possibility(Section):
    """Effects that may act instead of the selected ones: all of them, and how likely they are."""

    probability: Probability
    effects: tuple[FittedEffect, ...]
    correlation: Correlation


class Posterior(Section):
    """What is known of the values of the selected effects beside their standard deviations.

    `instead`: other names that explain nearly as much.
    """

    correlation: Correlation = Correlation()
    instead: tuple[Possibility, ...] = ()
