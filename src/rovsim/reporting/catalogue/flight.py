"""Simulate a run with a hidden effect, and compare the nominal model with it for a picture."""

import tempfile
from pathlib import Path

from numpy import ndarray as Array

from rovsim.core.axes import AXES
from rovsim.core.errors import unlisted
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.effect_entry import describe_effect
from rovsim.dynamics.effects.base import Effect, Signature
from rovsim.dynamics.model import nominal
from rovsim.dynamics.vehicle import load_vehicle
from rovsim.evaluation.error_conditions.bins import bin_errors, cut_bins, number_stretches
from rovsim.evaluation.error_conditions.conditions import (
    Blocks,
    Condition,
    average_blocks,
    list_shown_conditions,
)
from rovsim.measurement.loading import load_campaign
from rovsim.measurement.recording import read_run
from rovsim.measurement.signals.chain import SignalSettings, clean
from rovsim.measurement.signals.motion import Motion
from rovsim.reporting.figures.signature import Seen
from rovsim.simulation.command_columns import mark_angles
from rovsim.simulation.samples import sample_run
from rovsim.simulation.settings import SimulationSettings
from rovsim.simulation.synthetic_tank.campaign import make_campaign, true_model
from rovsim.simulation.synthetic_tank.settings import (
    SUITABLE_TANKS,
    Box,
    Camera,
    Log,
    TankRun,
    TankSettings,
    Turbulence,
)

TANK_RUN = TankRun(id="run", control="6dof", split="train")


def settings(cls: type[Effect], signature: Signature) -> TankSettings:
    """Return settings of a tank in which an effect is hidden with the values of its signature.

    The water is calm, the cameras are better than usual, and the tank is small enough for walls and
    surface to matter. An effect of another kind of vehicle gets a tank that suits that vehicle.
    """
    calm = TankSettings(
        seed=3,
        runs=(TANK_RUN,),
        tank=Box(x=(0.0, 4.0), y=(0.0, 2.2), z=(0.0, 2.0)),
        duration=120.0,
        camera=Camera(
            position_noise=1e-4, attitude_noise=3e-4, bursts_per_minute=0, outliers_per_minute=0
        ),
        log=Log(missing=0.0),
        turbulence=Turbulence(force=0.1, moment=0.004),
        effects=(describe_effect(cls(**signature.values)),),
    )
    suitable = SUITABLE_TANKS.get(cls.requires, {})
    changes = {k: suitable[k] for k in ("vehicle", "tank") if k in suitable}
    log = calm.log.model_copy(update=suitable.get("log", {}))
    return TankSettings.model_validate({**dict(calm), **changes, "log": log})


def fly(tank: TankSettings, catalogue: Catalogue) -> Motion:
    """Simulate the run of a tank, and measure it from its raw exports."""
    with tempfile.TemporaryDirectory() as folder:
        make_campaign(tank, Path(folder) / "raw", catalogue)
        campaign = mark_angles(load_campaign(Path(folder) / "raw"), load_vehicle(tank.vehicle))
        recording, _ = read_run(campaign, TANK_RUN.id)
    return clean(recording, SignalSettings())


def seen(signature: Signature, tank: TankSettings, catalogue: Catalogue) -> Seen:
    """Compute the error of the nominal model in this tank, and the hidden effect's part of it."""
    motion, truth = fly(tank, catalogue), true_model(tank, catalogue)
    missing, remaining = (
        average_blocks(motion, sample_run(model, motion, SimulationSettings()))
        for model in (nominal(truth.vehicle), truth)
    )
    k = AXES.index(signature.axis)
    condition, values = find_condition(signature.condition, missing)
    error, added = missing.error[:, k], missing.error[:, k] - remaining.error[:, k]
    stretch = number_stretches(missing, error)
    cut = cut_bins(condition, values, stretch)
    missed, effect = (bin_errors(cut, x, stretch) for x in (error, added))
    return Seen(signature, missed, effect, values, missing.time, error, added)


def find_condition(name: str, missing: Blocks) -> tuple[Condition, Array]:
    """Return the condition of this name, and its values (n,) at n blocks.

    Raises:
        BadInput: there is no such condition.
    """
    conditions = {c.name: (c, x) for c, x in list_shown_conditions(missing).items()}
    if name in conditions:
        return conditions[name]
    raise unlisted(
        name, conditions, found=f"unknown condition '{name}'", where="the signature of an effect"
    )
