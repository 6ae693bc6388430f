"""A diagnosis as figures, as a page, and as an MLflow run."""

from pathlib import Path
from typing import Any, Mapping, Sequence

from rovsim.application.settings import TrackingSettings
from rovsim.application.tracking import track_diagnosis
from rovsim.core.errors import RovsimError
from rovsim.dynamics.catalogue import load_catalogue
from rovsim.reporting.html.folder import present
from rovsim.reporting.html.picture import Drawn
from rovsim.reporting.report_data import ReportData


def show_diagnosis(
    out: Path,
    campaign: str,
    base: str,
    data: ReportData,
    drawn: Sequence[Drawn],
    provenance: Mapping[str, object],
    effect_files: Sequence[Path],
    params: Mapping[str, Any],
    tracking: TrackingSettings | None,
) -> str:
    """Draw what is not yet drawn, write the page, and log everything where there is MLflow.

    Returns why nothing could be logged, or nothing: the diagnosis stands without.

    Args:
        out: folder that has the `diagnosis.json`.
        campaign: its name.
        base: name of the model that was diagnosed.
        data: the diagnosis, and what else figures need.
        drawn: figures that are there already.
        provenance: of the diagnosis.
        effect_files: of effects that the catalogue has beside the built-in ones.
        params: settings of the diagnosis, nested plain values.
        tracking: where to log, None for nowhere.
    """
    found = data.diagnosis
    assert found is not None
    catalogue = load_catalogue(effect_files)
    files = present(out, campaign, data, provenance, catalogue, drawn=drawn)
    if tracking is None:
        return ""
    try:
        kept = [out / "diagnosis.json", *files]
        track_diagnosis(tracking, campaign, base, found, params, kept)
    except (RovsimError, OSError) as error:
        return str(error)
    return ""
