"""Which models a study makes, draws, and searches for conditions of their errors."""

from dataclasses import dataclass
from functools import cached_property

from rovsim.application.study.study import Study
from rovsim.core.model_names import EFFECTS, NOMINAL, REFITTED, name_learned
from rovsim.dynamics.model import BASELINES

PHYSICS_MODELS = (REFITTED, EFFECTS)
DRAWN_MODELS = (NOMINAL, EFFECTS, "gp_6dof")  # few enough to be told apart in a time series


@dataclass(frozen=True)
class StudyModels:
    """Names of the models of a study."""

    study: Study

    @cached_property
    def trained(self) -> list[str]:
        """Models with a residual on the nominal one, for each control that has train runs."""
        section = self.study.settings.study
        controls = [c for c in section.controls if self.study.train_runs(c)]
        return [name_learned(kind, control) for kind in section.residuals for control in controls]

    @cached_property
    def on_effects(self) -> list[str]:
        """Models with a residual on top of the effects that were found."""
        selected = self.study.settings.study.on_effects
        return [f"{EFFECTS}+{name}" for name in self.trained if name in selected]

    @property
    def with_files(self) -> list[str]:
        """Models with a file of their own: all but the baselines."""
        return [*PHYSICS_MODELS, *self.trained, *self.on_effects]

    @property
    def all(self) -> list[str]:
        """Every model, in the order of the ladder."""
        return [*BASELINES, *self.with_files]

    @property
    def searched(self) -> list[str]:
        """Models of which conditions are sought where they fail; the last is reported first."""
        return [*self.trained, EFFECTS, NOMINAL]

    @property
    def drawn(self) -> list[str]:
        """Models drawn in time series."""
        return [m for m in DRAWN_MODELS if m in self.all] or self.all[:3]
