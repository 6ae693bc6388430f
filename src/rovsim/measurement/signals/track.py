"""Make poses on a uniform clock from whatever channels were measured, without full poses.

The attitude comes from attitude channels, or is integrated from body rates where that is better.
The position comes from positions and depths, or is integrated from velocities. Components that were
not measured stay zero and are marked in `Measured`, so that no score and no diagnosis counts them.
"""

from dataclasses import dataclass
from typing import Mapping

import numpy as np
from numpy import ndarray as Array

from rovsim.core import rotations
from rovsim.core.errors import BadInput
from rovsim.measurement.recording.channels import Channel
from rovsim.measurement.recording.recording import Recording
from rovsim.measurement.signals.chosen_channels import ChosenChannels, choose_channels
from rovsim.measurement.signals.clock import uniform_clock, without_short
from rovsim.measurement.signals.measured import CUTOFF_SHARE, Measured
from rovsim.measurement.signals.motion import Poses
from rovsim.measurement.signals.on_clock import OnClock, between, instants_between
from rovsim.measurement.signals.resample import Resampling

MAX_RATE_HZ = 100.0  # of the clock; a faster sensor shows no more of a motion below 2 Hz
MAX_SAMPLES = 1e7  # more than a day at 100 Hz
SUMMED_CHANNELS = ("rates", "velocity")


def track_channels(recording: Recording, settings: Resampling) -> Poses:
    """Make poses on a uniform clock of a recording without full poses.

    Args:
        recording: the channels.
        settings: highest rate of the clock, longest gap and shortest stretch.

    Raises:
        BadInput: there is no channel of the motion.
    """
    channels = choose_channels(recording)
    if not channels.all:
        raise BadInput(
            f"no channel of the motion, but {', '.join(recording.channels) or 'nothing'}",
            where=f"run {recording.run.id}",
            expected="some of position, depth, attitude, velocity, rates",
            remedy="Name the topics or columns that hold them.",
        )
    clock = _make_clock(channels, settings, recording.run.id)
    at = OnClock(clock, settings.max_gap)
    attitude = _turn(at, channels.turning)
    position = _move(at, channels.moving, attitude.value, recording)
    rate = 1.0 / at.step
    usable = np.logical_and.reduce([at.bridged(channel) for channel in channels.read.values()])
    usable = without_short(usable, round(settings.min_segment * rate))
    return Poses(
        recording.run,
        recording.site,
        clock,
        np.hstack([position.value, attitude.value]),
        usable,
        recording.commands,
        _describe(at, channels, attitude, position),
    )


def _make_clock(chosen: ChosenChannels, settings: Resampling, where: str) -> Array:
    """Make a uniform clock (n,) at the rate of the fastest main channel, at most `MAX_RATE_HZ`.

    It starts at a sample of that channel, or midway between two if the channel is integrated, and
    covers the time in which all chosen channels were measured.
    """
    kind, fastest = max(chosen.read.items(), key=lambda item: item[1].rate or 0.0)
    rate = min(settings.rate or MAX_RATE_HZ, MAX_RATE_HZ, fastest.rate or MAX_RATE_HZ)
    start = max(channel.time[0] for channel in chosen.all.values())
    end = min(channel.time[-1] for channel in chosen.all.values())
    if (end - start) * rate > MAX_SAMPLES:
        raise BadInput(
            f"its channels last {end - start:.3g} s",
            where=f"run {where}",
            expected=f"at most {MAX_SAMPLES / rate:.3g} s",
            remedy="Look for time stamps that jump.",
        )
    instants = instants_between(fastest.time) if kind in SUMMED_CHANNELS else fastest.time
    start = float(instants[min(np.searchsorted(instants, start), len(instants) - 1)])
    return uniform_clock(start, max(end, start), rate)


@dataclass(frozen=True, eq=False)
class _Tracked:
    """Positions or attitudes on the clock, and how they are known.

    Attributes:
        value: positions (n, 3) NED, m, or unit quaternions (n, 4).
        known: bool (3,), which of x, y, z or of roll, pitch, yaw are known.
        summed: bool (3,), which of these are integrals of velocities or rates.
    """

    value: Array
    known: Array
    summed: Array


def _turn(at: OnClock, turning: Mapping[str, Channel]) -> _Tracked:
    """Take the attitude from rates, whose drift direct attitudes correct, or from these alone."""
    direct_channels = {kind: channel for kind, channel in turning.items() if kind != "rates"}
    direct = _read_attitude(at, direct_channels)
    if "rates" not in turning:
        return direct
    rates = turning["rates"]
    q, measured = at.turn_up(rates, direct.value[0]), np.isfinite(rates.value).any(axis=0)
    for channel in direct_channels.values():
        reference = _read_attitude(OnClock(channel.time, at.max_gap), direct_channels).value
        summed = between(channel.time, at.clock, rotations.continuous(q))
        error = rotations.log(rotations.multiply(rotations.conjugate(summed), reference))
        drift = np.where(direct.known, at.drift(error, rates, channel), 0.0)
        q = rotations.multiply(q, rotations.exp(drift))
    return _Tracked(_continuous(q), measured | direct.known, measured)


