"""Settings that every learner has."""

from rovsim.core.schema import Section
from rovsim.dynamics.learned.settings import FeatureSettings


class LearnerSettings(Section):
    """Settings that every learner has; each adds its own `kind` and hyperparameters."""

    kind: str
    features: FeatureSettings = FeatureSettings()
    max_points: int | None = None  # training rows kept; null: all
