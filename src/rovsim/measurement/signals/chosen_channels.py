"""Choose the channels from which attitude and position are taken, the least noisy first."""

import warnings
from dataclasses import dataclass
from typing import Iterator, Mapping

import numpy as np

from rovsim.core import rotations
from rovsim.measurement.recording.channels import Channel
from rovsim.measurement.recording.recording import Recording

# Vehicles move below 2 Hz (filter.py): what comes less often than twice that does not show it all.
MIN_MOTION_RATE_HZ = 4.0
QUIET_SHARE = 0.95  # of second differences: sticks are stepped at most every second or so
STD_OF_QUIET = 0.871  # of white noise without its largest twentieth, over that of all


@dataclass(frozen=True, eq=False)
class ChosenChannels:
    """The chosen channels by kind, with times corrected for the delays of the sensors.

    The first channel of each mapping is the main source. If it is integrated (rates, velocity),
    the later ones are used to correct its drift. A depth gives the coordinate z directly.

    Attributes:
        turning: channels that the attitude is taken from.
        moving: channels that the position is taken from.
    """

    turning: Mapping[str, Channel]
    moving: Mapping[str, Channel]

    @property
    def all(self) -> dict[str, Channel]:
        """Both mappings in one."""
        return {**self.turning, **self.moving}

    @property
    def read(self) -> dict[str, Channel]:
        """The main channels: the first of each mapping, and the depth if it is used."""
        main = [*list(self.turning)[:1], *list(self.moving)[:1], "depth"]
        return {kind: channel for kind, channel in self.all.items() if kind in main}


def choose_channels(recording: Recording) -> ChosenChannels:
    """Choose channels of a recording that have at least two samples."""
    delays = recording.sensors.delay_s.model_dump()
    channels = {
        kind: Channel(channel.time - delays[kind], channel.value)
        for kind, channel in recording.channels.items()
        if len(channel.time) > 1
    }
    return ChosenChannels(_choose_turning(channels), _choose_moving(channels))


def doubt_delays(recording: Recording) -> Iterator[str]:
    """Yield a sentence where the campaign gives delays that are not used, and why they are not."""
    delayed = [kind for kind, delay in recording.sensors.delay_s.model_dump().items() if delay]
    idle = [kind for kind in delayed if recording.posed or kind not in recording.channels]
    if idle:
        names = ", ".join(recording.channels) or "none"
        reason = "full poses are taken at their times" if recording.posed else f"read are {names}"
        yield (
            f"The delay of {', '.join(idle)} (mocap.sensors.delay_s) is not used, for {reason}: "
            "correct the times in the file, or the name of the channel."
        )


def _choose_turning(channels: Mapping[str, Channel]) -> dict[str, Channel]:
    """Channels of the attitude: rates first if attitudes are infrequent, noisier or lack yaw."""
    direct = [kind for kind in ("attitude", "euler") if kind in channels][:1]
    rates = ["rates"] if "rates" in channels else []
    if rates and direct and _heads(direct[0], channels) and _suffices(channels, direct[0], "rates"):
        rates = []
    return {kind: channels[kind] for kind in (*rates, *direct)}


def _choose_moving(channels: Mapping[str, Channel]) -> dict[str, Channel]:
    """Channels of the position: velocities first if positions are infrequent or noisier.

    The depth is left out where positions with a z are the main source and are less noisy.
    """
    position, velocity, depth = (
        [k] if k in channels else [] for k in ("position", "velocity", "depth")
    )
    if velocity and position and _suffices(channels, "position", "velocity"):
        velocity = []
    if depth and position and not velocity and np.isfinite(channels["position"].value[:, 2]).any():
        depth = (
            depth if noise_density(channels["depth"]) < noise_density(channels["position"]) else []
        )
    return {kind: channels[kind] for kind in (*velocity, *position, *depth)}


def _heads(kind: str, channels: Mapping[str, Channel]) -> bool:
    """Whether a channel of attitudes contains the yaw."""
    return kind == "attitude" or bool(np.isfinite(channels[kind].value[:, 2]).any())


def _suffices(channels: Mapping[str, Channel], direct: str, rate: str) -> bool:
    """Whether a directly measured channel is as good a source as an integrated one.

    It must come often enough, and its noise over a second must not exceed that of the integral.
    """
    often = (channels[direct].rate or 0.0) >= MIN_MOTION_RATE_HZ
    return often and noise_density(channels[direct]) <= noise_density(channels[rate])


def noise_density(channel: Channel) -> float:
    """Noise density of a channel: standard deviation of a sample over the square root of the rate.

    The noise of a sample is estimated from second differences, whose variance is 6 times that of
    white noise. The largest are those of a motion, such as turns after a step of the sticks.

    Returns:
        The density in the channel's unit (rad for quaternions) by root hertz; NaN with fewer than
        three samples.
    """
    value = channel.value
    if len(value) < 3:
        return np.nan
    if value.shape[1] == 4:  # small turns are twice the vector part of a quaternion
        value = 2.0 * rotations.continuous(value)
    size = np.abs(np.diff(value, 2, axis=0))
    with warnings.catch_warnings(action="ignore", category=RuntimeWarning):  # not one was measured
        size[size > np.nanquantile(size, QUIET_SHARE, axis=0)] = np.nan
        noise = np.sqrt(np.nanmean(size**2) / 6.0) / STD_OF_QUIET
    return float(noise / np.sqrt(channel.rate or 1.0))
