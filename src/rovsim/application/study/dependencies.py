"""What a rule depends on beside its input files: a part of the settings, and code."""

from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, Mapping

from rovsim.application.configuration import compose
from rovsim.application.provenance import describe_given, digest, imports_of, own_digest
from rovsim.application.sections import TrainingSettings
from rovsim.application.settings import select
from rovsim.application.study.study import Study
from rovsim.core.schema import Section
from rovsim.dynamics.vehicle import vehicle_file
from rovsim.learning.learner import learner_settings
from rovsim.measurement.campaign import Campaign

# Left out of digests, with all that they alone import: settings are parameters of rules already.
SURROUNDING_MODULES = {
    f"rovsim.application.{name}" for name in ("snakemake_job", "sections", "settings")
}


@dataclass(frozen=True)
class Dependencies:
    """Settings as JSON and digests of code; a rule runs again where one of its own changes.

    Attributes:
        study: whose settings these are.
    """

    study: Study
    _residuals: dict[str, Mapping[str, object]] = field(default_factory=dict, init=False)

    def section(self, kind: type[Section]) -> str:
        """Return a part of the settings as JSON: what a rule reads, and runs again for."""
        return select(self.study.settings, kind).model_dump_json()

    def plain(self, kind: type[Section]) -> dict[str, Any]:
        """Return a part of the settings as plain values, for a rule that tells of it."""
        return select(self.study.settings, kind).model_dump(mode="json")

    def signal(self, *names: str) -> str:
        """Return the settings of parts of the signal chain as JSON."""
        return self.study.settings.signals.model_dump_json(include=set(names))

    def training(self, residual: str, control: str) -> str:
        """Return the settings that a trained residual depends on as JSON.

        Args:
            residual: kind of the residual.
            control: of the runs that it learns from.
        """
        choice = {"residual": self._residual(residual), "control": control}
        settings = self.study.settings.model_copy(update=choice)
        return select(settings, TrainingSettings).model_dump_json()

    def learner(self, kind: str) -> dict[str, Any]:
        """Return the settings of a kind of residual, even if the configuration chose another."""
        return learner_settings(self._residual(kind)).model_dump(mode="json")

    def _residual(self, kind: str) -> Mapping[str, object]:
        """Return the section of a kind of residual; composed once, since Hydra is slow."""
        if kind not in self._residuals:
            self._residuals[kind] = self._compose_residual(kind)
        return self._residuals[kind]

    def _compose_residual(self, kind: str) -> Mapping[str, object]:
        overrides = self.study.snakemake.overrides
        remaining = [override for override in overrides if not override.startswith("residual=")]
        if kind != self.study.settings.residual["kind"]:
            remaining = [override for override in remaining if not override.startswith("residual.")]
        return compose([*remaining, f"residual={kind}"]).residual

    def code(self, script: Path, *more: str, without: str = "") -> str:
        """Digest what a script imports, directly or indirectly: an edit re-runs what it touches.

        Args:
            script: of a rule.
            more: modules that it depends on without importing them.
            without: a package whose edits change nothing that the script writes.
        """
        names = (*imports_of(script), *more)
        return digest(*names, without=without, aside=SURROUNDING_MODULES, described=self._described)

    def own_code(self, package: str) -> str:
        """Digest a package without its imports.

        Thus a recorded campaign is not made again when rovsim's physics is edited.
        """
        return own_digest(f"rovsim.{package}", self._described)

    @cached_property
    def _described(self) -> list[Path]:
        """Files of the vehicle and of the user's effects: editing one changes what models do."""
        campaign = self.study.campaign
        if isinstance(campaign, Campaign):
            vehicle = vehicle_file(campaign.vehicle, named_in=campaign.file)
        else:
            vehicle = vehicle_file(self.study.settings.tank.vehicle)
        return [vehicle, *self.study.catalogue.files]

    def given(self) -> dict[str, Any]:
        """Describe settings and recordings of the study.

        The code is left out: whatever was edited, the report would be written again.
        """
        campaign = self.study.campaign if isinstance(self.study.campaign, Campaign) else None
        return describe_given(self.study.settings, campaign)
