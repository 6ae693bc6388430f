"""`ladder.json`: the error falling, step by step, on runs that no step was fitted to."""

from typing import ClassVar, Literal, Sequence

from pydantic import Field

from rovsim.core.model_names import EFFECTS, NOISE_FLOOR, NOMINAL
from rovsim.core.schema import Section
from rovsim.results.base import ByAxis, Result

ADDED_PREFIX = "+"  # begins the name of a step at which a diagnosis added an effect


class LadderStep(Section):
    """Errors of one model in 2 s windows, all runs of the split pooled; None where unknown.

    `windows_2s` is the velocity RMSE in units of the measured velocity's standard deviation, mean
    over axes.
    """

    model: str
    split: str = "test"
    acceleration_rmse: ByAxis = ByAxis()
    velocity_mae: ByAxis = ByAxis()
    windows_2s: float | None = None

    @property
    def scored(self) -> bool:
        """Whether there is an error on some axis: not without a run, nor where it runs away."""
        return any(value is not None for value in self.velocity_mae.model_dump().values())


class Ladder(Result):
    """Steps from the first model down; the noise floor, a bound and no model, comes last."""

    noun: ClassVar[str] = "ladder"
    command: ClassVar[str] = "the study"

    schema_: Literal["rovsim.ladder/1"] = Field(default="rovsim.ladder/1", alias="schema")
    steps: tuple[LadderStep, ...]

    @property
    def models(self) -> list[LadderStep]:
        """The steps but the noise floor."""
        return [step for step in self.steps if step.model != NOISE_FLOOR]

    @property
    def noise_floor(self) -> float | None:
        """`windows_2s` of a perfect model, if known."""
        return next((s.windows_2s for s in self.steps if s.model == NOISE_FLOOR), None)

    @property
    def errors(self) -> dict[str, float]:
        """`windows_2s` by model, where it is known, with the model `effects`.

        Of that one the steps are its effects, one by one: the last of them has all, and where
        none was selected it is the nominal model.
        """
        complete = next((s for s in reversed(self.steps) if s.model.startswith(ADDED_PREFIX)), None)
        steps = {step.model: step.windows_2s for step in self.models}
        steps[EFFECTS] = complete.windows_2s if complete else steps.get(NOMINAL)
        return {model: error for model, error in steps.items() if error is not None}

    @staticmethod
    def with_diagnosis(models: Sequence[LadderStep], diagnosed: Sequence[LadderStep]) -> "Ladder":
        """Models and a diagnosis: its effects one by one, its noise floor last.

        The effects stand where the model that has all of them would.
        """
        effects = [s for s in diagnosed if s.model.startswith(ADDED_PREFIX)]
        floor = [s for s in diagnosed if s.model == NOISE_FLOOR]
        steps = [s for m in models for s in (effects if m.model == EFFECTS else [m])]
        return Ladder(steps=(*steps, *floor))
