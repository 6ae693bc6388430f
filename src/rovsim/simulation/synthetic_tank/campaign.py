"""A whole synthetic campaign: a folder that appears complete or not at all."""

import os
import shutil
import tempfile
from pathlib import Path
from typing import Any, Callable, Sequence

import numpy as np

from rovsim import AXES
from rovsim.core.errors import BadInput
from rovsim.core.files import write_text, write_yaml
from rovsim.core.rotations import HALF_TURN_X
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.effects.base import Effect
from rovsim.dynamics.model import Model
from rovsim.dynamics.model_file import build_effect
from rovsim.dynamics.vehicle import load_vehicle
from rovsim.simulation.synthetic_tank.exports import BODY, commands_csv, qtm_tsv
from rovsim.simulation.synthetic_tank.settings import TankRun, TankSettings
from rovsim.simulation.synthetic_tank.simulate import simulate

SEALED = "truth.yaml"  # nothing that reads a campaign may open it


def describe(settings: TankSettings) -> dict[str, Any]:
    """The content of `campaign.yaml`, without simulating anything."""
    thrusters = [unit.name for unit in load_vehicle(settings.vehicle).thrusters.units]
    kind = settings.log.kind
    columns = thrusters if kind == "pwm" else list(AXES)
    return {
        "name": settings.name,
        "vehicle": settings.vehicle,
        "tank": {axis: list(getattr(settings.tank, axis)) for axis in "xyz"},
        "mocap": {"format": "qtm_tsv", "body": BODY, "world_axes": "z_up", "body_axes": "flu"},
        "commands": {"format": "csv", "kind": kind, "columns": columns},
        "runs": [
            {**run.model_dump(), "mocap": f"{run.id}_6D.tsv", "commands": f"{run.id}_commands.csv"}
            for run in settings.runs
        ],
    }


def true_model(
    settings: TankSettings, catalogue: Catalogue, unlisted: Sequence[Effect] = ()
) -> Model:
    """The vehicle in the tank: nominal physics and all that is hidden.

    Raises:
        BadInput: a hidden effect that the catalogue does not know, or values it cannot have.
    """
    vehicle = load_vehicle(settings.vehicle)
    hidden = [build_effect(entry, catalogue) for entry in settings.effects]
    return Model("truth", vehicle, (*vehicle.effects(), *hidden, *unlisted))


def make_campaign(
    settings: TankSettings,
    out: Path,
    catalogue: Catalogue,
    progress: Callable[[int, int], None] = lambda a, b: None,
    unlisted: Sequence[Effect] = (),
) -> None:
    """Fly all runs and write the campaign to the folder `out`.

    Args:
        settings: what it is made of.
        out: a folder that is new, empty or an earlier tank campaign.
        catalogue: effects that the settings can name.
        progress: told how many runs are done, of how many.
        unlisted: hidden physics that the catalogue does not know.

    Raises:
        BadInput: `out` holds something that is not a tank campaign.
        LeftTank: the hidden effects are stronger than the pilot.
    """
    _replaceable(out)
    model = true_model(settings, catalogue, unlisted)
    out.parent.mkdir(parents=True, exist_ok=True)
    folder = Path(tempfile.mkdtemp(dir=out.parent, prefix=f".{out.name}-"))
    try:
        _fill(settings, model, unlisted, folder, progress)
        folder.chmod(0o755)
        shutil.rmtree(out, ignore_errors=True)
        os.replace(folder, out)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _replaceable(out: Path) -> None:
    if out.exists() and not (out.is_dir() and (not any(out.iterdir()) or (out / SEALED).exists())):
        raise BadInput(
            "holds files that no tank wrote",
            where=out,
            expected="a new folder, an empty one or an earlier tank campaign",
            remedy="Choose another folder with out=…",
        )


def _fill(
    settings: TankSettings,
    model: Model,
    unlisted: Sequence[Effect],
    folder: Path,
    progress: Callable[[int, int], None],
) -> None:
    runs = settings.runs
    seeds = np.random.SeedSequence(settings.seed).spawn(len(runs))
    for k, (run, seed) in enumerate(zip(runs, seeds, strict=True)):
        progress(k, len(runs))
        _record(model, settings, run, folder, np.random.default_rng(seed))
    progress(len(runs), len(runs))
    write_yaml(folder / "campaign.yaml", describe(settings))
    write_yaml(folder / SEALED, sealed(settings, model, unlisted))


def _record(model: Model, settings: TankSettings, run: TankRun, folder: Path, random) -> None:
    box = np.array([getattr(settings.tank, axis) for axis in "xyz"])
    tank = np.sort(box * HALF_TURN_X[:, None], axis=1)
    truth = simulate(model, settings, run.control, tank, random)
    write_text(
        folder / f"{run.id}_6D.tsv", qtm_tsv(truth, settings.camera, model.mocap_view, random)
    )
    write_text(folder / f"{run.id}_commands.csv", commands_csv(truth, settings.log, random))


def sealed(settings: TankSettings, model: Model, unlisted: Sequence[Effect]) -> dict[str, Any]:
    """The answer, in the terms of the diagnosis, and how to make the campaign again."""
    hidden = model.added[: len(settings.effects)]
    effects = [{"effect": e.id, "parameters": e.given()} for e in hidden]
    verdict = "unexplained" if unlisted else "missing_effects" if effects else "adequate"
    content: dict[str, Any] = {"verdict": verdict, "effects": effects}
    if unlisted:
        content["outside"] = [{"name": e.id, "parameters": e.given()} for e in unlisted]
    return {**content, "settings": settings.model_dump(mode="json")}
