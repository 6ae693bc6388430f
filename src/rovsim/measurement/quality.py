"""How good a recording is: rate, gaps, repairs, excitation, noise, and what to do about it."""

from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim import AXES
from rovsim.core.axes import VELOCITY_UNITS
from rovsim.core.errors import BadInput
from rovsim.core.robust import LONG_STEP, STD_PER_MAD, usual_range
from rovsim.core.rotations import conjugate, continuous, log, multiply, normalized, turns, unrotate
from rovsim.measurement.means import doubt_means
from rovsim.measurement.recording.channels import KINDS
from rovsim.measurement.recording.reading import Anomalies
from rovsim.measurement.recording.recording import Recording
from rovsim.measurement.recording.tidying import measured_rate
from rovsim.measurement.remarks import doubt, remark
from rovsim.measurement.signals.chosen_channels import doubt_delays
from rovsim.measurement.signals.clock import time_step
from rovsim.measurement.signals.outliers import Outliers, find_outliers
from rovsim.measurement.signals.resample import Linear
from rovsim.measurement.signals.track import track_channels
from rovsim.measurement.velocities import doubt_velocities, find_impossible
from rovsim.results.quality import (
    CommandLog,
    Excitation,
    Gap,
    MeasuredChannel,
    PoseNoise,
    Quality,
    Rate,
)

GAP = 0.05  # s; shorter ones are bridged by any resampling
SHORTEST_RUN = 2.0  # s; one scoring window
# A body at rest stays well inside these: MoCap noise spreads over a few mm and about 0.01 rad, a
# manoeuvring vehicle over decimetres within seconds.
STILL_POSITION, STILL_ATTITUDE = 0.01, 0.02  # m, rad
BLOCK = 0.1  # s; the median of a block rejects single outlier frames
THIRD_DIFFERENCE = 20.0  # its variance over that of white noise: 1 + 9 + 9 + 1
READINGS = 3.0  # of the slowest channel in a block: fewer are its noise
# An axis whose velocity varies less than this cannot be judged: on runs with no command on an
# axis, disturbances alone move it up to about 0.02 m/s and 0.1 rad/s.
EXCITED = np.array([0.03, 0.03, 0.03, 0.12, 0.12, 0.12])  # m/s, rad/s, standard deviation


def report_quality(recording: Recording, anomalies: Anomalies, settings: Outliers) -> Quality:
    """Assess a recording for `quality/RUN.json`, and count the outliers if it has bare poses.

    Outliers are not looked for where the export has velocities, or no full poses.
    """
    if recording.nu is not None or not recording.posed:
        return assess(recording, anomalies)
    return assess(recording, anomalies, int(find_outliers(recording, settings).sum()))


def assess(recording: Recording, anomalies: Anomalies, outliers: int | None = None) -> Quality:
    """Describe how good a recording is.

    Args:
        recording: what was read.
        anomalies: what was repaired or noticed while reading.
        outliers: number of frames that the outlier rejection refused; None when not looked for.
    """
    time, tracked = recording.time, recording.found
    gaps = find_gaps(recording, anomalies.used)
    report = Quality(
        run=recording.run.id,
        split=recording.run.split,
        control=recording.run.control,
        rate_hz=Rate(nominal=recording.rate, median=measured_rate(time)),
        duration_s=float(time[-1] - time[0]),
        frames=len(time),
        # frames outside of `use` are marked as not found, but the cameras did not miss them
        not_found=int(np.sum(~tracked)) - anomalies.left_out if recording.posed else 0,
        longest_gap_s=max((gap.duration_s for gap in gaps), default=0.0),
        gaps=tuple(gaps),
        used=anomalies.used,
        outliers=outliers,
        repairs=anomalies.counts,
        commands=_describe_commands(recording),
        posed=recording.posed,
        excitation=measure_excitation(recording),
        noise=measure_noise(recording),
        unusable=usable_reason(recording),
        channels=_describe_channels(recording),
    )
    remarks = (*remark(report), *anomalies.notes)
    doubts = (
        *doubt(report),
        *doubt_means(recording),
        *doubt_velocities(recording),
        *doubt_delays(recording),
    )
    return report.model_copy(update={"remarks": remarks}).doubted(*doubts)


