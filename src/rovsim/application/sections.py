"""Sections of the configuration that several steps of the pipeline take."""

from typing import Any

from pydantic import Field, PositiveFloat, PositiveInt

from rovsim.core.schema import Section
from rovsim.dynamics.learned.settings import Control
from rovsim.learning.settings import LearnerSettings
from rovsim.measurement.signals.chain import SignalSettings
from rovsim.simulation.settings import ReplaySettings, SimulationSettings


class SimulationSections(SimulationSettings):
    """Both sections, as a configuration must have them: what it lacks is not made up."""

    signals: SignalSettings
    replay: ReplaySettings


class TimingSettings(Section):
    """How long inference is measured."""

    calls: PositiveInt = 10000
    warmup: PositiveInt = 200
    seconds: PositiveFloat = 2.0


class PredictorSettings(SimulationSections):
    """How the predictions of trained residuals are timed."""

    timing: TimingSettings


class TrainingSettings(SimulationSections):
    """What a trained residual depends on: which learner, on the runs of which control."""

    residual: dict[str, Any]
    control: Control
    seed: int = Field(ge=0)

    @property
    def learner(self) -> LearnerSettings:
        """The residual's own settings."""
        from rovsim.learning.learner import learner_settings  # with it every learner

        return learner_settings(self.residual, "conf/residual")
