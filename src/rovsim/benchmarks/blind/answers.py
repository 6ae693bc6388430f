"""Answers as they are kept: one JSON for each case and method."""

from typing import ClassVar, Literal

from pydantic import Field

from rovsim.benchmarks.blind.case import Case
from rovsim.results.bands import Bands
from rovsim.results.base import Result
from rovsim.results.diagnosis import Answer, Diagnosis


class KeptAnswer(Result):
    """What a method said to a case as it was flown; `error` where it crashed instead.

    `digest` of all that the answer depends on; `redrawn`: flown again with weaker effects;
    `seconds` by the clock, and of the processor; `bands` of the model it ends with.
    """

    noun: ClassVar[str] = "kept answer"
    command: ClassVar[str] = "`rovsim blind`"

    schema_: Literal["rovsim.blind/1"] = Field(default="rovsim.blind/1", alias="schema")
    digest: str
    method: str
    case: Case
    redrawn: bool
    seconds: float
    cpu_seconds: float | None = None
    diagnosis: Diagnosis | Answer | None = None
    bands: Bands | None = None
    error: str | None = None
