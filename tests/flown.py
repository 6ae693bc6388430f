"""One run of the tank, as the observer sees it."""

from pathlib import Path
from typing import Sequence

from rovsim.application.pipeline.recorded_run import load_campaign_vehicle
from rovsim.dynamics.catalogue import Catalogue, built_in
from rovsim.dynamics.effects.base import Effect
from rovsim.dynamics.model import Model, nominal
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.estimation.observer.train_runs import prepare_train
from rovsim.measurement.loading import load_campaign
from rovsim.measurement.recording import read_run
from rovsim.measurement.runs import Runs
from rovsim.measurement.signals.chain import SignalSettings, differentiated, filtered, resampled
from rovsim.simulation.settings import ReplaySettings
from rovsim.simulation.synthetic_tank.campaign import make_campaign
from rovsim.simulation.synthetic_tank.settings import TankRun, TankSettings


def observed(
    folder: Path,
    control: str = "6dof",
    catalogue: Catalogue | None = None,
    unlisted: Sequence[Effect] = (),
    **tank,
) -> tuple[Model, list[ObservedRun]]:
    """The nominal model, and one train run; `tank` are settings of the tank."""
    run = TankRun(id="a", control=control, split="train")
    settings = TankSettings(runs=(run,), **tank)
    make_campaign(settings, folder / "raw", catalogue or built_in(), unlisted=unlisted)
    campaign = load_campaign(folder / "raw")
    stage = resampled(read_run(campaign, "a")[0], SignalSettings())
    motion = differentiated(filtered(stage, SignalSettings()), SignalSettings())
    base, flown = (
        nominal(load_campaign_vehicle(campaign)),
        Runs({"a": motion}, {"a": stage}, {"a": "train"}),
    )
    return base, list(prepare_train(flown, ReplaySettings(), built_in(), base.body.free).runs)
