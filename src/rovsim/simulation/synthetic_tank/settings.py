"""Settings of a synthetic campaign: runs, tank, cameras, sensors, log and hidden effects."""

import math
from fractions import Fraction
from typing import Annotated, Any, Literal, Mapping

import numpy as np
from numpy import ndarray as Array
from pydantic import Field, NonNegativeFloat, PositiveFloat, field_validator, model_validator

from rovsim.core.rotations import HALF_TURN_X
from rovsim.core.schema import Section
from rovsim.dynamics.effect_entry import EffectEntry
from rovsim.dynamics.effects.base import Requirement
from rovsim.dynamics.vehicle import default_vehicle

Share = Annotated[float, Field(ge=0, le=1)]
Interval = tuple[float, float]


SensorKind = Literal["position", "attitude", "depth", "velocity", "rates", "specific_force"]
# Of sensors that sit somewhere in the body, by the key of campaign.yaml that says where.
PLACE_KEYS: Mapping[SensorKind, str] = {
    "velocity": "velocity_at",
    "specific_force": "imu_at",
    "depth": "depth_at",
}


class Release(Section):
    """A vehicle that is let go without commands: how its initial state differs from rest.

    Attributes:
        pose: displacement along and about the body axes, from surge to yaw, m and rad.
        velocity: body velocity, m/s and rad/s.
    """

    pose: tuple[float, float, float, float, float, float] = (0.0,) * 6
    velocity: tuple[float, float, float, float, float, float] = (0.0,) * 6


class TankRun(Section):
    """One run to record: flown by a pilot, let go (`release`), or by a csv of commands (`fly`)."""

    id: str
    control: Literal["3dof", "6dof"]
    split: Literal["train", "test"]
    release: Release | None = None
    fly: str | None = None

    @model_validator(mode="after")
    def _one_of_both(self) -> "TankRun":
        if self.fly and self.release:
            raise ValueError("either 'release' or 'fly'")
        return self


class Box(Section):
    """Walls, floor and surface in MoCap world axes (z up), m."""

    x: Interval = (0.0, 10.0)
    y: Interval = (0.0, 5.0)
    z: Interval = (0.0, 3.0)

    @property
    def ned(self) -> Array:
        """Low and high walls (3, 2) in NED, m."""
        return np.sort(np.array([self.x, self.y, self.z]) * HALF_TURN_X[:, None], axis=1)


class Camera(Section):
    """Rate and errors of the motion capture."""

    rate: PositiveFloat = 100.0  # Hz, the usual setting for slow vehicles
    position_noise: NonNegativeFloat = 0.7e-3  # m, as in the practice exports
    attitude_noise: NonNegativeFloat = 2.0e-3  # rad, the same over a marker spread of 0.4 m
    # an error that lasts (Gauss-Markov): a calibration that differs from place to place, a marker
    # that comes and goes; standard deviations m and rad of each axis, and how long it lasts
    colour_noise: NonNegativeFloat = 0.0
    colour_attitude: NonNegativeFloat = 0.0
    colour_time: PositiveFloat = 0.5  # s, in which a slow vehicle moves by a marker's distance
    bursts_per_minute: NonNegativeFloat = 3.0  # bubbles and legs of the frame hide markers
    longest_burst: Annotated[int, Field(ge=1)] = 35  # frames
    outliers_per_minute: NonNegativeFloat = 3.0  # swapped markers, one frame each
    outlier_size: Interval = (0.05, 0.2)  # m, the distance between two markers


class Sensor(Section):
    """A sensor on board or ashore.

    Attributes:
        rate: of its readings, Hz.
        noise: standard deviation of the white noise of each component, in its unit.
        at: place in the body from CO, m FRD.
        delay: by how much its time stamps are late, s.
    """

    rate: PositiveFloat
    noise: NonNegativeFloat
    at: tuple[float, float, float] = (0.0, 0.0, 0.0)
    delay: float = 0.0


class Log(Section):
    """How the commands are logged: PWM per thruster, or what the pilot asks for per axis."""

    kind: Literal["pwm", "demand"] = "pwm"
    rate: PositiveFloat = 50.0  # Hz, what an autopilot streams
    jitter: NonNegativeFloat = 0.0  # s, standard deviation of a line's time stamp
    missing: Share = 0.01  # share of lines lost


