"""Answers as they are stored: one JSON file for each case and method."""

from typing import ClassVar, Literal

from pydantic import Field

from rovsim.benchmarks.blind.case import Case
from rovsim.results.bands import Bands
from rovsim.results.base import Result
from rovsim.results.diagnosis import Answer, Diagnosis


class KeptAnswer(Result):
    """The answer of a method to a case.

    Attributes:
        digest: of the case, and of the code and vehicle file that the answer depends on.
        method: its name.
        case: as it was flown.
        redrawn: whether the case was flown with weaker effects, or by another pilot, than it
            declares.
        seconds: wall-clock time of the method.
        cpu_seconds: processor time of the method.
        diagnosis: the answer; None where the method crashed.
        bands: how much of the test runs lies in the bands of the diagnosed model, if it has bands.
        error: message of the crash, if any.
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
