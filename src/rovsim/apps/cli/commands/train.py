"""Train a residual on top of a model, and score it on the runs it did not see.

rovsim train campaign=DIR model=nominal|FILE residual=knn|gp|svgp control=3dof|6dof|all out=OUT

Writes OUT/model.yaml (accepted wherever a model is), OUT/residual.npz, OUT/comparison.json, figures
of the errors, and an MLflow run. With -m, comma-separated values are swept: residual.k=1,3,5
control=3dof,6dof campaign=A,B; each combination has a folder of its own, in OUT if that is given.
Without a campaign that of the study is taken, once it is made. Needs the extras
rovsim[learn,tracking].
"""

from pathlib import Path
from typing import Mapping, Sequence

from rovsim.application.pipeline.models import load_one_model
from rovsim.application.pipeline.replays import score_models
from rovsim.application.pipeline.training import train
from rovsim.application.provenance import provenance
from rovsim.application.sections import TrainingSettings
from rovsim.application.settings import CampaignSettings, TrackingSettings
from rovsim.application.tracking import TrackedRun, ranking, tell_ranking, track
from rovsim.apps.cli.complaint import warn
from rovsim.apps.cli.opening import measure_campaign
from rovsim.apps.cli.output import say
from rovsim.core.errors import BadInput
from rovsim.core.extras import require
from rovsim.core.model_names import name_learned
from rovsim.core.names import as_list
from rovsim.core.progress import reported
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.learned.residual import ARRAYS_FILE
from rovsim.evaluation.score_collector import ScoreCollector
from rovsim.reporting.report_data import ReportData
from rovsim.reporting.words.terminal import tell_comparison, tell_doubts, tell_residual
from rovsim.results.comparison import Comparison
from rovsim.results.error_conditions import ErrorConditions
from rovsim.results.growth import Growth
from rovsim.results.quality import Quality
from rovsim.simulation.synthetic_tank.settings import TankSettings

MODEL_FILE = Path("model.yaml")  # in the folder that is written


class Settings(TrainingSettings, CampaignSettings):
    """What `rovsim train` takes; `tank`: the study whose campaign it is where none is given."""

    tracking: TrackingSettings
    tank: TankSettings


def run(settings: Settings, catalogue: Catalogue) -> None:
    """Train, write, score, and log."""
    from rovsim.reporting.html.folder import draw

    require("learn", "tracking", by="rovsim train")
    kind = settings.learner.kind
    name = name_learned(kind, settings.control)
    _check_name(settings.model)
    settings = _of_study(settings)
    data, out = measure_campaign(settings, f"trained/{name}")
    base = load_one_model(settings.model, data.vehicle, catalogue)
    file, story = out / MODEL_FILE, provenance(settings, catalogue, data.campaign)
    corrected = train(data.motions.values(), base, settings, catalogue, file, story)
    scored = score_models([base, corrected], data.motions, settings)
    comparison = scored.comparison
    comparison.write(out / "comparison.json")
    names = {base.name: base.name, corrected.name: name_learned(kind, settings.control, base.name)}
    pictures = draw(out, _collect_shown(scored, names, data.quality))
    errors = {step.model: step.windows_2s for step in scored.steps}
    with reported("logging to MLflow"):
        files = (file, out / ARRAYS_FILE, out / "comparison.json")
        run = TrackedRun(
            experiment=data.campaign.name,
            name=settings.tracking.name or name,
            tags={"model": base.name, "residual": kind, "control": settings.control},
            params=settings.residual | {"seed": settings.seed},
            scores=comparison.models[MODEL_FILE.stem].runs,
            files=[*files, *(path for picture in pictures for path in picture.files)],
            metrics=ranking(errors, corrected.name, base.name),
        )
        track(settings.tracking, run)
    by_name = {names[model]: error for model, error in errors.items()}
    text = tell_comparison(by_name, ErrorConditions(models={}), tested=bool(data.runs.of("test")))
    text += tell_residual(errors[base.name], errors[corrected.name]) + tell_doubts(data.quality)
    ranking_text = tell_ranking(settings.tracking, data.campaign.name)
    say(settings, f"{text}\n\n{file}\n\n{ranking_text}", {"model": str(file), "errors": errors})


def _of_study(settings: Settings) -> Settings:
    """With the synthetic campaign of the study, where none is given and that has been made."""
    folder = settings.tank.raw_folder
    if settings.campaign is not None or not Path(folder).is_dir():
        return settings
    warn(f"no campaign was given: that of the study is taken, {folder}")
    return settings.model_copy(update={"campaign": folder})


def _check_name(given: str | Sequence[str]) -> None:
    """Refuse a base that is called as what is trained will be: one would stand for the other."""
    for model in as_list(given):
        if Path(model).stem == MODEL_FILE.stem:
            raise BadInput(
                f"the base is called '{MODEL_FILE.stem}', as the model that is trained will be",
                where=f"model={model}",
                expected="another name (a model is called by its file's stem)",
                remedy="Copy the file, for example to base.yaml, and give that.",
            )


def _collect_shown(
    scored: ScoreCollector, titles: Mapping[str, str], quality: Mapping[str, Quality]
) -> ReportData:
    """What figures show of the errors, the models called by what they are."""
    comparison = {titles[name]: result for name, result in scored.comparison.models.items()}
    growth = {titles[name]: result for name, result in scored.growth.models.items()}
    return ReportData(
        comparison=Comparison(models=comparison), growth=Growth(models=growth), quality=quality
    )
