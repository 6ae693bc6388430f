"""Make a synthetic campaign of raw exports, its truth sealed beside it.

rovsim tank out=DIR [tank=default|tiny] [tank.seed=1] [tank.name=NAME]
            [tank.effects='[{effect: thruster_lag, parameters: {time_constant: 0.2}}]']

DIR gets campaign.yaml, a QTM export and a command log per run, and truth.yaml.
"""

from pathlib import Path

from rovsim.application.settings import CommandSettings
from rovsim.apps.cli.output import say
from rovsim.core.progress import reported
from rovsim.dynamics.catalogue import Catalogue
from rovsim.simulation.synthetic_tank.campaign import make_campaign
from rovsim.simulation.synthetic_tank.settings import TankSettings


class Settings(CommandSettings):
    """What `rovsim tank` takes."""

    tank: TankSettings


def run(settings: Settings, catalogue: Catalogue) -> None:
    """Fly the runs and write the folder."""
    out = Path(settings.out or f"results/{settings.tank.name}/raw")
    with reported("flying") as progress:
        make_campaign(settings.tank, out, catalogue, progress)
    say(settings, str(out), {"campaign": str(out)})