class Turbulence(Section):
    """A Gauss-Markov wrench that is not logged, so that no model can predict it."""

    force: NonNegativeFloat = 0.35  # N, makes a perfect model err by some 8 mm/s after 2 s
    moment: NonNegativeFloat = 0.015  # N m, likewise some 20 mrad/s
    time_constant: PositiveFloat = 1.0  # s, eddies of 0.3 m passing at 0.3 m/s


class TankSettings(Section):
    """A campaign: its runs, its hidden effects, and everything random."""

    name: str = "tank"
    seed: Annotated[int, Field(ge=0)] = 0
    vehicle: str = Field(default_factory=default_vehicle)
    # s a run, whose frames are held at once
    duration: Annotated[float, Field(gt=0.0, le=7200.0)] = 60.0
    runs: Annotated[tuple[TankRun, ...], Field(min_length=1)] = (
        TankRun(id="3dof-1", control="3dof", split="train"),
        TankRun(id="3dof-2", control="3dof", split="test"),
        TankRun(id="6dof-1", control="6dof", split="train"),
        TankRun(id="6dof-2", control="6dof", split="test"),
    )
    tank: Box = Box()
    camera: Camera = Camera()
    sensors: dict[SensorKind, Sensor] = Field(default_factory=dict)  # in place of the cameras
    log: Log = Log()
    turbulence: Turbulence = Turbulence()
    effects: tuple[EffectEntry, ...] = ()  # hidden
    step: PositiveFloat = 0.001  # s, at most; Heun's error is then far below the noise

    @field_validator("sensors")
    @classmethod
    def _sit_at_the_origin(cls, sensors: dict[SensorKind, Sensor]) -> dict[SensorKind, Sensor]:
        """Refuse a place for kinds of sensors whose readings do not depend on it."""
        for kind, sensor in sensors.items():
            if kind not in PLACE_KEYS and any(sensor.at):
                raise ValueError(f"a sensor of {kind} has no place: leave `at` out")
        return sensors

    @model_validator(mode="after")
    def _has_a_step(self) -> "TankSettings":
        if self.steps_per_second > MAX_STEPS_PER_S:
            rates = " and ".join(f"{rate:g}" for rate in self._rates)
            raise ValueError(
                f"rates and a step that fit each other: {rates} Hz and at most {self.step:g} s ask "
                f"for more than {MAX_STEPS_PER_S} steps a second; whole numbers with a small "
                "common multiple ask for few"
            )
        return self

    @property
    def raw_folder(self) -> str:
        """Folder of its raw exports, unless another one is given."""
        return f"results/{self.name}/raw"

    @property
    def _rates(self) -> list[float]:
        """Rates of the frames, if there are cameras, and of the lines of the log, Hz."""
        return [*([] if self.sensors else [self.camera.rate]), self.log.rate]

    @property
    def steps_per_second(self) -> float:
        """Integration steps per second, so that each frame and each command falls on a step."""
        fractions = [Fraction(rate).limit_denominator(1000) for rate in self._rates]
        rates = [max(rate, Fraction(1, 1000)) for rate in fractions]
        shared = Fraction(
            math.lcm(*(rate.numerator for rate in rates)),
            math.gcd(*(rate.denominator for rate in rates)),
        )
        return float(math.ceil(1.0 / (self.step * float(shared)) - 1e-9) * shared)


MAX_STEPS_PER_S = 10_000  # a run of a minute then takes 60 MB


# Settings of a tank for effects that the default vehicle cannot show: one with room to go ahead for
# a vehicle with control surfaces, and one whose waves heave, list and trim a floating vehicle.
SUITABLE_TANKS: Mapping[Requirement, Mapping[str, Any]] = {
    "demands": {"log": {"kind": "demand"}},
    "surfaces": {
        "vehicle": "remus100",
        "tank": {"x": (0.0, 90.0), "y": (0.0, 90.0), "z": (0.0, 20.0)},
    },
    "waterplane": {
        "vehicle": "otter",
        "tank": {"x": (0.0, 120.0), "y": (0.0, 120.0), "z": (0.0, 10.0)},
        "turbulence": {"force": 40.0, "moment": 15.0, "time_constant": 0.3},
    },
}
