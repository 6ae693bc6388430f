"""Who pushes how much: `budget.json`, and over the time, part by part, what figures show."""

from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar, Literal

import numpy as np
from numpy import ndarray as Array
from pydantic import Field

from rovsim.core.array_files import read_arrays, write_arrays
from rovsim.core.schema import Section
from rovsim.results.base import ByAxis, Result

MISSING_PART = "missing"


class RunBudget(Section):
    """RMS force of every part of a model on one run, and of what is missing, N and N m."""

    model: str
    rms: dict[str, ByAxis]


class BudgetTotals(Result):
    """Budgets of one model, by run."""

    noun: ClassVar[str] = "budget of forces"
    command: ClassVar[str] = "`rovsim compare`"

    schema_: Literal["rovsim.budget/1"] = Field(default="rovsim.budget/1", alias="schema")
    runs: dict[str, RunBudget]


@dataclass(frozen=True, eq=False)
class ForceBudget:
    """Forces of one model at the measured states of one run, FRD at CO, N and N m.

    `time` (n,) s; `parts` (n, 6) by name, which add up to M nu_dot of the model; `missing` (n, 6)
    is M a_res: what would have to push for the model to move as measured (NaN where not usable, and
    on axes that nobody measured).
    """

    model: str
    run: str
    time: Array
    parts: dict[str, Array]
    missing: Array

    def rms(self) -> dict[str, ByAxis]:
        """Root mean square of every part and of what is missing, by axis, at usable instants."""
        usable = np.isfinite(self.missing).any(axis=1)
        forces = {**self.parts, MISSING_PART: self.missing}
        if not usable.any():
            return {name: ByAxis() for name in forces}
        return {
            name: ByAxis.of(np.sqrt(np.mean(force[usable] ** 2, axis=0)))
            for name, force in forces.items()
        }

    @property
    def totals(self) -> RunBudget:
        """What `budget.json` says of the run."""
        return RunBudget(model=self.model, rms=self.rms())

    def write(self, path: Path) -> None:
        """Write to `.npz`."""
        parts = {f"part/{name}": force for name, force in self.parts.items()}
        label = np.array([self.model, self.run])
        write_arrays(path, label=label, time=self.time, missing=self.missing, **parts)

    @staticmethod
    def read(path: Path) -> "ForceBudget":
        """Read what `write` wrote."""
        a = read_arrays(path)
        parts = {key.removeprefix("part/"): a[key] for key in a if key.startswith("part/")}
        return ForceBudget(str(a["label"][0]), str(a["label"][1]), a["time"], parts, a["missing"])
