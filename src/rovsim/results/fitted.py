"""What was fitted: values with their deviations, how these hang together, and the noise."""

from typing import Self

from pydantic import model_validator

from rovsim.core.schema import Section
from rovsim.results.base import Sparse


class FittedValue(Sparse):
    """A parameter's value; `std` where it was fitted together with all others that act."""

    value: float | None
    std: float | None = None
    unit: str | None = None


class FittedEffect(Section):
    """An effect with its values, the share of the error it removes, how likely its name is."""

    effect: str
    parameters: dict[str, FittedValue]
    error_reduction: float | None = None
    probability: float | None = None


class FittedNoise(Sparse):
    """Six values each: disturbance m/s2, rad/s2; its memory s; reading m, rad. Empty if unknown.

    `reading` is of readings `period_s` apart (of bins m/s, rad/s, whatever their length). `colour`
    m, rad and `colour_memory_s`: the cameras' slow error, where there is one.
    """

    disturbance: tuple[float | None, ...] = ()
    memory_s: tuple[float | None, ...] = ()
    reading: tuple[float | None, ...] = ()
    period_s: float | None = None
    colour: tuple[float | None, ...] = ()
    colour_memory_s: tuple[float | None, ...] = ()


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
        return self


class Possibility(Section):
    """Effects that may act instead of the selected ones: all of them, and how likely they are."""

    probability: float
    effects: tuple[FittedEffect, ...]
    correlation: Correlation


class Posterior(Section):
    """What is known of the values of the selected effects beside their standard deviations.

    `instead`: other names that explain nearly as much.
    """

    correlation: Correlation = Correlation()
    instead: tuple[Possibility, ...] = ()
