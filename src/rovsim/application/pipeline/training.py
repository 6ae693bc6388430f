"""Train a residual on top of a model, and time its predictions."""

from pathlib import Path
from typing import Iterable, Mapping, Sequence

from rovsim.application.sections import PredictorSettings, TrainingSettings
from rovsim.core.files import appearing_together
from rovsim.core.progress import reported
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.learned.residual import write_residual
from rovsim.dynamics.model import Model
from rovsim.dynamics.model_file import read_model, write_model
from rovsim.evaluation.latency import time_both_ways
from rovsim.learning.learner import train as fit
from rovsim.learning.pairs import gather_pairs
from rovsim.measurement.signals.motion import Motion
from rovsim.results.timing import Timing
from rovsim.simulation.samples import sample_run


def train(
    motions: Iterable[Motion],
    base: Model,
    settings: TrainingSettings,
    catalogue: Catalogue,
    out: Path,
    story: Mapping[str, object],
) -> Model:
    """Train a residual on the train runs of one control, and write it as a model file.

    Args:
        motions: runs, taken one after the other; those of the control and of split `train` are
            learned from.
        base: the model whose acceleration is corrected.
        settings: the learner, and how runs were cleaned and are replayed.
        catalogue: all effects.
        out: the model file; the residual's arrays are written beside it.
        story: further entries of the model's provenance.

    Returns:
        The model as read back from its file.

    Raises:
        BadInput: the model has a residual already, or no run is left to learn from.
    """
    learner = settings.learner
    with reported(f"training {learner.kind}") as progress:
        examples = gather_pairs(
            base,
            motions,
            settings.control,
            learner.features,
            settings,
            settings.seed,
        )
        residual = fit(*examples.pairs, learner, settings.seed, progress, control=settings.control)
    facts = {"base": base.name, "train_runs": examples.runs, "train_rows": examples.rows}
    facts |= {"seed": settings.seed}
    # both files appear together: a model never refers to the arrays of another training
    with appearing_together(out.parent, last=out.name) as folder:
        stored = write_residual(folder, residual)
        write_model(base, folder / out.name, stored, {**facts, **story})
    return read_model(out, catalogue)


def time_predictors(
    models: Sequence[Model], base: Model, motion: Motion, settings: PredictorSettings
) -> Timing:
    """Time the library call and the exported predictor of each residual, on one run.

    Args:
        models: those without a residual are skipped.
        base: the model on which features are computed.
        motion: the run.
        settings: how long is measured.
    """
    pairs, timing = sample_run(base, motion, settings), settings.timing
    return Timing(
        inference={
            model.name: time_both_ways(
                residual,
                pairs.features(residual.features),
                timing.calls,
                timing.warmup,
                timing.seconds,
            )
            for model in models
            if (residual := model.residual) is not None
        }
    )
