"""What most commands begin with: a campaign's motions and quality, and the models to compare."""

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rovsim.application.settings import Settings
from rovsim.core.errors import BadInput
from rovsim.core.progress import counted
from rovsim.diagnosis.of_campaign import Runs
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.model import Model
from rovsim.dynamics.model_file import load_model
from rovsim.dynamics.vehicle import Vehicle, load_vehicle
from rovsim.measurement.campaign import Campaign, load_campaign
from rovsim.measurement.quality_report import quality_of
from rovsim.measurement.recording import read_run, usable_reason
from rovsim.measurement.signals.chain import Stage, differentiated, filtered, resampled
from rovsim.measurement.signals.motion import Motion


@dataclass(frozen=True, eq=False)
class Measured:
    """A campaign as measured: motions by run, their poses before the filter, quality reports."""

    campaign: Campaign
    vehicle: Vehicle
    motions: dict[str, Motion]
    quality: dict[str, dict[str, Any]]
    stages: dict[str, Stage]

    @property
    def runs(self) -> Runs:
        """The usable runs, as a diagnosis takes them."""
        return Runs(self.motions, self.stages)


def given_campaign(settings: Settings) -> Campaign:
    """The campaign of the settings.

    Raises:
        BadInput: none was given, or it cannot be read.
    """
    if settings.campaign is None:
        raise BadInput(
            "no campaign was given",
            where="command line",
            expected="campaign=DIR, a folder that holds campaign.yaml",
            remedy="`rovsim tank out=DIR` makes a synthetic one to try.",
        )
    return load_campaign(Path(settings.campaign))


def measured(settings: Settings, even_unusable: bool = False) -> Measured:
    """Read, check and clean all usable runs of the campaign.

    Raises:
        BadInput: the campaign cannot be read, or no run can be used, unless that is a result.
    """
    campaign = given_campaign(settings)
    motions, quality, stages = {}, {}, {}
    for run in counted(campaign.runs, "reading"):
        recording, anomalies = read_run(campaign, run.id)
        quality[run.id] = quality_of(recording, anomalies, settings.signals.outliers)
        if usable_reason(recording) is None:
            stages[run.id] = resampled(recording, settings.signals)
            motions[run.id] = differentiated(
                filtered(stages[run.id], settings.signals), settings.signals
            )
    if not motions and not even_unusable:
        reasons = "; ".join(f"{run}: {q['unusable']}" for run, q in quality.items())
        raise BadInput(
            f"no run can be used ({reasons})",
            where=campaign.file,
            expected="at least one run that moves and is long enough",
            remedy="Record longer runs in which the vehicle moves.",
        )
    return Measured(campaign, campaign_vehicle(campaign), motions, quality, stages)


def campaign_vehicle(campaign: Campaign) -> Vehicle:
    """The vehicle a campaign was recorded with."""
    return load_vehicle(campaign.vehicle, beside=campaign.file.parent)


def results_folder(path: str | Path) -> Path:
    """`path`, after a look whether results can be written there; the folder need not exist yet.

    Raises:
        BadInput: it or something on its way is a file, or may not be written to.
    """
    whole = Path(path).absolute()
    there = next(place for place in (whole, *whole.parents) if place.exists())
    if there.is_dir() and os.access(there, os.W_OK):
        return Path(path)
    raise BadInput(
        "may not be written to" if there.is_dir() else "is not a folder",
        where=there,
        expected="a folder that results can be written into",
        remedy="Give another out=.",
    )


def models(settings: Settings, vehicle: Vehicle, catalogue: Catalogue) -> list[Model]:
    """The models named in the settings, each once.

    Raises:
        BadInput: one cannot be loaded, or two files have the same stem.
    """
    specs = [settings.model] if isinstance(settings.model, str) else settings.model
    loaded = [load_model(spec, vehicle, catalogue) for spec in dict.fromkeys(specs)]
    names = [model.name for model in loaded]
    twice = {name for name in names if names.count(name) > 1}
    if twice:
        raise BadInput(
            f"two models are called '{twice.pop()}'",
            where="model",
            expected="different names (a model is called by its file's stem)",
            remedy="Rename one of the files.",
        )
    return loaded
