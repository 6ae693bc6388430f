"""The keys of `campaign.yaml` as typed, checked fields."""

import re
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BeforeValidator, Field

from rovsim.core.axes import AXES
from rovsim.core.names import Name, as_list, is_name
from rovsim.core.rotations import BodyAxes, WorldAxes
from rovsim.core.schema import Axis, Number, PathText, Section
from rovsim.measurement.sensors import Sensors


def _as_text(value: Any) -> Any:
    # `id: 115750` is a number in YAML, and a name to its author
    return str(value) if type(value) in (int, float) else value


def _file_name(text: str) -> str:
    """Refuse names that cannot be file names on every system, or Snakemake wildcards."""
    unsafe = re.search(r'[/\\:*?"<>|{}]', text) or not is_name(text)
    if unsafe or not text or len(text) > 100 or text[0] in ".-~" or text != text.strip():
        raise ValueError(
            'a name that can be a file name: at most 100 characters, no / \\ : * ? " < > | { }, '
            "no control characters, no '.', '-' or '~' in front, no space around it"
        )
    return text


def _rising(expected: str) -> AfterValidator:
    """Make a validator that refuses two numbers unless the first is less than the second."""

    def check(value: list[float]) -> list[float]:
        if value[0] >= value[1]:
            raise ValueError(expected)
        return value

    return AfterValidator(check)


def _distinct(names: list[str]) -> list[str]:
    if len(set(names)) < len(names):
        raise ValueError("different names, each named once")
    return names


Text = Annotated[Name, BeforeValidator(_as_text), Field(min_length=1)]
FilePath = Annotated[PathText, BeforeValidator(_as_text), Field(min_length=1)]
LoggedKind = Literal["pwm", "normalized", "demand", "wrench"]
FileName = Annotated[str, BeforeValidator(_as_text), AfterValidator(_file_name)]
Two = Annotated[list[float], Field(min_length=2, max_length=2)]
Interval = Annotated[Two, _rising("[low, high] with low below high, in m")]
Span = Annotated[Two, _rising("[from, to] in s, the earlier time first")]


class Tank(Section):
    """Walls, floor and surface in MoCap world axes, m; an axis left out is unbounded."""

    x: Interval | None = None
    y: Interval | None = None
    z: Interval | None = None


class Topics(Section):
    """Topics of a ROS 2 bag, by the quantity that is read from each."""

    pose: Text | None = None
    odometry: Text | None = None
    imu: Text | None = None
    attitude: Text | None = None  # used instead of the attitude in `imu`
    depth: Text | None = None
    velocity: Text | None = None
    battery: Text | None = None


class Mocap(Section):
    """How the motion was exported.

    Attributes:
        format: name of the reader.
        body: the rigid body (or topic) to read.
        world_axes: axes of the file's world.
        body_axes: axes of the file's body.
        velocity: whether body velocities beside poses are means from their line to the next, or
            values at the line's time.
        sensors: places and delays of the sensors.
        topics: topics of a ROS 2 bag.
    """

    format: str
    body: Annotated[Name, BeforeValidator(_as_text)] = ""
    world_axes: WorldAxes
    body_axes: BodyAxes
    velocity: Literal["mean", "instant"] = "mean"
    sensors: Sensors = Sensors()
    topics: Topics | None = None


class CommandLog(Section):
    """How the commands were logged.

    Attributes:
        format: name of the reader.
        kind: what the columns hold: `pwm` (us) or `normalized` ([-1, 1]) for each thruster, in the
            vehicle's order; `demand` ([-1, 1]) or `wrench` (N, N m) for each axis of the body.
        columns: names of the columns; a minus in front of a name inverts the sign.
        axes: for `demand` and `wrench`, the axis of each column; may be left out if the columns
            are named after the axes, or are six in the order surge ... yaw.
        topic: that of a ROS 2 bag.
        angles: names of the columns that hold angles in rad; not needed for those that the vehicle
            file says are angles.
        auxiliary: further columns of a csv, for effects that read them; used as they are.
            `voltage` is that of the battery.
    """

    format: str
    kind: LoggedKind
    columns: Annotated[list[Text], Field(min_length=1), AfterValidator(_distinct)]
    axes: Annotated[list[Axis], AfterValidator(_distinct)] = Field(default_factory=list)
    topic: Text | None = None
    angles: list[Text] = Field(default_factory=list)
    auxiliary: Annotated[list[Text], AfterValidator(_distinct)] = Field(default_factory=list)

    @property
    def turned(self) -> list[bool]:
        """For each column, whether it holds an angle in rad."""
        return [name in self.angles for name in self.names]

    @property
    def names(self) -> list[str]:
        """The names of the columns in the file, without the minus."""
        return [column.removeprefix("-") for column in self.columns]

    @property
    def signs(self) -> list[float]:
        """Sign of each column, 1 or -1."""
        return [-1.0 if column.startswith("-") else 1.0 for column in self.columns]

    @property
    def per_axis(self) -> bool:
        """Whether each column belongs to an axis of the body, not to a thruster."""
        return self.kind in ("demand", "wrench")

    @property
    def axis_numbers(self) -> list[int]:
        """For `demand` and `wrench`: the axis, 0 to 5, of every column."""
        axes = self.axes or (self.names if set(self.names) <= set(AXES) else AXES)
        return [AXES.index(axis) for axis in axes]


class Run(Section):
    """One run; its files are relative to the folder of the recordings.

    Attributes:
        id: name of the run.
        control: degrees of freedom that were controlled.
        split: whether models are fitted to this run or only tested on it.
        mocap: one file, or several that hold different sensors on one clock.
        commands: the log; `none` where nothing was commanded (free decay, towing, drifting).
        use: spans [from, to] on the clock of the recording, s; what lies outside (held by hand, on
            the floor) is left out. None to use all of it.
        commands_shift_s: added to the times of the commands to bring them to the clock of the
            recording, s.
    """

    id: FileName
    control: Literal["3dof", "6dof"]
    split: Literal["train", "test"]
    mocap: Annotated[list[FilePath], Field(min_length=1), AfterValidator(_distinct)] | FilePath
    commands: FilePath
    use: Annotated[list[Span], Field(min_length=1)] | None = None
    commands_shift_s: Number = 0.0

    @property
    def sensor_files(self) -> list[str]:
        """The files with the measurements, relative to the folder of the recordings."""
        return as_list(self.mocap)

    @property
    def commanded(self) -> bool:
        """Whether there is a log of commands."""
        return self.commands != "none"


class CampaignFile(Section):
    """The keys of `campaign.yaml`."""

    name: FileName
    vehicle: FilePath
    tank: Tank | None = None
    mocap: Mocap
    commands: CommandLog | None = None  # not needed where no run has commands
    runs: Annotated[list[Run], Field(min_length=1)]
    folder: PathText = ""  # where the recordings lie when they are not beside this file
    source: str = ""  # where to get the recordings, added to the error when they are missing
