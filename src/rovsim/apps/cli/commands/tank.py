"""Make a synthetic campaign of raw exports, its truth sealed beside it.

rovsim tank out=DIR [tank=default|lag|practice|rivals|tiny]
            [tank.seed=1] [tank.name=NAME]
            [tank.effects='[{effect: thruster_lag, parameters: {time_constant: 0.2}}]']
            [fly=OUT/experiment.csv]

fly: commands that `rovsim design` planned, flown as one more train run, called designed. The other
runs stay what they are without it.

DIR gets campaign.yaml, a QTM export and a command log per run, and truth.yaml.
"""

from itertools import count
from pathlib import Path

from rovsim.application.settings import WritingSettings
from rovsim.apps.cli.output import say
from rovsim.core.progress import reported
from rovsim.core.signs import minus
from rovsim.dynamics.catalogue import Catalogue
from rovsim.simulation.synthetic_tank.campaign import make_campaign
from rovsim.simulation.synthetic_tank.sent_log import described_by
from rovsim.simulation.synthetic_tank.settings import TankRun, TankSettings


class Settings(WritingSettings):
    """What `rovsim tank` takes."""

    tank: TankSettings
    fly: str | None


def run(settings: Settings, catalogue: Catalogue) -> None:
    """Fly the runs and write the folder."""
    out = Path(settings.out or settings.tank.raw_folder)
    tank, text = settings.tank, str(out)
    if settings.fly:
        tank, text = _with_flight(tank, settings.fly), f"{_begin(tank, settings.fly)}{text}"
    with reported("flying") as progress:
        make_campaign(tank, out, catalogue, progress)
    say(settings, text, {"campaign": str(out)})


def _begin(tank: TankSettings, fly: str) -> str:
    """Where a log is flown from, if no plan says so; else nothing."""
    if described_by(Path(fly)):
        return ""
    middle = (0.5 * sum(walls) for walls in (tank.tank.x, tank.tank.y, tank.tank.z))
    x, y, z = (minus(f"{place:g}") for place in middle)
    return (
        f"No {Path(fly).stem}.json lies beside {fly}: it is flown from the middle of the tank "
        f"(x {x} m, y {y} m, z {z} m, yaw 0).\n"
    )


def _with_flight(tank: TankSettings, fly: str) -> TankSettings:
    """With one more run, which a log of commands prescribes."""
    ids = [run.id for run in tank.runs]
    name = next(n for k in count(1) if (n := f"designed-{k}" if k > 1 else "designed") not in ids)
    run = TankRun(id=name, control="6dof", split="train", fly=fly)
    return tank.model_copy(update={"runs": (*tank.runs, run)})
