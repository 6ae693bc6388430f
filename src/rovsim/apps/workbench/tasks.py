"""Long work of the workbench, for another process: it does the same as the commands."""

from dataclasses import replace
from pathlib import Path

from rovsim.application.pipeline.comparison import compare
from rovsim.application.pipeline.diagnosis import diagnose
from rovsim.application.pipeline.measured_campaign import MeasuredCampaign, measure, open_campaign
from rovsim.application.pipeline.models import load_models, load_one_model
from rovsim.application.pipeline.training import train
from rovsim.application.provenance import provenance
from rovsim.application.sections import TrainingSettings
from rovsim.application.settings import CampaignSettings, WorkbenchSettings, select
from rovsim.core.progress import reported
from rovsim.design.settings import Question
from rovsim.diagnosis.settings import DiagnosisSettings
from rovsim.dynamics.catalogue import Catalogue, built_in, load_catalogue
from rovsim.dynamics.model import Model
from rovsim.intake.compose import propose
from rovsim.intake.proposal import CampaignProposal
from rovsim.results.diagnosis import Diagnosis
from rovsim.results.ladder import Ladder
from rovsim.simulation.synthetic_tank.campaign import make_campaign
from rovsim.simulation.synthetic_tank.settings import TankSettings


def diagnose_into(settings: WorkbenchSettings, path: Path) -> Diagnosis:
    """Diagnose settings.model; writes the result to `path`, and a proposed effect beside it.

    Returns:
        The diagnosis.
    """
    catalogue, data, base = _open(settings, even_unusable=True)
    options = select(settings, DiagnosisSettings)
    result = diagnose(data.campaign, data.runs, base, options, catalogue)
    result.write(path)
    return result.diagnosis


def train_into(settings: WorkbenchSettings, path: Path) -> Path:
    """Train a residual on top of settings.model; returns the model file, `path`."""
    catalogue, data, base = _open(settings)
    options = select(settings, TrainingSettings)
    story = provenance(options, catalogue, data.campaign)
    train(data.motions.values(), base, options, catalogue, path, story)
    return path


def design_into(settings: WorkbenchSettings, question: Question, out: Path) -> Path:
    """Plan the flight that answers a question; writes it as `rovsim design` does; returns `out`."""
    from rovsim.application.pipeline.design import design, write_flight  # takes a second

    catalogue, data, model = _open(settings)
    write_flight(out, design(data, model, question, catalogue))
    return out


def report_into(
    settings: WorkbenchSettings, ladder: Ladder, diagnosis: Diagnosis | None, out: Path
) -> Path:
    """Write report.html into `out`, and the results that it shows; returns its path."""
    from rovsim.reporting.html.folder import present

    catalogue = load_catalogue(settings.effect_files)
    data = measure(open_campaign(settings.campaign), settings.signals)
    models = load_models(settings.model, data.vehicle, catalogue)
    compared = compare(data, models, settings)
    tests = tuple(run for run in data.runs.of("test") if run in compared.drawn)
    report_data = replace(compared, ladder=ladder, diagnosis=diagnosis, drawn=tests)
    origin = provenance(select(settings, CampaignSettings), catalogue, data.campaign)
    present(out, data.campaign.name, report_data, origin, catalogue)
    for name in ("comparison", "where", "ladder", "diagnosis"):
        if result := getattr(report_data, name):
            result.write(out / f"{name}.json")
    return out / "report.html"


def _open(
    settings: WorkbenchSettings, even_unusable: bool = False
) -> tuple[Catalogue, MeasuredCampaign, Model]:
    """Load all effects, the campaign as measured, and the one model that the settings name."""
    catalogue = load_catalogue(settings.effect_files)
    data = measure(open_campaign(settings.campaign), settings.signals, even_unusable)
    return catalogue, data, load_one_model(settings.model, data.vehicle, catalogue)


def look_into(folder: Path, scratch: Path) -> CampaignProposal:
    """Propose a campaign.yaml for a folder of recordings; copies of these go into `scratch`."""
    return propose([folder], folder, scratch)


def practise(tank: TankSettings, out: Path) -> Path:
    """Make a synthetic campaign in the folder `out`, which it returns."""
    with reported("flying the practice campaign") as progress:
        make_campaign(tank, out, built_in(), progress)
    return out
