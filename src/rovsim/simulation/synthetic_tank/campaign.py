"""Make a whole synthetic campaign; its recordings appear complete or not at all."""

import os
from pathlib import Path
from typing import Callable, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput, RovsimError
from rovsim.core.files import copy_file, folder_beside, text_appearing
from rovsim.core.schema import checked
from rovsim.core.yaml_files import read_yaml, write_yaml
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.effect_entry import build_effects
from rovsim.dynamics.effects.base import Effect
from rovsim.dynamics.model import Model
from rovsim.dynamics.vehicle import load_vehicle
from rovsim.measurement.loading import check_ids
from rovsim.simulation.synthetic_tank.description import (
    TRUTH_FILE,
    VEHICLE_FILE,
    SealedTruth,
    commands_file,
    describe_campaign,
    motion_file,
    own_vehicle,
    seal,
)
from rovsim.simulation.synthetic_tank.exports import (
    choose_frames,
    export_commands,
    export_poses,
)
from rovsim.simulation.synthetic_tank.sensors import (
    Reading,
    draw_readings,
    export_channels,
    needed_steps,
)
from rovsim.simulation.synthetic_tank.sent_log import SentLog, read_sent_log
from rovsim.simulation.synthetic_tank.settings import TankRun, TankSettings
from rovsim.simulation.synthetic_tank.true_run import Flight, fly_run


def true_model(
    settings: TankSettings, catalogue: Catalogue, unlisted: Sequence[Effect] = ()
) -> Model:
    """Build the true model of the vehicle: nominal physics and all hidden effects.

    Raises:
        BadInput: a hidden effect that the catalogue does not know, or values it cannot have.
    """
    vehicle = load_vehicle(settings.vehicle)
    effects = catalogue.on(vehicle)
    hidden = build_effects(settings.effects, effects)
    return Model("truth", vehicle, vehicle.effects(), (*hidden, *unlisted))


def make_campaign(
    settings: TankSettings,
    out: Path,
    catalogue: Catalogue,
    progress: Callable[[int, int], None] = lambda a, b: None,
    unlisted: Sequence[Effect] = (),
) -> None:
    """Fly all runs and write the campaign to the folder `out`.

    The recordings of an earlier synthetic campaign in the folder are removed; other files stay.

    Args:
        settings: runs, tank, sensors and hidden effects.
        out: a folder that is new, empty or holds an earlier synthetic campaign.
        catalogue: effects that the settings can name.
        progress: called with the number of runs done and their total number.
        unlisted: hidden physics that the catalogue does not know.

    Raises:
        BadInput: `out` holds something that is not a tank campaign, or the name of the campaign or
            of a run cannot be a file's.
        LeftTank: the hidden effects are stronger than the pilot.
    """
    out = Path(os.path.abspath(out))  # '.' has neither name nor parent
    _refuse_other_files(out)
    check_ids(describe_campaign(settings).runs, "tank")  # before the flights, which take long
    model = true_model(settings, catalogue, unlisted)
    with folder_beside(out) as folder:
        _record_all(settings, model, unlisted, folder, progress)
        folder.chmod(0o755)
        _move(folder, out)


CAMPAIGN_FILE = "campaign.yaml"


def _move(new: Path, out: Path) -> None:
    """Move a new campaign to the folder `out`, and remove the recordings of an earlier one there.

    Files are moved one by one into a folder that exists, `truth.yaml` first and `campaign.yaml`
    last. If this is interrupted, the folder holds no complete campaign, but a tank may still write
    into it.
    """
    if not out.exists():
        os.replace(new, out)
        return
    stale = _list_written(out) - {path.name for path in new.iterdir()}
    for name in (CAMPAIGN_FILE, *sorted(stale)):
        (out / name).unlink(missing_ok=True)
    order = {TRUTH_FILE: 0, CAMPAIGN_FILE: 2}
    for path in sorted(new.iterdir(), key=lambda path: (order.get(path.name, 1), path.name)):
        os.replace(path, out / path.name)


def _list_written(out: Path) -> set[str]:
    """Names of the files that a tank wrote into a folder, according to its `truth.yaml`."""
    try:
        settings = checked(SealedTruth, read_yaml(out / TRUTH_FILE), out / TRUTH_FILE).settings
        describe_campaign(settings)  # no run leaves the folder
    except (RovsimError, OSError):
        return set()
    recordings = (
        name for run in settings.runs for name in (motion_file(settings, run), commands_file(run))
    )
    return {CAMPAIGN_FILE, TRUTH_FILE, VEHICLE_FILE, *recordings}


def _refuse_other_files(out: Path) -> None:
    """Refuse a folder with files, unless a tank wrote them."""
    if out.exists() and not (
        out.is_dir() and (not any(out.iterdir()) or (out / TRUTH_FILE).exists())
    ):
        raise BadInput(
            "holds files that no tank wrote",
            where=out,
            expected="a new folder, an empty one or an earlier tank campaign",
            remedy="Choose another folder with out=…",
        )


def _record_all(
    settings: TankSettings,
    model: Model,
    unlisted: Sequence[Effect],
    folder: Path,
    progress: Callable[[int, int], None],
) -> None:
    """Fly all runs, and write recordings, `campaign.yaml` and `truth.yaml` to `folder`."""
    runs, count = settings.runs, len(settings.effects)
    seeds = np.random.SeedSequence(settings.seed).spawn(len(runs))
    for k, (run, seed) in enumerate(zip(runs, seeds, strict=True)):
        progress(k, len(runs))
        _record(model, settings, run, folder, np.random.default_rng(seed))
    progress(len(runs), len(runs))
    campaign, truth = describe_campaign(settings), seal(settings, model.added[:count], unlisted)
    write_yaml(folder / CAMPAIGN_FILE, campaign.model_dump(mode="json", exclude_unset=True))
    if vehicle := own_vehicle(settings):
        copy_file(Path(vehicle), folder / VEHICLE_FILE)
    exclude = None if truth.outside else {"outside"}
    write_yaml(folder / TRUTH_FILE, truth.model_dump(mode="json", exclude=exclude))


def _record(
    model: Model, settings: TankSettings, run: TankRun, folder: Path, random: np.random.Generator
) -> None:
    """Fly one run, and write what was measured and commanded to `folder`."""
    tank, readings = settings.tank.ned, list[Reading]()

    def choose(total: int, step: float) -> Array:
        if not settings.sensors:
            return choose_frames(settings.camera, total, step)
        readings.extend(draw_readings(settings.sensors, total, step, random))
        return needed_steps(readings, total)

    flight = Flight(run.control, run.release, _read_sent(settings, run) if run.fly else None)
    truth = fly_run(model, settings, flight, random, choose)
    with text_appearing(folder / motion_file(settings, run)) as file:
        if settings.sensors:
            gravity = model.vehicle.fluid.gravity
            export_channels(truth, readings, float(tank[2, 0]), gravity, file)
        else:
            export_poses(truth, settings.camera, model.mocap_view, random, file)
    if not run.release:
        with text_appearing(folder / commands_file(run)) as file:
            export_commands(truth, settings.log, model.vehicle, random, file)


def _read_sent(settings: TankSettings, run: TankRun) -> SentLog:
    """Read the log of commands that prescribes a run."""
    log = describe_campaign(settings).commands
    assert run.fly is not None
    assert log is not None
    return read_sent_log(Path(run.fly), log, up=not settings.sensors)