def usable_reason(recording: Recording) -> str | None:
    """Say why a recording cannot be used, or None when it can.

    Without full poses only its length and the size of its velocities are checked.
    """
    tracked = recording.found
    if too_fast := find_impossible(recording):
        return too_fast
    if not recording.posed:
        length = float(np.ptp(recording.time))
        reason = f"too short: it lasts {length:.2f} s, {SHORTEST_RUN:g} needed"
        return reason if length < SHORTEST_RUN else None
    tracked_s = float(np.sum(tracked)) / recording.rate
    duration = float(np.ptp(recording.time[tracked])) if tracked.any() else 0.0
    if min(tracked_s, duration) < SHORTEST_RUN:
        return (
            f"too short: the body was seen for {min(tracked_s, duration):.2f} s, "
            f"{SHORTEST_RUN:g} needed"
        )
    position = _spread(recording.position[tracked])
    attitude = _spread(_turns(recording.attitude[tracked]))
    if position < STILL_POSITION and attitude < STILL_ATTITUDE:
        return f"motionless: it stays within {1e3 * position:.1f} mm and {attitude:.3f} rad"
    return None


def find_gaps(recording: Recording, used: Sequence[tuple[float, float]] = ()) -> list[Gap]:
    """Stretches without a pose, from the last found frame to the next, longer than 0.05 s.

    On a slow export (bins) a step is a gap when it is more than twice the usual one.

    Args:
        recording: what was read.
        used: spans [from, to] that are used, s: gaps outside are left out. Empty if all is used.
    """
    time = recording.time[recording.found]
    steps = np.diff(time)
    limit = max(GAP, 2.0 * float(np.median(np.diff(recording.time))))
    long = np.flatnonzero(steps > limit * (1.0 + 1e-9))
    gaps = [Gap(start_s=float(time[k]), duration_s=float(steps[k])) for k in long]
    return [gap for gap in gaps if not used or any(_within(gap, span) for span in used)]


def _within(gap: Gap, span: tuple[float, float]) -> bool:
    return span[0] <= gap.start_s and gap.start_s + gap.duration_s <= span[1]


def measure_excitation(recording: Recording) -> dict[str, Excitation]:
    """Standard deviation of the body velocity per axis, and whether it suffices to judge it.

    Axes that were not measured are left out.
    """
    nu, measured = _velocity(recording)
    spread = nu.std(axis=0) if len(nu) else np.zeros(6)
    return {
        axis: Excitation(
            std=float(spread[k]),
            unit=VELOCITY_UNITS[k],
            excited=bool(spread[k] > EXCITED[k]),
        )
        for k, axis in enumerate(AXES)
        if measured[k]
    }


def _velocity(recording: Recording) -> tuple[Array, Array]:
    """Rough body velocities (k, 6), m/s and rad/s, and which axes, bool (6,), were measured."""
    if recording.posed:
        return rough_velocity(recording), np.ones(6, bool)
    try:
        poses = track_channels(recording, Linear())
    except BadInput:  # no channel of the motion: this error is reported when the run is used
        return np.empty((0, 6)), np.zeros(6, bool)
    assert poses.measured is not None
    length = max(BLOCK, READINGS * poses.measured.period)
    columns = poses.time[:, None], poses.eta[:, :3], poses.eta[:, 3:]
    used = tuple(column[poses.usable] for column in columns)
    return _differences(*used, rate=1.0 / time_step(poses.time), length=length), poses.measured.axes


def rough_velocity(recording: Recording) -> Array:
    """Body velocities (k, 6): the exported ones, else differences of medians of short blocks."""
    if recording.nu is not None:
        return recording.nu[recording.found]
    return _differences(*_seen(recording), rate=recording.rate, length=BLOCK)


