"""The two files beside the recordings: `campaign.yaml`, and `truth.yaml` with the hidden truth."""

from pathlib import Path
from typing import Any, Mapping, Sequence

from rovsim.core.axes import AXES
from rovsim.core.schema import Section, checked
from rovsim.dynamics.effects.base import Effect
from rovsim.dynamics.vehicle import known_vehicle, load_vehicle, vehicle_file
from rovsim.measurement.campaign_file import CampaignFile
from rovsim.simulation.synthetic_tank.settings import (
    PLACE_KEYS,
    Sensor,
    SensorKind,
    TankRun,
    TankSettings,
)

BODY_NAME = "vehicle"
CAMERA_SECTION = {"format": "qtm_tsv", "body": BODY_NAME, "world_axes": "z_up", "body_axes": "flu"}
TRUTH_FILE = "truth.yaml"  # nothing that reads a campaign may open it
VEHICLE_FILE = "vehicle.yaml"  # a copy of the user's, so that the folder can be moved


class HiddenEffect(Section):
    """A hidden effect of the catalogue, and its values that are not the defaults."""

    effect: str
    parameters: dict[str, float]


class OutsideEffect(Section):
    """A hidden effect that is not in the catalogue, and its values."""

    name: str
    parameters: dict[str, float]


class SealedTruth(Section):
    """The correct answer of a diagnosis, and the settings that make the same campaign again.

    Attributes:
        verdict: `missing_effects`, `unexplained` (there is physics outside the catalogue) or
            `adequate`.
        effects: hidden effects of the catalogue.
        outside: hidden physics that is not in the catalogue; None without any.
        settings: of the tank.
    """

    verdict: str
    effects: tuple[HiddenEffect, ...]
    outside: tuple[OutsideEffect, ...] | None = None
    settings: TankSettings


def own_vehicle(settings: TankSettings) -> Path | None:
    """Path of the file of a user's own vehicle; None for a vehicle that rovsim brings.

    Raises:
        BadInput: there is no such vehicle.
    """
    return None if known_vehicle(settings.vehicle) else vehicle_file(settings.vehicle)


def describe_campaign(settings: TankSettings) -> CampaignFile:
    """Describe a synthetic campaign as `campaign.yaml` does, without simulating anything.

    Raises:
        BadInput: the name of the campaign or of a run cannot be a file's.
    """
    columns = list(load_vehicle(settings.vehicle).command_columns)
    kind = settings.log.kind
    content = {
        "name": settings.name,
        "vehicle": VEHICLE_FILE if own_vehicle(settings) else settings.vehicle,
        "tank": _describe_walls(settings),
        "mocap": _describe_sensors(settings.sensors) if settings.sensors else CAMERA_SECTION,
        "commands": {
            "format": "csv",
            "kind": kind,
            "columns": columns if kind == "pwm" else list(AXES),
        },
        "runs": [
            {
                "id": run.id,
                "control": run.control,
                "split": run.split,
                "mocap": motion_file(settings, run),
                "commands": "none" if run.release else commands_file(run),
            }
            for run in settings.runs
        ],
    }
    return checked(CampaignFile, content, "the settings of the tank")


def motion_file(settings: TankSettings, run: TankRun) -> str:
    """Name of the file with the measured motion of a run."""
    return f"{run.id}.csv" if settings.sensors else f"{run.id}_6D.tsv"


def commands_file(run: TankRun) -> str:
    """Name of the file with the command log of a run."""
    return f"{run.id}_commands.csv"


def _describe_walls(settings: TankSettings) -> dict[str, list[float]]:
    """Walls of the tank, m, along the axes of the recordings: z up with cameras, else NED."""
    box = {axis: list(getattr(settings.tank, axis)) for axis in "xyz"}
    if settings.sensors:
        box |= {axis: [-high, -low] for axis, (low, high) in box.items() if axis != "x"}
    return box


def _describe_sensors(sensors: Mapping[SensorKind, Sensor]) -> dict[str, Any]:
    """Section `mocap` of `campaign.yaml` for recordings of other sensors than cameras."""
    delays = {kind: sensor.delay for kind, sensor in sensors.items() if sensor.delay}
    positions = {PLACE_KEYS[kind]: sensor.at for kind, sensor in sensors.items() if any(sensor.at)}
    extra = positions | ({"delay_s": delays} if delays else {})
    axes = {"world_axes": "ned", "body_axes": "frd"}
    return {"format": "csv", **axes, "velocity": "instant"} | ({"sensors": extra} if extra else {})


def seal(
    settings: TankSettings, hidden: Sequence[Effect], unlisted: Sequence[Effect]
) -> SealedTruth:
    """State the hidden truth of a campaign.

    Args:
        settings: of the tank.
        hidden: effects of the catalogue that the settings name.
        unlisted: hidden physics that the catalogue does not know.
    """
    return SealedTruth(
        verdict="unexplained" if unlisted else "missing_effects" if hidden else "adequate",
        effects=tuple(HiddenEffect(effect=e.id, parameters=e.given()) for e in hidden),
        outside=tuple(OutsideEffect(name=e.id, parameters=e.given()) for e in unlisted) or None,
        settings=settings,
    )
