"""Static force curves: the force of a thruster at rest as a function of its command."""

from typing import Annotated, Self

import numpy as np
from numpy import ndarray as Array
from pydantic import Field, PositiveFloat, model_validator

from rovsim.core.schema import Section

NonNegative = Annotated[float, Field(ge=0)]


class Quadratic(Section):
    """F = forward s^2 or -reverse s^2, N, with s = (|c| - deadband) / (1 - deadband).

    Thrust is proportional to the square of the propeller's speed (Fossen 2021, sec. 9.1, at rest).
    Inside the dead band the propeller does not turn: s = 0.

    Attributes:
        forward: force at full command ahead, N.
        reverse: absolute force at full command back, N.
        deadband: in commands from 0 to 1.
    """

    forward: NonNegative
    reverse: NonNegative
    deadband: Annotated[float, Field(ge=0, lt=1)] = 0.0

    def force(self, command: Array) -> Array:
        """Force in N of commands in [-1, 1]."""
        share = np.maximum(np.abs(command) - self.deadband, 0.0) / (1.0 - self.deadband)
        return np.where(command < 0.0, -self.reverse, self.forward) * share * share


class ForceTable(Section):
    """Forces, N, at some commands; linear between them, constant beyond the first and the last."""

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


class ForceTables(Section):
    """A table for each of some battery voltages, V; linear between them, constant beyond.

    Attributes:
        volts: the tables by voltage, V.
        nominal: voltage where none was logged, V; None: the highest of the tables, a full battery.
    """

    volts: dict[PositiveFloat, ForceTable] = Field(min_length=1)
    nominal: PositiveFloat | None = None

    @property
    def usual(self) -> float:
        """The voltage to use where none was logged, V."""
        return self.nominal or max(self.volts)

    @property
    def at_usual(self) -> ForceTable:
        """The table at the usual voltage."""
        command = sorted({c for table in self.volts.values() for c in table.command})
        force = self.force(np.array(command), None)
        return ForceTable(command=tuple(command), force=tuple(force.tolist()))

    def force(self, command: Array, voltage: Array | None) -> Array:
        """Forces (m, ...), N, of commands (m, ...) at battery voltages (m,), V; None: nominal."""
        voltages = sorted(self.volts)
        forces = np.stack([self.volts[v].force(command) for v in voltages])
        if voltage is None:
            voltage = np.full(len(command), self.usual)
        position = np.interp(voltage, voltages, np.arange(len(voltages)))
        lower = np.minimum(position.astype(int), max(len(voltages) - 2, 0))
        upper = np.minimum(lower + 1, len(voltages) - 1)
        share = (position - lower).reshape(-1, *(1,) * (command.ndim - 1))
        rows = np.arange(len(command))
        return (1.0 - share) * forces[lower, rows] + share * forces[upper, rows]


class ForceCurve(Section):
    """A force curve in one of four forms, of which exactly one is given.

    Attributes:
        odd_polynomial: a_k, N, of F = sum_k a_k c^(2k+1), the same in both directions.
        quadratic: two coefficients and a dead band.
        table: forces at some commands.
        tables: a table for each of some battery voltages.
    """

    odd_polynomial: tuple[float, ...] | None = Field(default=None, min_length=1)
    quadratic: Quadratic | None = None
    table: ForceTable | None = None
    tables: ForceTables | None = None

    @model_validator(mode="after")
    def _one(self) -> Self:
        if sum(value is not None for _, value in self) != 1:
            raise ValueError(f"one of {', '.join(type(self).model_fields)}")
        return self

    @property
    def at_nominal_voltage(self) -> "ForceCurve":
        """The same curve; if it depends on the voltage, its table at the nominal voltage."""
        return self if self.tables is None else ForceCurve(table=self.tables.at_usual)

    def force(self, command: Array, voltage: Array | None = None) -> Array:
        """Forces (m, ...), N, of commands (m, ...) in [-1, 1]; `voltage` (m,) of the battery, V."""
        if self.tables is not None:
            return self.tables.force(command, voltage)
        curve = self.quadratic or self.table
        return curve.force(command) if curve else self._polynomial(command)

    def _polynomial(self, command: Array) -> Array:
        force, power = np.zeros_like(command), command
        for a in self.odd_polynomial or ():
            force = force + a * power
            power = power * command * command
        return force
