"""Say which physical effects a model lacks, and how sure that is.

rovsim diagnose campaign=DIR out=OUT [model=nominal|FILE] [search.false_alarm=0.01]

Writes OUT/diagnosis.json and OUT/report.html. Only train runs are used to decide; the test runs are
opened once, for the errors that are reported. The model with the effects is then written by
`rovsim add diagnosis=OUT/diagnosis.json model=NEW.yaml`.
"""

from pathlib import Path

from rovsim.config import Settings
from rovsim.diagnosing import diagnosed
from rovsim.errors import BadInput
from rovsim.files import write_json
from rovsim.loading import measured, models
from rovsim.progress import staged
from rovsim.report.verdict import told


def run(settings: Settings) -> None:
    """Diagnose one model, write what was found, and say it."""
    data = measured(settings, even_unusable=True)
    chosen = models(settings, data.vehicle)
    if len(chosen) != 1 or chosen[0].residual is not None or chosen[0].inert:
        raise BadInput(
            f"cannot diagnose {', '.join(m.name for m in chosen)}",
            where="model",
            expected="one model of physics, without a trained residual",
            remedy="Give model=nominal, or one model file without a residual.",
        )
    out = Path(settings.out or f"results/{data.campaign.name}/diagnosis")
    with staged("diagnosing") as stage:
        found = diagnosed(data, chosen[0], settings, stage)
    write_json(out / "diagnosis.json", found)
    print(told(found))
    print(f"\n{out / 'diagnosis.json'}")
