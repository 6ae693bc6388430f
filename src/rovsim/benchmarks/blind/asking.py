"""The diagnosis of rovsim as a method of the benchmark, with the settings that a user gets."""

from pathlib import Path

from rovsim.application.configuration import compose
from rovsim.application.pipeline.bands import cover_test_runs
from rovsim.application.pipeline.diagnosis import diagnose
from rovsim.application.pipeline.measured_campaign import measure
from rovsim.application.settings import select
from rovsim.core.progress import heard_by
from rovsim.diagnosis.apply import add_effects
from rovsim.diagnosis.settings import DiagnosisSettings
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.model import nominal
from rovsim.measurement.loading import load_campaign
from rovsim.results.bands import Bands
from rovsim.results.diagnosis import Diagnosis


def diagnosis(campaign: Path, out: Path) -> Diagnosis:
    """Diagnose a campaign as `rovsim diagnose` does, without its report.

    Args:
        campaign: its folder.
        out: not used.
    """
    settings = compose(["command=diagnose"])
    chosen_settings = select(settings, DiagnosisSettings)
    with heard_by():
        data = measure(load_campaign(campaign), settings.signals, even_unusable=True)
        base = nominal(data.vehicle)
        result = diagnose(data.campaign, data.runs, base, chosen_settings, built_in())
        return result.diagnosis


def bands(campaign: Path, diagnosis: Diagnosis) -> Bands | None:
    """Measure how much of the test runs lies in the bands of the model that a diagnosis ends with.

    Args:
        campaign: its folder.
        diagnosis: the diagnosis of the campaign.

    Returns:
        None where the model has no bands.
    """
    settings = compose(["command=compare"])
    with heard_by():
        data = measure(load_campaign(campaign), settings.signals, even_unusable=True)
        model = add_effects(diagnosis, campaign, "nominal", None, built_in()).model
        return cover_test_runs([model], data, settings)
