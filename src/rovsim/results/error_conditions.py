"""`where.json`: under which conditions each model fails."""

from typing import ClassVar, Iterable, Literal

from pydantic import Field

from rovsim.core.schema import Section
from rovsim.results.base import Result

BLOCK_S = 0.5  # over which errors are averaged
THROUGHOUT = "throughout"  # the condition that holds all the time: of an error that is constant


class ConditionShare(Section):
    """Share of one axis' squared error that varies with a condition.

    `push` in N or N m that a constant error stands for; None where it varies with something, and in
    files of earlier versions.
    """

    axis: str
    condition: str
    share_of_error: float
    push: float | None = None


class ConditionFinding(ConditionShare):
    """A share beyond chance.

    `unit` of the error; `chance` of such a share by accident; `alike` conditions that explain it
    nearly as well; `sentence` says it all in plain language.
    """

    unit: str
    chance: float
    alike: tuple[str, ...]
    sentence: str


class ErrorSize(Section):
    """RMS of the acceleration error and of the measured acceleration, m/s2 or rad/s2."""

    rms: float | None
    measured_rms: float | None


class ConditionTable(Section):
    """Error of one axis in n bins of a condition: one value a bin, n + 1 `edges`.

    `unit` of the condition; `judged`: visited often enough; `effective` number of blocks as if
    they were independent; `std_error` of the `mean`.
    """

    unit: str
    share_of_error: float
    edges: tuple[float, ...]
    center: tuple[float, ...]
    blocks: tuple[int, ...]
    effective: tuple[float, ...]
    judged: tuple[bool, ...]
    mean: tuple[float, ...]
    std_error: tuple[float, ...]
    rms: tuple[float, ...]


class ModelConditions(Section):
    """What was found for one model on `runs`, all of one split; `axes`: axis, then condition.

    `enough`: whether there was enough to judge anything.
    """

    split: str
    runs: tuple[str, ...]
    enough: bool
    error: dict[str, ErrorSize]
    sentences: tuple[str, ...]
    findings: tuple[ConditionFinding, ...]
    axes: dict[str, dict[str, ConditionTable]]


class ErrorConditions(Result):
    """Models in the order in which they were searched."""

    noun: ClassVar[str] = "search for conditions of the error"
    command: ClassVar[str] = "`rovsim compare`"

    schema_: Literal["rovsim.where/1"] = Field(default="rovsim.where/1", alias="schema")
    block_s: float = BLOCK_S
    models: dict[str, ModelConditions]

    @staticmethod
    def merged(parts: Iterable["ErrorConditions"]) -> "ErrorConditions":
        """One of several, their models in the order given."""
        return ErrorConditions(models={n: m for c in parts for n, m in c.models.items()})
