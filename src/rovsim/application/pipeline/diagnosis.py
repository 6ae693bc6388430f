"""Diagnose which effects a model lacks."""

from dataclasses import replace
from typing import Callable, Mapping

from rovsim.application.pipeline.models import require_physics
from rovsim.core.progress import staged
from rovsim.diagnosis.campaign_diagnosis import STAGES, CampaignDiagnosis, diagnose_campaign
from rovsim.diagnosis.settings import DiagnosisSettings
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.model import Model
from rovsim.measurement.runs import Runs
from rovsim.results.error_conditions import ErrorConditions


def diagnose(
    runs: Runs,
    base: Model,
    settings: DiagnosisSettings,
    catalogue: Catalogue,
    recordings: Mapping[str, str],
    failing: Callable[[ErrorConditions], None] = lambda where: None,
) -> CampaignDiagnosis:
    """Diagnose a model of physics on the train runs, and measure the improvement on the test runs.

    Args:
        runs: of the campaign.
        base: the model that may lack effects.
        settings: how it is diagnosed.
        catalogue: all effects.
        recordings: digests of the files that the runs were read from (`digest_recordings`), which
            the diagnosis keeps.
        failing: called with the conditions under which the base fails, as soon as they are known.

    Raises:
        BadInput: the model has a trained residual, or no physics.
    """
    require_physics(base, "diagnose")
    with staged("diagnosing", STAGES) as stage:
        diagnosed = diagnose_campaign(runs, base, settings, catalogue, stage, failing)
    diagnosis = diagnosed.diagnosis.model_copy(update={"recordings": dict(recordings)})
    return replace(diagnosed, diagnosis=diagnosis)
