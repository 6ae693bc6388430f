"""Uncertainty bands of replays, and how much of the test runs lies inside them."""

from functools import partial
from typing import Mapping, Sequence

from rovsim.application.pipeline.measured_campaign import MeasuredCampaign
from rovsim.core.bounded_cache import Recent, Remade
from rovsim.core.horizons import STANDARD_HORIZON, STANDARD_WINDOW
from rovsim.core.progress import counted
from rovsim.dynamics.model import Model
from rovsim.evaluation.coverage import cover
from rovsim.measurement.signals.motion import Motion
from rovsim.results.bands import Bands, Coverage, ModelBands, RunBands
from rovsim.simulation.bands import predict_band, why_without_bands
from rovsim.simulation.prediction import BAND_LEVEL, Band
from rovsim.simulation.replay import find_spans
from rovsim.simulation.settings import SimulationSettings


def bands_when_asked(
    models: Sequence[Model], motions: Mapping[str, Motion], settings: SimulationSettings
) -> dict[str, Remade[Band | None]]:
    """Prepare uncertainty bands of the replays that figures show, in windows of 2 s.

    A band is computed when it is asked for; those asked for last are kept, for all models together.

    Returns:
        Bands by model and run, of models whose uncertainty is known.
    """
    recent = Recent[Band | None]()
    with_uncertainty = [model for model in models if model.uncertainty is not None]
    window_settings = settings.only(STANDARD_WINDOW)

    def of(model: Model, run: str) -> Band | None:
        spans = find_spans(motions[run], window_settings.replay, open_loop=False)[STANDARD_HORIZON]
        return predict_band(model, motions[run], spans, window_settings)

    return {m.name: Remade(motions, partial(of, m), recent=recent) for m in with_uncertainty}


def cover_test_runs(
    models: Sequence[Model], data: MeasuredCampaign, settings: SimulationSettings
) -> Bands | None:
    """Measure how much of the test runs lies in the models' bands, in windows of 2 s and longer.

    Returns:
        None where no model has bands.
    """
    runs = [run for run in data.runs.of("test") if run in data.motions]
    jobs = [
        (model, run)
        for model in models
        for run in runs
        if why_without_bands(model, data.motions[run]) is None
    ]
    by_model: dict[str, dict[str, RunBands]] = {}
    for model, run in counted(jobs, "drawing bands"):
        windows = _cover_run(model, data.motions[run], settings)
        if windows:
            split = data.quality[run].split
            by_model.setdefault(model.name, {})[run] = RunBands(split=split, windows=windows)
    if not by_model:
        return None
    models_of = {name: ModelBands(runs=runs) for name, runs in by_model.items()}
    return Bands(level=BAND_LEVEL, models=models_of)


def _cover_run(model: Model, motion: Motion, settings: SimulationSettings) -> dict[str, Coverage]:
    window_settings = settings.only(*(s for s in settings.replay.horizons if s >= STANDARD_WINDOW))
    coverage = {}
    for name, spans in find_spans(motion, window_settings.replay, open_loop=False).items():
        band = predict_band(model, motion, spans, window_settings) if spans else None
        if band is not None:
            coverage[name] = cover(motion, band, spans)
    return coverage
