"""`budget.json`: who pushes how much."""

from typing import ClassVar, Literal

from pydantic import Field

from rovsim.core.schema import Section
from rovsim.results.base import ByAxis, Result


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
