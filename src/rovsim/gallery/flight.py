"""One short run in a small tank with an effect hidden, and what the nominal model misses of it."""

import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy import ndarray as Array

from rovsim import AXES
from rovsim.campaign import load_campaign
from rovsim.effects.base import Autopilot, Effect
from rovsim.effects.parameters import Signature
from rovsim.model import EffectEntry, nominal
from rovsim.recording import read_run
from rovsim.replay import ReplaySettings
from rovsim.signals.chain import SignalSettings, clean
from rovsim.signals.motion import Motion
from rovsim.tank.campaign import make_campaign, true_model
from rovsim.tank.settings import Box, Camera, Log, TankRun, TankSettings, Turbulence
from rovsim.training import samples
from rovsim.where import Blocks, blocks, explain
from rovsim.where.bins import Table, binned, stretches, table

RUN = TankRun(id="run", control="6dof", split="train")


@dataclass(frozen=True, eq=False)
class Seen:
    """What is drawn: an axis' error over a condition and over time, n blocks.

    `missed` is the table of what the nominal model misses, `effect` that of what the true effect
    adds to the model; `error` and `added` (n,) are the same block by block at `time` (n,) s.
    """

    signature: Signature
    missed: Table
    effect: Table
    condition: Array
    time: Array
    error: Array
    added: Array


def settings(cls: type[Effect], signature: Signature) -> TankSettings:
    """A calm tank small enough for walls and surface to matter, cameras better than usual."""
    hidden = EffectEntry.model_validate({"effect": cls.id, "parameters": dict(signature.values)})
    return TankSettings(
        seed=3,
        runs=(RUN,),
        tank=Box(x=(0.0, 6.0), y=(0.0, 4.0), z=(0.0, 2.0)),
        camera=Camera(
            position_noise=1e-4, attitude_noise=3e-4, bursts_per_minute=0, outliers_per_minute=0
        ),
        log=Log(kind="demand" if issubclass(cls, Autopilot) else "pwm", missing=0.0),
        turbulence=Turbulence(force=0.1, moment=0.004),
        effects=(hidden,),
    )


def fly(tank: TankSettings) -> Motion:
    """The run as it is measured from its raw exports."""
    with tempfile.TemporaryDirectory() as folder:
        make_campaign(tank, Path(folder) / "raw")
        recording, _ = read_run(load_campaign(Path(folder) / "raw"), RUN.id)
    return clean(recording, SignalSettings())


def seen(cls: type[Effect], signature: Signature) -> Seen:
    """Hide the effect with the values of its signature, and look where it shows."""
    tank = settings(cls, signature)
    motion, truth = fly(tank), true_model(tank)
    missing, rest = (
        blocks(motion, samples(model, motion, SignalSettings(), ReplaySettings()))
        for model in (nominal(truth.vehicle), truth)
    )
    axis, name = shown(signature, missing)
    k = AXES.index(axis)
    condition, values = next((c, x) for c, x in missing.values.items() if c.name == name)
    error, added = missing.error[:, k], missing.error[:, k] - rest.error[:, k]
    stretch = stretches(missing, error)
    cut = binned(condition, values, stretch)
    tables = (table(cut, x, stretch) for x in (error, added))
    chosen = Signature(signature.values, axis, name, size=signature.size)
    return Seen(chosen, *tables, values, missing.time, error, added)


def shown(signature: Signature, missing: Blocks) -> tuple[str, str]:
    """Axis and condition: those declared, else those of the strongest finding."""
    if signature.axis and signature.condition:
        return signature.axis, signature.condition
    findings = explain(missing).findings
    if findings:
        return findings[0].axis, findings[0].condition
    loudest = np.mean(missing.error**2, axis=0) / np.mean(missing.measured**2, axis=0)
    return AXES[int(np.argmax(loudest))], "time in the run"
