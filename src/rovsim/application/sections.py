"""Sections of the configuration that several steps of the pipeline take."""

from typing import Any

from pydantic import Field, PositiveFloat, PositiveInt

from rovsim.core.schema import Section
from rovsim.dynamics.learned.settings import Control
from rovsim.learning.settings import LearnerSettings
from rovsim.measurement.signals.chain import SignalSettings
from rovsim.simulation.settings import ReplaySettings, SimulationSettings


class SimulationSections(SimulationSettings):
    """The sections `signals` and `replay`; a configuration has to have both, without defaults."""

    signals: SignalSettings
    replay: ReplaySettings


class TimingSettings(Section):
    """How long the inference of a residual is timed.

    Attributes:
        calls: of each predictor, one at a time.
        warmup: calls before these, not timed.
        seconds: after which no further call of a predictor starts.
    """

    calls: PositiveInt = 10000
    warmup: PositiveInt = 200
    seconds: PositiveFloat = 2.0


class PredictorSettings(SimulationSections):
    """How the predictions of trained residuals are timed."""

    timing: TimingSettings


class TrainingSettings(SimulationSections):
    """What a trained residual depends on.

    Attributes:
        residual: kind and settings of the learner, as in conf/residual.
        control: of the runs to learn from.
        seed: of the training.
    """

    residual: dict[str, Any]
    control: Control
    seed: int = Field(ge=0)

    @property
    def learner(self) -> LearnerSettings:
        """Checked settings of the learner.

        Raises:
            BadInput: there is no such learner, or a value is not allowed.
        """
        from rovsim.learning.learner import learner_settings  # slow: imports every learner

        return learner_settings(self.residual)
