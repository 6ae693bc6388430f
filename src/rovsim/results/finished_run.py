"""`finished.json`: a run of a sweep that is complete, what it was made of, and what it wrote."""

from typing import ClassVar, Literal

from pydantic import Field

from rovsim.results.base import Result


class FinishedRun(Result):
    """Marks a run of a sweep as complete.

    Attributes:
        inputs: digest of all that its results depend on.
        files: digests of the files that it wrote, by path relative to its folder.
    """

    noun: ClassVar[str] = "mark of a finished run"
    command: ClassVar[str] = "the sweep"

    schema_: Literal["rovsim.finished/1"] = Field(default="rovsim.finished/1", alias="schema")
    inputs: str
    files: dict[str, str]
