"""Train a residual on top of a model, and score it on the runs it did not see.

rovsim train campaign=DIR model=nominal|FILE residual=knn|gp|svgp control=3dof|6dof out=OUT

Writes OUT/model.yaml (accepted wherever a model is), OUT/residual.npz, OUT/comparison.json, and
an MLflow run. With -m, comma-separated values are swept: residual.k=1,3,5 control=3dof,6dof.
"""

from rovsim.config import Settings
from rovsim.errors import BadInput
from rovsim.files import write_json
from rovsim.loading import measured, models, results_folder
from rovsim.model import read_model
from rovsim.progress import reported
from rovsim.provenance import provenance
from rovsim.replay import replay
from rovsim.residual.storage import write_residual
from rovsim.scores import comparison, score
from rovsim.tracking import track
from rovsim.training import train_residual, training_runs


def run(settings: Settings) -> None:
    """Train, write, score, and log."""
    data = measured(settings)
    chosen = models(settings, data.vehicle)
    if len(chosen) != 1:
        raise BadInput(
            f"{len(chosen)} models",
            where="model",
            expected="one model to train on",
            remedy="Name one, or sweep over them with -m.",
        )
    base, motions = chosen[0], list(data.motions.values())
    name = f"{settings.learner.kind}_{settings.control}"
    out = results_folder(settings.out or f"results/{data.campaign.name}/trained/{name}")
    used = training_runs(motions, settings.control)
    with reported("training") as progress:
        trained = train_residual(
            base, used, settings.control, settings.learner, settings.signals, settings.replay,
            settings.seed, progress,
        )  # fmt: skip
    description = write_residual(out, trained, settings.control)
    story = provenance(settings) | {"train_runs": [m.run.id for m in used], "base": base.name}
    base.write(out / "model.yaml", description, story)
    corrected = read_model(out / "model.yaml")
    replays = [
        replay(model, m, settings.signals, settings.replay)
        for model in (base, corrected)
        for m in motions
    ]
    found = comparison(score(m, r) for m, r in zip(motions * 2, replays, strict=True))
    write_json(out / "comparison.json", found)
    track(
        settings.tracking,
        experiment=data.campaign.name,
        name=name,
        tags={"model": base.name, "residual": trained.kind, "control": settings.control},
        params=settings.residual | {"seed": settings.seed},
        scores=found["models"]["model"]["runs"],
        files=sorted(p for p in out.iterdir() if p.is_file()),
    )
    print(out / "model.yaml")
