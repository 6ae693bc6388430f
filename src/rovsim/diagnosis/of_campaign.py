"""A model and a campaign's runs in, everything that `rovsim diagnose` reports out."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, Mapping, Sequence

from rovsim.diagnosis.checks.noise_floor import simulate_noise_floor
from rovsim.diagnosis.observer.observed_run import ObservedRun, prepare_run
from rovsim.diagnosis.procedure import TrainDiagnosis, diagnose
from rovsim.diagnosis.result import content
from rovsim.diagnosis.settings import DiagnosisSettings
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.model import Model
from rovsim.dynamics.model_file import describe_model
from rovsim.evaluation.error_conditions import content as where_content
from rovsim.evaluation.error_conditions import judged
from rovsim.evaluation.ladder import floor_step, ladder, step
from rovsim.measurement.signals.chain import Stage, read_stage
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.replay import replay
from rovsim.simulation.settings import ReplaySettings

# Share of the time that is over when a stage begins: means of the campaigns of conf/tank.
STAGES = {"reading": 0.0, "observing": 0.01, "searching": 0.42, "checking": 0.88, "scoring": 0.95}


@dataclass(frozen=True, eq=False)
class Runs:
    """Usable runs by id: as motions, and their poses before the filter."""

    motions: Mapping[str, Motion]
    stages: Mapping[str, Stage]

    @staticmethod
    def read(motions: Sequence[Path], stages: Sequence[Path]) -> "Runs":
        """Runs from what the signal chain wrote, in the same order; unusable ones are left out."""
        pairs = zip(map(Motion.read, motions), map(read_stage, stages), strict=True)
        usable = [(motion, stage) for motion, stage in pairs if motion.usable.any()]
        return Runs(
            {motion.run.id: motion for motion, _ in usable},
            {motion.run.id: stage for motion, stage in usable},
        )

    def prepare(
        self, split: str, settings: ReplaySettings, catalogue: Catalogue
    ) -> list[ObservedRun]:
        """The runs of one split as the observer sees them."""
        chosen = {run: m for run, m in self.motions.items() if m.run.split == split}
        return [
            prepare_run(self.stages[run], motion, settings, catalogue)
            for run, motion in chosen.items()
        ]


@dataclass(frozen=True, eq=False)
class Diagnosed:
    """`diagnosis.json`, and `where.json` of the model that was diagnosed."""

    content: dict[str, Any]
    where: dict[str, Any]


def diagnosed(
    runs: Runs,
    base: Model,
    settings: DiagnosisSettings,
    catalogue: Catalogue,
    stage: Callable[[str], None],
) -> Diagnosed:
    """Diagnose a model on a campaign; test runs are opened last, for the reported errors."""
    stage("reading")
    train, test = (runs.prepare(split, settings.replay, catalogue) for split in ("train", "test"))
    found = diagnose(
        base, train, settings.search, catalogue=catalogue, seed=settings.seed, stage=stage
    )
    stage("scoring")
    motions = [w.motion for w in train]
    fails = [judged(base, motions, settings.signals, settings.replay)] if motions else []
    entries = [finding.entry() for one in fails for finding in one.where.findings]
    steps = _steps(found, test, settings)
    said = content(found, entries, _errors(steps), describe_model(base), catalogue)
    return Diagnosed(said | {"ladder": ladder(steps)}, where_content(fails))


def _steps(
    found: TrainDiagnosis, test: list[ObservedRun], settings: DiagnosisSettings
) -> list[dict[str, Any]]:
    """The base, the effects one after the other, and the noise floor, on the test runs."""
    motions = [w.motion for w in test]
    horizons = settings.replay.model_copy(update={"horizons": (2.0,)})
    steps = [
        step(one.name, motions, [replay(one, m, settings.signals, horizons) for m in motions])
        for one in found.models()
    ]
    reached = [s["windows_2s"] for s in steps if s["windows_2s"] is not None]
    return [*steps, floor_step(_floor(found, test, settings, reached))]


def _floor(
    found: TrainDiagnosis,
    test: list[ObservedRun],
    settings: DiagnosisSettings,
    reached: list[float],
) -> float | None:
    """At most what was reached: where a model came below, part of the noise is structure."""
    if found.fit is None or not test:
        return None
    floor = simulate_noise_floor(
        found.models()[-1], test, found.fit.noise, settings.signals, settings.seed,
    )  # fmt: skip
    return None if floor is None else min([floor, *reached])


def _errors(steps: list[dict[str, Any]]) -> dict[str, float | None]:
    """Errors of contract section 3; None where there is nothing to score."""
    *models, floor = (one["windows_2s"] for one in steps)
    return {"nominal": models[0], "with_effects": models[-1], "noise_floor": floor}
