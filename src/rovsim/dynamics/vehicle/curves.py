"""Static force curves: the command of a thruster to its force at rest."""

from typing import Annotated, Self

import numpy as np
from numpy import ndarray as Array
from pydantic import Field, PositiveFloat, model_validator

from rovsim.core.schema import Section

NonNegative = Annotated[float, Field(ge=0)]


class Quadratic(Section):
    """F = forward s^2 or -reverse s^2, N, s = (|c| - deadband) / (1 - deadband) of full command.

    Thrust goes with the square of the propeller's speed (Fossen 2021, sec. 9.1, at rest); inside
    the dead band nothing turns.
    """

    forward: NonNegative
    reverse: NonNegative
    deadband: Annotated[float, Field(ge=0, lt=1)] = 0.0

    def force(self, command: Array) -> Array:
        """Force in N of commands in [-1, 1]."""
        share = np.maximum(np.abs(command) - self.deadband, 0.0) / (1.0 - self.deadband)
        return np.where(command < 0.0, -self.reverse, self.forward) * share * share


class Table(Section):
    """Force in N at some commands; linear between them, held beyond the first and the last."""

    command: tuple[float, ...] = Field(min_length=2)
    force_: tuple[float, ...] = Field(min_length=2, alias="force")

    @model_validator(mode="after")
    def _fits(self) -> Self:
        if len(self.command) != len(self.force_):
            raise ValueError("as many forces as commands")
        if np.any(np.diff(self.command) <= 0.0):
            raise ValueError("commands that increase")
        return self

    def force(self, command: Array) -> Array:
        """Force in N of commands in [-1, 1]."""
        return np.interp(command, self.command, self.force_)


class Tables(Section):
    """A table for each of some battery voltages, V; linear between them, held beyond.

    Where no voltage was logged, that of `nominal`; the highest of the tables unless given: a full
    battery.
    """

    volts: dict[PositiveFloat, Table] = Field(min_length=1)
    nominal: PositiveFloat | None = None

    @property
    def usual(self) -> float:
        """The voltage where none was logged, V."""
        return self.nominal or max(self.volts)

    @property
    def at_usual(self) -> Table:
        """The table there."""
        command = sorted({c for table in self.volts.values() for c in table.command})
        force = self.force(np.array(command), None)
        return Table(command=tuple(command), force=tuple(force.tolist()))

    def force(self, command: Array, voltage: Array | None) -> Array:
        """Force in N of commands (m, ...) at battery voltages (m,), nominal if None."""
        known = sorted(self.volts)
        forces = np.stack([self.volts[v].force(command) for v in known])
        if voltage is None:
            voltage = np.full(len(command), self.usual)
        place = np.interp(voltage, known, np.arange(len(known)))
        below = np.minimum(place.astype(int), max(len(known) - 2, 0))
        above = np.minimum(below + 1, len(known) - 1)
        share = (place - below).reshape(-1, *(1,) * (command.ndim - 1))
        rows = np.arange(len(command))
        return (1.0 - share) * forces[below, rows] + share * forces[above, rows]


class ForceCurve(Section):
    """One of four ways to say what force a command in [-1, 1] makes, N.

    `odd_polynomial` a_k: sum_k a_k c^(2k+1), equal both ways; `quadratic`; `table`; `tables`.
    """

    odd_polynomial: tuple[float, ...] | None = Field(default=None, min_length=1)
    quadratic: Quadratic | None = None
    table: Table | None = None
    tables: Tables | None = None

    @model_validator(mode="after")
    def _one(self) -> Self:
        if sum(given is not None for _, given in self) != 1:
            raise ValueError(f"one of {', '.join(type(self).model_fields)}")
        return self

    @property
    def at_nominal_voltage(self) -> "ForceCurve":
        """The same where it does not ask for the voltage, else the table at the nominal one."""
        return self if self.tables is None else ForceCurve(table=self.tables.at_usual)

    def force(self, command: Array, voltage: Array | None = None) -> Array:
        """Force in N of commands (m, ...) in [-1, 1]; `voltage` (m,) V of the battery if known."""
        if self.tables is not None:
            return self.tables.force(command, voltage)
        other = self.quadratic or self.table
        return other.force(command) if other else self._polynomial(command)

    def _polynomial(self, command: Array) -> Array:
        force, power = np.zeros_like(command), command
        for a in self.odd_polynomial or ():
            force = force + a * power
            power = power * command * command
        return force
