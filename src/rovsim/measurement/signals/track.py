"""A pose on a uniform clock from whatever was measured of it, and what that was.

Turning is known from attitudes, or summed up from rates where attitudes come too seldom; moving
from positions and depths, or summed up from velocities. What nobody measured stays zero, and
`Measured` says so: no score and no diagnosis counts it.
"""

from dataclasses import dataclass
from typing import Mapping

import numpy as np
from numpy import ndarray as Array

from rovsim.core import rotations
from rovsim.core.errors import BadInput
from rovsim.measurement.recording.channels import Channel
from rovsim.measurement.recording.recording import Recording
from rovsim.measurement.signals.clock import uniform_clock, without_short
from rovsim.measurement.signals.measured import Measured
from rovsim.measurement.signals.motion import Poses
from rovsim.measurement.signals.resample import Resampling, find_bridged

# Vehicles move below 2 Hz (filter.py): what comes less often than twice that does not show it all.
OFTEN = 4.0  # Hz
FASTEST = 100.0  # Hz of the clock; a faster sensor shows no more of a motion below 2 Hz
SHARE = 0.25  # of the rate of the slowest channel: half of its Nyquist frequency
LONG = 2.5  # usual steps of a channel: a longer one is a gap


def track_channels(recording: Recording, settings: Resampling) -> Poses:
    """Poses on a uniform clock, of a recording without full poses.

    Raises:
        BadInput: no channel tells of the motion.
    """
    given = _Given.of(recording)
    turning, moving = given.turning, given.moving
    if not turning and not moving:
        raise BadInput(
            f"no channel of the motion, but {', '.join(recording.channels) or 'nothing'}",
            where=f"run {recording.run.id}",
            expected="some of position, depth, attitude, velocity, rates",
            remedy="Name the topics or columns that hold them.",
        )
    used = {**turning, **moving}
    rates = [channel.rate or 0.0 for channel in used.values()]
    rate = min(settings.rate or FASTEST, FASTEST, max(rates))
    first = max(channel.time[0] for channel in used.values())
    last = min(channel.time[-1] for channel in used.values())
    clock = uniform_clock(first, max(last, first), rate)
    at = _OnClock(clock, settings.max_gap)
    attitude, angles = _turn(at, turning)
    position, coordinates, summed = _move(at, moving, attitude, recording)
    measured = _measured(at, used, coordinates, angles, summed, SHARE * min(rates))
    usable = np.logical_and.reduce([at.bridged(channel) for channel in used.values()])
    usable = without_short(usable, round(settings.min_segment * rate))
    eta = np.hstack([position, attitude])
    return Poses(
        recording.run, recording.site, clock, eta, usable, recording.commands, measured
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class _Given:
    """Channels by kind, as late as they were measured, their clocks shared."""

    channels: Mapping[str, Channel]

    @staticmethod
    def of(recording: Recording) -> "_Given":
        delays = recording.sensors.delay_s.model_dump()
        return _Given(
            {
                kind: Channel(channel.time - delays[kind], channel.value)
                for kind, channel in recording.channels.items()
                if len(channel.time) > 1
            }
        )

    @property
    def turning(self) -> dict[str, Channel]:
        """What turning is told by: rates first where attitudes come too seldom or lack the yaw."""
        known = [kind for kind in ("attitude", "euler") if kind in self.channels][:1]
        rates = [kind for kind in ("rates",) if kind in self.channels]
        if rates and known and self._often(known[0]) and self._heads(known[0]):
            rates = []
        return {kind: self.channels[kind] for kind in (*rates, *known)}

    def _often(self, kind: str) -> bool:
        return (self.channels[kind].rate or 0.0) >= OFTEN

    def _heads(self, kind: str) -> bool:
        """Whether the yaw was measured."""
        return kind == "attitude" or bool(np.isfinite(self.channels[kind].value[:, 2]).any())

    @property
    def moving(self) -> dict[str, Channel]:
        """What moving is told by: velocities where positions are missing, seldom or rougher."""
        found = {k: self.channels[k] for k in ("position", "depth") if k in self.channels}
        velocity, place = self.channels.get("velocity"), found.get("position")
        if velocity is None:
            return found
        often = place is not None and self._often("position")
        if place is not None and often and _roughness(place) < _roughness_of_sum(velocity):
            return found
        found.pop("position", None)
        return {"velocity": velocity, **found}


def _roughness(channel: Channel) -> float:
    """Standard deviation of the noise of positions, m: from their second differences."""
    return float(np.nanstd(np.diff(channel.value[:, :2], 2, axis=0)) / np.sqrt(6.0))


def _roughness_of_sum(channel: Channel) -> float:
    """How far a second of summed-up velocities is off by their noise, m."""
    noise = float(np.nanstd(np.diff(channel.value[:, :2], 2, axis=0)) / np.sqrt(6.0))
    return noise / np.sqrt(channel.rate or 1.0)


@dataclass(frozen=True, eq=False)
class _OnClock:
    """Channels on a uniform clock (n,) s."""

    clock: Array
    max_gap: float

    def values(self, channel: Channel) -> Array:
        """Values (n, c), each column between its own samples; NaN where none was measured."""
        found = np.full((len(self.clock), channel.value.shape[1]), np.nan)
        for k, column in enumerate(channel.value.T):
            known = np.isfinite(column)
            if known.sum() > 1:
                found[:, k] = np.interp(self.clock, channel.time[known], column[known])
        return found

    def attitudes(self, channel: Channel) -> Array:
        """Unit quaternions (n, 4)."""
        q = rotations.continuous(channel.value)
        each = [np.interp(self.clock, channel.time, column) for column in q.T]
        return rotations.normalized(np.stack(each, axis=1))

    def bridged(self, channel: Channel) -> Array:
        """Whether each sample (n,) is close enough to where the channel was measured."""
        longest = max(self.max_gap, LONG / (channel.rate or 1.0))
        return find_bridged(channel.time, self.clock, longest)

    def read(self, channel: Channel) -> Array:
        """At which samples (n,) there is one of the channel next to it."""
        found = np.zeros(len(self.clock), bool)
        step = self.clock[1] - self.clock[0] if len(self.clock) > 1 else 1.0
        nearest = np.round((channel.time - self.clock[0]) / step).astype(int)
        found[nearest[(nearest >= 0) & (nearest < len(found))]] = True
        return found

    def summed(self, rate: Array) -> Array:
        """Integral (n, c) of what changes at a rate (n, c), zero at first; NaN counts as none."""
        rate = np.nan_to_num(rate)
        step = np.diff(self.clock)[:, None]
        parts = 0.5 * (rate[1:] + rate[:-1]) * step
        return np.concatenate([np.zeros((1, rate.shape[1])), np.cumsum(parts, axis=0)])


def _turn(at: _OnClock, turning: Mapping[str, Channel]) -> tuple[Array, Array]:
    """Unit quaternions (n, 4), and which of roll, pitch and yaw were measured (3,)."""
    if "rates" in turning:
        return _sum_rates(at, turning)
    if "attitude" in turning:
        return at.attitudes(turning["attitude"]), np.ones(3, bool)
    angles = np.full((len(at.clock), 3), np.nan)
    if "euler" in turning:
        channel = turning["euler"]
        angles = at.values(Channel(channel.time, _unwrapped(channel.value)))
    known = ~np.isnan(angles).all(axis=0)
    return _continuous(rotations.from_euler(*np.nan_to_num(angles).T)), known


def _unwrapped(angles: Array) -> Array:
    found = angles.copy()
    for column in found.T:
        known = np.isfinite(column)
        column[known] = np.unwrap(column[known])
    return found


def _continuous(q: Array) -> Array:
    return rotations.continuous(rotations.normalized(q))


def _sum_rates(at: _OnClock, turning: Mapping[str, Channel]) -> tuple[Array, Array]:
    """The same of rates; attitudes beside them, however seldom, say where it started."""
    rates = np.nan_to_num(at.values(turning["rates"]))
    known = ~np.isnan(at.values(turning["rates"])).all(axis=0)
    step = np.append(np.diff(at.clock), 0.0)[:, None]
    turns = rotations.exp(0.5 * (rates + np.vstack([rates[1:], rates[-1:]])) * step)
    q = np.empty((len(rates), 4))
    beside = {k: v for k, v in turning.items() if k != "rates"}
    q[0] = _turn(at, beside)[0][0] if beside else [1.0, 0.0, 0.0, 0.0]
    for k in range(len(q) - 1):
        q[k + 1] = rotations.multiply(q[k], turns[k])
    if beside:
        known = known | _turn(at, beside)[1]
    return _continuous(q), known


def _move(
    at: _OnClock, moving: Mapping[str, Channel], attitude: Array, recording: Recording
) -> tuple[Array, Array, Array]:
    """Positions (n, 3) of CO; which coordinates were measured (3,), and which summed up (3,)."""
    position, summed = np.full((len(at.clock), 3), np.nan), np.zeros(3, bool)
    if "velocity" in moving:
        position, summed = _sum_velocities(at, moving["velocity"], attitude, recording)
    if "position" in moving:
        position = at.values(moving["position"])
    if "depth" in moving and (summed[2] or np.isnan(position[:, 2]).all()):
        position[:, 2] = _depth_of_origin(at.values(moving["depth"])[:, 0], attitude, recording)
        summed[2] = False
    known = ~np.isnan(position).all(axis=0)
    return np.nan_to_num(position), known, summed & known


def _sum_velocities(
    at: _OnClock, channel: Channel, attitude: Array, recording: Recording
) -> tuple[Array, Array]:
    """Positions (n, 3) summed up from the velocity of a place, NaN where not measured."""
    v = at.values(channel)
    known = ~np.isnan(v).all(axis=0)
    place = np.array(recording.sensors.velocity_at)
    if place.any():
        q_dot = np.gradient(attitude, at.clock, axis=0)
        v = v - np.cross(rotations.body_rates(attitude, q_dot), place)
    position = at.summed(rotations.rotate(attitude, np.nan_to_num(v)))
    both = np.array([known[:2].all(), known[:2].all(), known[2]])
    return np.where(both, position, np.nan), both


def _depth_of_origin(depth: Array, attitude: Array, recording: Recording) -> Array:
    """Coordinate z (n,) NED of CO where a sensor in the body is at a depth below the surface."""
    surface = recording.site.tank[2, 0]
    below = rotations.rotate(attitude, np.array(recording.sensors.depth_at))[:, 2]
    return np.asarray(depth - below + (surface if np.isfinite(surface) else 0.0))


def _measured(
    at: _OnClock, used: Mapping[str, Channel], coordinates: Array, angles: Array, summed: Array,
    cutoff: float,
) -> Measured:  # fmt: skip
    flat = coordinates[:2].all()
    axes = np.array([flat, flat, coordinates[2], *angles])
    turning = [k for k in ("rates", "attitude", "euler") if k in used]
    place = [k for k in ("velocity", "position") if k in used]
    height = ["depth"] if "depth" in used and not summed[2] else place
    when = np.zeros((len(at.clock), 6), bool)
    for own, kinds in ((slice(0, 2), place), (2, height), (slice(3, 6), turning)):
        if kinds:
            read = at.read(used[kinds[0]])
            when[:, own] = read if own == 2 else read[:, None]
    when &= axes
    return Measured(
        coordinates, angles[2:], axes, np.append(summed, [("rates" in used)] * 3), when,
        np.array([cutoff]),
    )  # fmt: skip
