"""Runs of a sweep that are complete: kept where nothing that they depend on has changed."""

import hashlib
import json
from pathlib import Path

from rovsim.application.pipeline.models import load_models
from rovsim.application.pipeline.recorded_run import load_campaign_vehicle
from rovsim.application.provenance import provenance
from rovsim.application.settings import Settings
from rovsim.core.errors import BadInput
from rovsim.core.files import sha256_of
from rovsim.core.model_names import BUILT_IN
from rovsim.core.names import as_list
from rovsim.dynamics.catalogue import load_catalogue
from rovsim.dynamics.model_file import describe_model
from rovsim.measurement.loading import load_campaign
from rovsim.results.finished_run import FinishedRun

MARK = "finished.json"


def digest_inputs(settings: Settings, campaign: str) -> str:
    """Digest all that a run's results depend on, but not where they are written.

    These are settings, code and versions, the files of the campaign, its vehicle, and the models.

    Args:
        settings: of the run.
        campaign: folder of its campaign.

    Raises:
        BadInput: the campaign or a model cannot be read.
    """
    catalogue, opened = load_catalogue(settings.effect_files), load_campaign(Path(campaign))
    models = load_models(settings.model, load_campaign_vehicle(opened), catalogue)
    content = {
        "command": settings.command,
        "tracking": settings.tracking.model_dump(mode="json"),
        "models": [describe_model(model) for model in models],
        "vehicles": [model.vehicle.model_dump(mode="json", by_alias=True) for model in models],
        # with the digest of the arrays of a residual
        "files": [sha256_of(Path(m)) for m in as_list(settings.model) if m not in BUILT_IN],
        **provenance(settings, catalogue, opened),
    }
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def is_finished(folder: Path, inputs: str) -> bool:
    """Whether a run of these inputs is complete, and its files are still as it wrote them."""
    try:
        mark = FinishedRun.read(folder / MARK)
    except BadInput:
        return False
    written = _digest_written(folder)
    return mark.inputs == inputs and mark.files.items() <= written.items()


def mark_finished(folder: Path, inputs: str) -> None:
    """Mark the run of these inputs, whose results are in the folder, as complete."""
    FinishedRun(inputs=inputs, files=_digest_written(folder)).write(folder / MARK)


def _digest_written(folder: Path) -> dict[str, str]:
    """Digest the results in a folder; hidden files are what a killed writer left behind."""
    paths = [path for path in sorted(folder.rglob("*")) if path.is_file()]
    results = [
        path
        for path in paths
        if path != folder / MARK and path.suffix != ".log" and not path.name.startswith(".")
    ]
    return {path.relative_to(folder).as_posix(): sha256_of(path) for path in results}
