"""Diagnose a model on a campaign: everything that `rovsim diagnose` reports."""

from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Iterator, Mapping, Sequence

import numpy as np

from rovsim.core.files import write_text
from rovsim.core.horizons import STANDARD_HORIZON, STANDARD_WINDOW
from rovsim.core.model_names import NOISE_FLOOR
from rovsim.core.progress import begin_stage, step
from rovsim.diagnosis.checks.clocks import find_shifts
from rovsim.diagnosis.checks.noise_floor import NoiseFloor, simulate_noise_floor
from rovsim.diagnosis.checks.standstills import find_standstills
from rovsim.diagnosis.diagnosis_document import CampaignContext, assemble_diagnosis
from rovsim.diagnosis.settings import DiagnosisSettings
from rovsim.diagnosis.train_diagnosis import TrainDiagnosis, diagnose_train_runs
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.effects.clocks import InputDelay
from rovsim.dynamics.model import Model
from rovsim.estimation.observer.train_runs import prepare_test, prepare_train
from rovsim.evaluation.error_conditions.entries import list_conditions
from rovsim.evaluation.error_conditions.search import ConditionSearch, SearchedModel
from rovsim.evaluation.error_metrics import subtract
from rovsim.evaluation.ladder import StepScore
from rovsim.measurement.runs import Runs
from rovsim.measurement.signals.motion import Motion
from rovsim.results.diagnosis import Diagnosis, Standstill, law_beside, times_above_floor
from rovsim.results.error_conditions import ErrorConditions
from rovsim.results.ladder import Ladder, LadderStep
from rovsim.simulation.replay import replay
from rovsim.simulation.samples import Samples, sample_run

# Share of the whole time after which a stage begins: means over the campaigns of conf/tank.
STAGES = {"reading": 0.0, "observing": 0.01, "searching": 0.42, "checking": 0.88, "scoring": 0.95}


@dataclass(frozen=True, eq=False)
class CampaignDiagnosis:
    """What a diagnosis of a campaign gives.

    Attributes:
        diagnosis: as `diagnosis.json`.
        where: conditions under which the base fails, as `where.json`.
        effect_file: Python source of the law that is proposed; None where none is.
    """

    diagnosis: Diagnosis
    where: ErrorConditions
    effect_file: str | None = None

    def write(self, path: Path) -> None:
        """Write the diagnosis, and the proposed law beside it; without one, remove an older law."""
        law = law_beside(path)
        if self.effect_file is None:
            law.unlink(missing_ok=True)
        else:
            write_text(law, self.effect_file)
        self.diagnosis.write(path)


def diagnose_campaign(
    runs: Runs,
    recordings: Mapping[str, str],
    base: Model,
    settings: DiagnosisSettings,
    catalogue: Catalogue,
    failing: Callable[[ErrorConditions], None] = lambda where: None,
) -> CampaignDiagnosis:
    """Diagnose a model on a campaign; test runs are opened last, for the reported errors.

    Each of the STAGES is reported as it begins.

    Args:
        runs: of the campaign.
        recordings: digests of the files that the runs were read from, by path.
        base: the model that is diagnosed.
        settings: how the diagnosis decides, and how runs are filtered and replayed.
        catalogue: the effects that may be missing.
        failing: is told under which conditions the base fails, as soon as these are known.
    """
    begin_stage("reading")
    searched_models, standstills = (
        _scan_train_runs(base, runs, settings) if runs.of("train") else ([], ())
    )
    conditions = list_conditions(searched_models)
    failing(conditions)
    train = prepare_train(
        runs, settings.replay, catalogue, base.body.free, settings.search.most_seconds
    )
    diagnosis = diagnose_train_runs(base, train.runs, settings, catalogue)
    begin_stage("scoring")
    shares = [finding.share() for m in searched_models for finding in m.explanation.findings]
    steps, diverges_in = _climb(diagnosis, runs, settings)
    floor = _estimate_noise_floor(diagnosis, runs, settings, catalogue, steps[-1].windows_2s)
    floor_step = LadderStep(model=NOISE_FLOOR, windows_2s=floor.error if floor else None)
    context = CampaignContext(
        recordings,
        shares,
        Ladder(steps=(*steps, floor_step)),
        train.looked_at,
        standstills,
        diverges_in,
        train.unlogged,
        floor.times if floor else None,
        _compare_clocks(diagnosis, runs, settings, floor),
    )
    document = assemble_diagnosis(diagnosis, context, catalogue)
    return CampaignDiagnosis(
        document, conditions, diagnosis.proposed.source if diagnosis.proposed else None
    )


