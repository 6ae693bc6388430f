"""`pitfalls.json`: what mistakes of the thesis' public code cost, on each held-out run."""

from typing import ClassVar, Literal

from pydantic import Field

from rovsim.core.schema import Section
from rovsim.results.base import Result


class Cost(Section):
    """The same number measured right, and with the mistake."""

    right: float | None
    wrong: float | None


class Pitfalls(Result):
    """Costs by run and mistake."""

    noun: ClassVar[str] = "list of pitfalls"
    command: ClassVar[str] = "the study of the folds"

    schema_: Literal["rovsim.pitfalls/1"] = Field(default="rovsim.pitfalls/1", alias="schema")
    runs: dict[str, dict[str, Cost]]
