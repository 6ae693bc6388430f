"""Show a diagnosis as figures, as a page, and as an MLflow run."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Mapping, Sequence

from rovsim.application.settings import TrackingSettings
from rovsim.application.tracking import track_diagnosis
from rovsim.core.errors import RovsimError
from rovsim.core.progress import heard_by
from rovsim.dynamics.catalogue import load_catalogue
from rovsim.reporting.html.picture import Drawn
from rovsim.reporting.report_data import ReportData


@dataclass(frozen=True, eq=False)
class ShownDiagnosis:
    """A diagnosis with all that is needed to show it; can be sent to another process.

    Attributes:
        out: folder that has the `diagnosis.json`.
        campaign: its name.
        base: name of the model that was diagnosed.
        data: the diagnosis, and what else figures need.
        provenance: of the diagnosis.
        effect_files: of effects that the catalogue has beside the built-in ones.
        params: settings of the diagnosis, nested plain values.
    """

    out: Path
    campaign: str
    base: str
    data: ReportData
    provenance: Mapping[str, object]
    effect_files: Sequence[Path]
    params: Mapping[str, Any]

    def show(self, drawn: Sequence[Drawn], tracking: TrackingSettings | None) -> str:
        """Write figures and page, and log everything to MLflow; no progress is shown.

        Args:
            drawn: figures that are drawn already.
            tracking: where MLflow is; None: nothing is logged.

        Returns:
            Why it could not be logged, which does not invalidate the diagnosis; else empty.
        """
        with heard_by():
            files = self.write(drawn)
            return self.track(tracking, files) if tracking else ""

    def write(self, drawn: Sequence[Drawn]) -> list[Path]:
        """Draw figures that are not yet `drawn`, and write the page; return all files."""
        from rovsim.reporting.html.folder import present  # slow, and not needed to send this object

        catalogue = load_catalogue(self.effect_files)
        return present(self.out, self.campaign, self.data, self.provenance, catalogue, drawn=drawn)

    def track(self, tracking: TrackingSettings, files: Sequence[Path]) -> str:
        """Log the diagnosis with these files; return why that failed, empty if it did not."""
        diagnosis = self.data.diagnosis
        assert diagnosis is not None
        artifacts = [self.out / "diagnosis.json", *files]
        try:
            track_diagnosis(tracking, self.campaign, self.base, diagnosis, self.params, artifacts)
        except (RovsimError, OSError) as error:
            return str(error)
        return ""