def _scan_train_runs(
    base: Model, runs: Runs, settings: DiagnosisSettings
) -> tuple[Sequence[SearchedModel], Sequence[Standstill]]:
    """Find under which conditions the base fails, and where vehicles stand still although it moves.

    Each run is sampled once for both.
    """
    search = ConditionSearch(base, set(runs.splits.values()), settings)

    def sampled() -> Iterator[tuple[Motion, Samples]]:
        for motion in map(runs.motions.__getitem__, runs.of("train")):
            samples = sample_run(base, motion, settings)
            search.add_samples(motion, samples)
            yield motion, samples

    standstills = find_standstills(sampled())
    for name in runs.of("test") if search.split == "test" else ():
        search.add_run(runs.motions[name])
    return [search.result], standstills


def _compare_clocks(
    diagnosis: TrainDiagnosis, runs: Runs, settings: DiagnosisSettings, floor: NoiseFloor | None
) -> dict[str, float]:
    """By how much logs of test runs are early, where clocks or test runs differ."""
    difference, like = diagnosis.difference, runs.of("train")
    if difference and difference.effect_id == InputDelay.id:
        delays = difference.values("delay")
        like = [min(delays, key=delays.__getitem__)]
    elif times_above_floor(diagnosis.verdict, floor.times if floor else None) is None:
        return {}
    own, tests = (map(runs.motions.__getitem__, names) for names in (like, runs.of("test")))
    return find_shifts(diagnosis.base, own, tests, settings)


def _climb(
    diagnosis: TrainDiagnosis, runs: Runs, settings: DiagnosisSettings
) -> tuple[Sequence[LadderStep], Sequence[str]]:
    """Make the ladder: errors of the base and with one effect more each, on the test runs.

    A proposed law, with the effects beside it, comes after all effects.

    Returns:
        Its steps, and ids of the test runs in which the base diverges.
    """
    models, window_settings = _list_models(diagnosis), settings.only(STANDARD_WINDOW)
    scores = [StepScore(model.name) for model in models]
    for name in runs.of("test"):
        motion = runs.motions[name]
        for model, score in zip(models, scores, strict=True):
            step()
            prediction = replay(model, motion, window_settings, open_loop=False)
            score.add(motion, subtract(motion, prediction.horizons[STANDARD_HORIZON]))
    return [score.step for score in scores], scores[0].diverges_in


def _list_models(diagnosis: TrainDiagnosis) -> list[Model]:
    """Models of the ladder: the base, one effect more each, and the proposed law, if any."""
    return [*diagnosis.models(), *([diagnosis.proposed.model] if diagnosis.proposed else [])]


def _estimate_noise_floor(
    diagnosis: TrainDiagnosis,
    runs: Runs,
    settings: DiagnosisSettings,
    catalogue: Catalogue,
    reached: float | None,
) -> NoiseFloor | None:
    """The noise floor: the error of a perfect model; None where it cannot be estimated.

    Part of what is taken for noise may be physics. If the floor is above the error `reached`, by
    more than chance, it is wrong.
    """
    if diagnosis.fit is None or reached is None:
        return None
    fit = diagnosis.proposed.fit if diagnosis.proposed else diagnosis.fit
    group_seconds = diagnosis.usable.runs[0].group_seconds
    free = diagnosis.base.body.free
    test = prepare_test(runs, settings.replay, catalogue, free, group_seconds)
    floor = simulate_noise_floor(
        _list_models(diagnosis)[-1], test, fit.noise, settings.signals, settings.seed
    )
    if floor is None or floor.error is None:
        return None
    # the error reached varies by chance, too: it is a root mean square over w windows
    chance = 1.0 / np.sqrt(2.0 * floor.windows)
    return None if floor.error > (1.0 + chance) * reached else floor
