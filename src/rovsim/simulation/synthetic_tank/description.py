"""The two files beside the recordings: what a reader is told, and the sealed answer."""

from typing import Sequence

from rovsim import AXES
from rovsim.core.schema import Section, checked
from rovsim.dynamics.effects.base import Effect
from rovsim.dynamics.vehicle import load_vehicle
from rovsim.measurement.campaign_file import CampaignFile
from rovsim.simulation.synthetic_tank.settings import TankSettings

BODY = "vehicle"
SEALED = "truth.yaml"  # nothing that reads a campaign may open it


class HiddenEffect(Section):
    """An effect of the catalogue and its values, those at their default left out."""

    effect: str
    parameters: dict[str, float]


class OutsideEffect(Section):
    """Physics that no catalogue names."""

    name: str
    parameters: dict[str, float]


class SealedTruth(Section):
    """The answer, in the terms of the diagnosis, and how to make the campaign again."""

    verdict: str
    effects: tuple[HiddenEffect, ...]
    outside: tuple[OutsideEffect, ...] | None = None
    settings: TankSettings


def describe(settings: TankSettings) -> CampaignFile:
    """`campaign.yaml` of a tank, without simulating anything.

    Raises:
        BadInput: the name of the campaign or of a run cannot be a file's.
    """
    columns = list(load_vehicle(settings.vehicle).command_columns)
    kind = settings.log.kind
    content = {
        "name": settings.name,
        "vehicle": settings.vehicle,
        "tank": {axis: list(getattr(settings.tank, axis)) for axis in "xyz"},
        "mocap": {"format": "qtm_tsv", "body": BODY, "world_axes": "z_up", "body_axes": "flu"},
        "commands": {
            "format": "csv", "kind": kind, "columns": columns if kind == "pwm" else list(AXES),
        },
        "runs": [
            {**run.model_dump(), "mocap": f"{run.id}_6D.tsv", "commands": f"{run.id}_commands.csv"}
            for run in settings.runs
        ],
    }  # fmt: skip
    return checked(CampaignFile, content, "the settings of the tank")


def seal(
    settings: TankSettings, hidden: Sequence[Effect], unlisted: Sequence[Effect]
) -> SealedTruth:
    """The answer: effects that the settings name, and physics that they cannot."""
    return SealedTruth(
        verdict="unexplained" if unlisted else "missing_effects" if hidden else "adequate",
        effects=tuple(HiddenEffect(effect=e.id, parameters=e.given()) for e in hidden),
        outside=tuple(OutsideEffect(name=e.id, parameters=e.given()) for e in unlisted) or None,
        settings=settings,
    )
