"""A campaign and a model in, the content of `diagnosis.json` out."""

from typing import Any, Callable

from rovsim.config import Settings
from rovsim.diagnosis.content import content
from rovsim.diagnosis.diagnose import Diagnosis, diagnose
from rovsim.diagnosis.floor import noise_floor
from rovsim.diagnosis.watch import Watch, watch
from rovsim.loading import Measured
from rovsim.model import Model
from rovsim.replay import replay
from rovsim.scores import step
from rovsim.where import judged


def diagnosed(
    data: Measured, base: Model, settings: Settings, stage: Callable[[str], None]
) -> dict[str, Any]:
    """Diagnose a model on a campaign; test runs are opened last, for the reported errors."""
    stage("reading")
    train, test = (watches(data, settings, split) for split in ("train", "test"))
    found = diagnose(base, train, settings.search, settings.replay.commands, settings.seed, stage)
    stage("scoring")
    motions = [m for m in data.motions.values() if m.run.split == "train"]
    where = (
        judged(base, motions, settings.signals, settings.replay).where.findings if motions else []
    )
    return content(
        found, [one.entry() for one in where], _errors(found, base, test, settings), base.content()
    )


def watches(data: Measured, settings: Settings, split: str) -> list[Watch]:
    """The runs of one split as the observer sees them."""
    return [
        watch(data.stages[run], motion, settings.replay.step)
        for run, motion in data.motions.items()
        if motion.run.split == split
    ]


def _errors(
    found: Diagnosis, base: Model, test: list[Watch], settings: Settings
) -> dict[str, float | None]:
    """Errors of contract section 3 on the test runs; None where there is nothing to score."""
    model = found.models()[-1]
    motions = [w.motion for w in test]
    horizons = settings.replay.model_copy(update={"horizons": (2.0,)})

    def error(one: Model) -> float | None:
        replays = [replay(one, m, settings.signals, horizons) for m in motions]
        return step(one.name, motions, replays)["windows_2s"] if motions else None

    floor = None
    if found.fit is not None and motions:
        floor = noise_floor(
            model, test, found.fit.noise, settings.signals, settings.replay.commands, settings.seed
        )
    nominal = error(base)
    return {
        "nominal": nominal,
        "with_effects": error(model) if found.selected else nominal,
        "noise_floor": floor,
    }
