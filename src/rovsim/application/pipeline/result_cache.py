"""Where diagnoses and flights are kept, to be found again if nothing they depend on changed."""

import hashlib
import json
from pathlib import Path

from rovsim.application.provenance import digest, digest_files
from rovsim.core.schema import Section
from rovsim.design.settings import Question
from rovsim.diagnosis.settings import DiagnosisSettings
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.model import Model
from rovsim.dynamics.model_file import describe_model
from rovsim.measurement.campaign import Campaign

# with all that they import
DIAGNOSIS_MODULE, PLAN_MODULE = "rovsim.diagnosis.campaign_diagnosis", "rovsim.design.plan"


def kept_folder(out: str | None, campaign: Campaign) -> Path:
    """Return the folder in which the workbench and notebooks keep results of a campaign."""
    return Path(out or f"results/{campaign.name}/ui")


def kept_diagnosis(
    folder: Path, campaign: Campaign, settings: DiagnosisSettings, base: Model, catalogue: Catalogue
) -> Path:
    """Return the file of a diagnosis of these recordings, settings, base, effects and code.

    If one of them changes, the file is another, so that an outdated diagnosis is never found.
    """
    key = _digest(campaign, settings, base, digest(DIAGNOSIS_MODULE, described=catalogue.files))
    return folder / key / "diagnosis.json"


def kept_flight(
    folder: Path, campaign: Campaign, question: Question, model: Model, catalogue: Catalogue
) -> Path:
    """Return the folder of a flight planned for these recordings, question, model and code."""
    key = _digest(campaign, question, model, digest(PLAN_MODULE, described=catalogue.files))
    return folder / "flights" / key


def _digest(campaign: Campaign, settings: Section, model: Model, code: str) -> str:
    content = hashlib.sha256()
    content.update(json.dumps(digest_files(campaign)).encode())
    content.update(settings.model_dump_json().encode())
    content.update(json.dumps(describe_model(model), sort_keys=True).encode())
    content.update(model.vehicle.model_dump_json().encode())  # a model may hold its name only
    content.update(code.encode())
    return content.hexdigest()[:12]
