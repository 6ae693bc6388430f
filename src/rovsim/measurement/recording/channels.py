"""Measured channels: the measurements of a motion, each kind at its own times.

Not measured does not mean zero: a kind that was never measured is absent, and a component that was
not measured at some time is NaN there.
"""

from dataclasses import dataclass
from typing import Iterator, Literal, Mapping, NamedTuple

import numpy as np
from numpy import ndarray as Array

from rovsim.core.rotations import axes_signs, half_turn, multiply
from rovsim.measurement.campaign_file import Mocap

Axes = Literal["world", "body", "none"]


@dataclass(frozen=True)
class ChannelKind:
    """A kind of channel: its columns in order, their unit, and the frame of their axes."""

    columns: tuple[str, ...]
    unit: str
    axes: Axes


# Inside: world NED, body FRD. `velocity` is that of the place `sensors.velocity_at` over ground,
# `specific_force` that of `sensors.imu_at` (acceleration less gravity: (0, 0, -g) at rest and
# level), `depth` that of `sensors.depth_at` below the surface, whatever the world's axes. Angles
# are R = Rz(yaw) Ry(pitch) Rx(roll); `euler` holds attitudes of which some angles are missing.
CHANNEL_KINDS: Mapping[str, ChannelKind] = {
    "position": ChannelKind(("x", "y", "z"), "m", "world"),
    "attitude": ChannelKind(("qw", "qx", "qy", "qz"), "1", "body"),
    "euler": ChannelKind(("roll", "pitch", "yaw"), "rad", "body"),
    "depth": ChannelKind(("depth",), "m", "none"),
    "velocity": ChannelKind(("u", "v", "w"), "m/s", "body"),
    "rates": ChannelKind(("p", "q", "r"), "rad/s", "body"),
    "specific_force": ChannelKind(("ax", "ay", "az"), "m/s2", "body"),
    "voltage": ChannelKind(("voltage",), "V", "none"),
}


@dataclass(frozen=True, eq=False)
class Channel:
    """Samples of a sensor: `time` (m,) s, increasing; `value` (m, c), NaN where not measured."""

    time: Array
    value: Array

    @property
    def rate(self) -> float | None:
        """Rate in Hz of the median step; None with fewer than two samples."""
        return 1.0 / float(np.median(np.diff(self.time))) if len(self.time) > 1 else None


Channels = Mapping[str, Channel]


def measured(time: Array, value: Array) -> Channel:
    """Make a channel of the samples with at least one measured component; infinite becomes NaN."""
    value = np.where(np.isfinite(value), value, np.nan)
    nonempty = ~np.isnan(value).all(axis=1)
    return Channel(time[nonempty], value[nonempty])


class TidyChannels(NamedTuple):
    """Channels in order, and what had to be done for that.

    Attributes:
        channels: each sorted by time; empty channels are left out.
        unsorted: how many steps went back in time.
        duplicates: how many samples were left out, as an earlier one had the same time.
    """

    channels: dict[str, Channel]
    unsorted: int
    duplicates: int


def tidy_channels(channels: Channels) -> TidyChannels:
    """Sort channels by time, and keep the first of samples with equal times."""
    tidied, unsorted, duplicates = {}, 0, 0
    for kind in CHANNEL_KINDS:
        if kind not in channels or not len(channels[kind].time):
            continue
        time, value = channels[kind].time, channels[kind].value
        order = np.argsort(time, kind="stable")
        keep = order[np.diff(time[order], prepend=-np.inf) > 0]
        unsorted += int(np.sum(np.diff(time) < 0))
        duplicates += len(time) - len(keep)
        tidied[kind] = Channel(time[keep], value[keep])
    return TidyChannels(tidied, unsorted, duplicates)


def to_ned(channels: Channels, mocap: Mocap) -> dict[str, Channel]:
    """Turn channels from the axes of a file into NED and FRD."""
    return {
        kind: Channel(channel.time, _turned(kind, channel.value, mocap))
        for kind, channel in channels.items()
    }


def attitude_to_ned(attitude: Array, mocap: Mocap) -> Array:
    """Turn attitudes (n, 4) between the axes of a file into attitudes from FRD to NED, w >= 0."""
    world, body = axes_signs(mocap.world_axes), axes_signs(mocap.body_axes)
    q = multiply(multiply(half_turn(world), attitude), half_turn(body))
    return np.where(q[:, :1] < 0, -q, q)


def _turned(kind: str, value: Array, mocap: Mocap) -> Array:
    if kind == "attitude":
        return attitude_to_ned(value, mocap)
    world, body = axes_signs(mocap.world_axes), axes_signs(mocap.body_axes)
    if kind == "euler":
        return _turned_angles(value, world, body)
    signs = {"world": world, "body": body, "none": 1.0}[CHANNEL_KINDS[kind].axes]
    return value * signs


def _turned_angles(angles: Array, world: Array, body: Array) -> Array:
    """Turn roll, pitch and yaw (m, 3) rad into NED and FRD by half turns about x, each by itself.

    S Rz(yaw) Ry(pitch) Rx(roll) = Rz(-yaw) Ry(-pitch) Rx(roll) S for a half turn S about x, and S
    beside Rx adds pi to the roll.
    """
    angles_ned = angles * world
    half_turns = int(world[1] < 0) + int(body[1] < 0)
    if half_turns == 1:
        angles_ned[:, 0] += np.pi
    angles_ned[:, [0, 2]] = np.remainder(angles_ned[:, [0, 2]] + np.pi, 2.0 * np.pi) - np.pi
    return angles_ned


def by_name(channels: Channels) -> Iterator[tuple[str, Array]]:
    """Yield the arrays of channels with the names under which `from_names` finds them."""
    for kind, channel in channels.items():
        yield f"channel.{kind}.time", channel.time
        yield f"channel.{kind}.value", channel.value


def from_names(arrays: Mapping[str, Array]) -> dict[str, Channel]:
    """Put together the channels whose arrays `by_name` named."""
    return {
        kind: Channel(arrays[f"channel.{kind}.time"], arrays[f"channel.{kind}.value"])
        for kind in CHANNEL_KINDS
        if f"channel.{kind}.time" in arrays
    }
