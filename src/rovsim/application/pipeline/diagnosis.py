"""Which effects a model lacks."""

from rovsim.core.errors import BadInput
from rovsim.core.progress import staged
from rovsim.diagnosis.of_campaign import STAGES, Diagnosed, diagnose_campaign
from rovsim.diagnosis.settings import DiagnosisSettings
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.model import Model
from rovsim.measurement.runs import Runs


def diagnose(
    runs: Runs, base: Model, settings: DiagnosisSettings, catalogue: Catalogue
) -> Diagnosed:
    """Diagnose a model of physics: on the train runs, its worth on the test runs.

    Raises:
        BadInput: the model has a trained residual, or no physics.
    """
    if base.residual is not None or base.inert:
        raise BadInput(
            f"cannot diagnose {base.name}",
            where="model",
            expected="one model of physics, without a trained residual",
            remedy="Give model=nominal, or one model file without a residual.",
        )
    with staged("diagnosing", STAGES) as stage:
        return diagnose_campaign(runs, base, settings, catalogue, stage)
