"""Train a residual on top of a model, and score it on the runs it did not see.

rovsim train campaign=DIR model=nominal|FILE residual=knn|gp|svgp control=3dof|6dof|all out=OUT

Writes OUT/model.yaml (accepted wherever a model is), OUT/residual.npz, OUT/comparison.json, and
an MLflow run where rovsim[tracking] is installed. With -m, comma-separated values are swept:
residual.k=1,3,5 control=3dof,6dof. Needs the extra rovsim[learn].
"""

from rovsim.application.loading import measured, models, results_folder
from rovsim.application.pipeline import replayed, scored, train
from rovsim.application.settings import Settings
from rovsim.application.tracking import track
from rovsim.apps.cli.output import say
from rovsim.core.errors import BadInput
from rovsim.core.extras import installed, require
from rovsim.core.files import write_json
from rovsim.core.progress import reported
from rovsim.dynamics.catalogue import Catalogue


def run(settings: Settings, catalogue: Catalogue) -> None:
    """Train, write, score, and log."""
    require("learn", by="rovsim train")
    data = measured(settings)
    chosen = models(settings, data.vehicle, catalogue)
    if len(chosen) != 1:
        raise BadInput(
            f"{len(chosen)} models",
            where="model",
            expected="one model to train on",
            remedy="Name one, or sweep over them with -m.",
        )
    base = chosen[0]
    name = f"{settings.learner.kind}_{settings.control}"
    out = results_folder(settings.out or f"results/{data.campaign.name}/trained/{name}")
    corrected = train(data, base, settings, catalogue, out)
    replays = replayed(data, [base, corrected], settings)
    found = scored(list(data.motions.values()), replays)
    write_json(out / "comparison.json", found)
    if installed("tracking"):
        with reported("logging to MLflow"):
            track(
                settings.tracking,
                experiment=data.campaign.name,
                name=name,
                tags={
                    "model": base.name,
                    "residual": settings.learner.kind,
                    "control": settings.control,
                },
                params=settings.residual | {"seed": settings.seed},
                scores=found["models"]["model"]["runs"],
                files=sorted(p for p in out.iterdir() if p.is_file()),
            )
    say(settings, str(out / "model.yaml"), {"model": str(out / "model.yaml")})
