"""`pitfalls.json`: what mistakes of the thesis' public code cost, on each held-out run."""

from typing import ClassVar, Literal

from pydantic import Field

from rovsim.core.schema import Section
from rovsim.results.base import Result

RELATIVE_RMSE = "velocity RMSE of the open loop, in standard deviations of the measured velocity"
PREDICTED_SHARE = "share of the residual acceleration that is predicted"
# For each mistake, what was done, and which number is compared without it and with it.
PITFALLS = {
    "wrong clock": ("bins of about 0.157 s replayed as if each lasted 0.1 s", RELATIVE_RMSE),
    "copied runs": (
        "a '6-DoF' training set that holds copies of a 3-DoF run (KNN)",
        PREDICTED_SHARE,
    ),
    "lost data": ("a GP loaded with its hyperparameters but not its data", PREDICTED_SHARE),
    "scaled twice": ("features scaled before they reach a GP that scales them", PREDICTED_SHARE),
}


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
