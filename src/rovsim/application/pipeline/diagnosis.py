"""Diagnose which effects a model lacks."""

from typing import Callable

from rovsim.application.pipeline.models import require_physics
from rovsim.application.provenance import digest_recordings
from rovsim.core.progress import staged
from rovsim.diagnosis.campaign_diagnosis import STAGES, CampaignDiagnosis, diagnose_campaign
from rovsim.diagnosis.settings import DiagnosisSettings
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.model import Model
from rovsim.measurement.campaign import Campaign
from rovsim.measurement.runs import Runs
from rovsim.results.error_conditions import ErrorConditions


def diagnose(
    campaign: Campaign,
    runs: Runs,
    base: Model,
    settings: DiagnosisSettings,
    catalogue: Catalogue,
    failing: Callable[[ErrorConditions], None] = lambda where: None,
) -> CampaignDiagnosis:
    """Diagnose a model of physics on the train runs, and measure the improvement on the test runs.

    Args:
        campaign: whose files the diagnosis keeps digests of (`digest_recordings`).
        runs: of the campaign.
        base: the model that may lack effects.
        settings: how it is diagnosed.
        catalogue: all effects.
        failing: called with the conditions under which the base fails, as soon as they are known.

    Raises:
        BadInput: the model has a trained residual, or no physics.
    """
    require_physics(base, "diagnose")
    recordings = digest_recordings(campaign)
    with staged("diagnosing", STAGES):
        return diagnose_campaign(runs, recordings, base, settings, catalogue, failing)