def _read_attitude(at: OnClock, direct: Mapping[str, Channel]) -> _Tracked:
    no_axes = np.zeros(3, bool)
    if "attitude" in direct:
        return _Tracked(at.attitudes(direct["attitude"]), ~no_axes, no_axes)
    angles = np.full((len(at.clock), 3), np.nan)
    for channel in direct.values():
        angles = at.values(Channel(channel.time, rotations.unwrapped(channel.value)))
    measured = ~np.isnan(angles).all(axis=0)
    return _Tracked(_continuous(rotations.from_euler(*np.nan_to_num(angles).T)), measured, no_axes)


def _continuous(q: Array) -> Array:
    return rotations.continuous(rotations.normalized(q))


def _move(
    at: OnClock, moving: Mapping[str, Channel], attitude: Array, recording: Recording
) -> _Tracked:
    """Take the position of CO from the channels.

    Velocities are integrated, and positions correct their drift; a position replaces what was not
    integrated, and a depth the coordinate z.

    Args:
        at: the clock.
        moving: channels of the position.
        attitude: unit quaternions (n, 4) on the clock.
        recording: says where the sensors sit, and where the surface is.
    """
    position, summed = np.full((len(at.clock), 3), np.nan), np.zeros(3, bool)
    if "velocity" in moving:
        position, summed = _sum_velocities(at, moving["velocity"], attitude, recording)
    if "position" in moving:
        channel = moving["position"]
        direct = at.values(channel)
        if summed.any():
            total = [np.interp(channel.time, at.clock, column) for column in position.T]
            drift = at.drift(channel.value - np.stack(total, axis=1), moving["velocity"], channel)
            direct = np.where(summed, position + drift, direct)
        position = np.where(np.isnan(direct), position, direct)
    if "depth" in moving:
        position[:, 2] = _depth_of_origin(at.values(moving["depth"])[:, 0], attitude, recording)
        summed[2] = False
    measured = ~np.isnan(position).all(axis=0)
    return _Tracked(np.nan_to_num(position), measured, summed & measured)


def _sum_velocities(
    at: OnClock, channel: Channel, attitude: Array, recording: Recording
) -> tuple[Array, Array]:
    """Integrate the body velocity of the sensor's place to a position of CO, NED.

    Both horizontal coordinates need surge and sway.

    Returns:
        Positions (n, 3), m, relative to the start, NaN where not measured; and which coordinates
        (3,) were measured.
    """
    measured_axes = np.isfinite(channel.value).any(axis=0)
    q = between(channel.time, at.clock, attitude)
    v, lever = np.nan_to_num(channel.value), np.array(recording.sensors.velocity_at)
    if lever.any() and len(at.clock) > 1:
        q_dot = np.gradient(attitude, at.clock, axis=0)
        turning = rotations.body_rates(attitude, q_dot)
        spin = np.stack([np.interp(channel.time, at.clock, rate) for rate in turning.T], axis=1)
        v = v - np.cross(spin, lever)
    measured = np.array([measured_axes[:2].all(), measured_axes[:2].all(), measured_axes[2]])
    return np.where(measured, at.sum_up(channel.time, rotations.rotate(q, v)), np.nan), measured


def _depth_of_origin(depth: Array, attitude: Array, recording: Recording) -> Array:
    """Coordinate z (n,) NED of CO, m, from the depth (n,) of a sensor in the body, m.

    Where the tank's surface is unknown, it is at z = 0.
    """
    surface = recording.site.tank[2, 0]
    below = rotations.rotate(attitude, np.array(recording.sensors.depth_at))[:, 2]
    return np.asarray(depth - below + (surface if np.isfinite(surface) else 0.0))


def _describe(at: OnClock, chosen: ChosenChannels, turned: _Tracked, moved: _Tracked) -> Measured:
    """Say which components were measured, and at which samples of the clock they were read."""
    flat = moved.known[:2].all()
    axes = np.array([flat, flat, moved.known[2], *turned.known])
    horizontal = [kind for kind in chosen.moving if kind != "depth"][:1]
    vertical = ["depth"] if "depth" in chosen.moving else horizontal
    samples = np.zeros((len(at.clock), 6), bool)
    for columns, kinds in (
        ([0, 1], horizontal),
        ([2], vertical),
        ([3, 4, 5], list(chosen.turning)[:1]),
    ):
        for kind in kinds:
            samples[:, columns] = at.nearest(_read_at(kind, chosen.all[kind]))[:, None]
    slowest = min(channel.rate or 0.0 for channel in chosen.read.values())
    return Measured(
        moved.known,
        turned.known[2:],
        axes,
        np.append(moved.summed, turned.summed),
        samples & axes,
        np.array([CUTOFF_SHARE * slowest]),
    )


def _read_at(kind: str, channel: Channel) -> Array:
    """Times at which a channel is read: midway between its samples if it is integrated."""
    return instants_between(channel.time)[1:-1] if kind in SUMMED_CHANNELS else channel.time