def _differences(
    time: Array, position: Array, attitude: Array, *, rate: float, length: float
) -> Array:
    """Body velocities (k, 6), m/s and rad/s, from differences of medians of blocks of poses.

    Args:
        time: (n, 1), s.
        position: (n, 3), NED, m.
        attitude: (n, 4), unit quaternions, sign-continuous.
        rate: of the poses, Hz.
        length: of a block, s.
    """
    size = max(1, round(length * rate))
    time, position, attitude = (_blocks(a, size) for a in (time, position, attitude))
    step = np.diff(time[:, 0])
    contiguous = step < LONG_STEP * size / rate  # no difference across a gap
    dt = step[:, None]
    linear = unrotate(attitude[:-1], np.diff(position, axis=0) / dt)
    return np.hstack([linear, turns(attitude) / dt])[contiguous]


def measure_noise(recording: Recording) -> PoseNoise:
    """Estimate the noise of a pose, m and rad: robust spread of third differences / sqrt(20).

    Motion that is slow against four samples cancels in third differences. On a slow export it does
    not, and the number is an upper bound. None with too few samples.
    """
    _, position, attitude = _seen(recording)
    mask = _evenly_spaced(recording)
    dp, dtheta = np.diff(position, 3, axis=0)[mask], np.diff(turns(attitude), 2, axis=0)[mask]
    return PoseNoise(position_m=_robust_std(dp), attitude_rad=_robust_std(dtheta))


def _describe_channels(recording: Recording) -> dict[str, MeasuredChannel]:
    return {
        kind: MeasuredChannel(
            samples=len(channel.time),
            rate_hz=channel.rate,
            start_s=float(channel.time[0]),
            end_s=float(channel.time[-1]),
            measured=tuple(
                name
                for name, column in zip(KINDS[kind].columns, channel.value.T, strict=True)
                if np.isfinite(column).any()
            ),
        )
        for kind, channel in recording.channels.items()
    }


def _describe_commands(recording: Recording) -> CommandLog | None:
    time = recording.commands.time
    if not len(time):
        return None
    steps = np.diff(time)
    return CommandLog(
        kind=recording.commands.kind,
        lines=len(time),
        start_s=float(time[0]),
        end_s=float(time[-1]),
        median_step_s=float(np.median(steps)) if len(steps) else None,
        longest_step_s=float(steps.max()) if len(steps) else None,
        varies=bool(np.ptp(recording.commands.value, axis=0).max() > 0.0),
    )


def _seen(recording: Recording) -> tuple[Array, Array, Array]:
    """Time (k, 1), position (k, 3) and sign-continuous attitude (k, 4) of the found frames."""
    tracked = recording.found
    attitude = continuous(recording.attitude[tracked])
    return recording.time[tracked][:, None], recording.position[tracked], attitude


def _blocks(values: Array, size: int) -> Array:
    """Medians of consecutive blocks of `size` rows; unit length where the rows are quaternions."""
    count = len(values) // size
    medians = np.median(values[: count * size].reshape(count, size, values.shape[1]), axis=1)
    return normalized(medians) if values.shape[1] == 4 else medians


def _evenly_spaced(recording: Recording) -> Array:
    """Mask (k - 3,): where four consecutive found frames are one nominal step apart each."""
    steps = np.diff(recording.time[recording.found])
    even = np.abs(steps * recording.rate - 1.0) < 0.5
    return even[:-2] & even[1:-1] & even[2:]


def _robust_std(third: Array) -> float | None:
    if len(third) < 10:
        return None
    per_axis = STD_PER_MAD * np.median(np.abs(third - np.median(third, axis=0)), axis=0)
    return float(np.sqrt(np.mean(per_axis**2) / THIRD_DIFFERENCE))


def _turns(attitude: Array) -> Array:
    """Rotation vectors (n, 3), rad, from the first attitude to each of n."""
    return log(multiply(conjugate(attitude[:1]), attitude))


def _spread(values: Array) -> float:
    """Largest range over the columns, without the outer 1 % at either end (outlier frames)."""
    low, high = usual_range(values)
    return float(np.max(high - low))
