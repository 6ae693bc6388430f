"""Assess a recording: rate, gaps, repairs, excitation, noise, and what to do about it."""

from typing import Sequence

import numpy as np

from rovsim.measurement.quality.excitation import measure_excitation
from rovsim.measurement.quality.pose_noise import measure_noise
from rovsim.measurement.quality.remarks import doubt, remark
from rovsim.measurement.quality.usability import usable_reason
from rovsim.measurement.quality.velocity_conventions import doubt_velocities
from rovsim.measurement.quality.velocity_means import doubt_means
from rovsim.measurement.recording.channels import CHANNEL_KINDS
from rovsim.measurement.recording.recording import Recording
from rovsim.measurement.recording.repairs import Anomalies
from rovsim.measurement.recording.tidying import measured_rate
from rovsim.measurement.signals.chosen_channels import doubt_delays
from rovsim.measurement.signals.outliers import Outliers, find_outliers
from rovsim.results.quality import CommandSummary, Gap, MeasuredChannel, Quality, Rate

MIN_GAP_S = 0.05  # shorter ones are bridged by any resampling


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
    time, tracked = recording.time, recording.tracked
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
    remarks = (*remark(report, anomalies), *anomalies.notes)
    doubts = (
        *doubt(report),
        *doubt_means(recording),
        *doubt_velocities(recording),
        *doubt_delays(recording),
    )
    return report.model_copy(update={"remarks": remarks}).doubted(*doubts)


def find_gaps(recording: Recording, used: Sequence[tuple[float, float]] = ()) -> list[Gap]:
    """Stretches without a pose, from the last found frame to the next, longer than 0.05 s.

    On a slow export (bins) a step is a gap when it is more than twice the usual one.

    Args:
        recording: what was read.
        used: spans [from, to] that are used, s: gaps outside are left out. Empty if all is used.
    """
    time = recording.time[recording.tracked]
    steps = np.diff(time)
    limit = max(MIN_GAP_S, 2.0 * float(np.median(np.diff(recording.time))))
    long = np.flatnonzero(steps > limit * (1.0 + 1e-9))
    gaps = [Gap(start_s=float(time[k]), duration_s=float(steps[k])) for k in long]
    return [gap for gap in gaps if not used or any(_within(gap, span) for span in used)]


def _within(gap: Gap, span: tuple[float, float]) -> bool:
    return span[0] <= gap.start_s and gap.start_s + gap.duration_s <= span[1]


def _describe_channels(recording: Recording) -> dict[str, MeasuredChannel]:
    return {
        kind: MeasuredChannel(
            samples=len(channel.time),
            rate_hz=channel.rate,
            start_s=float(channel.time[0]),
            end_s=float(channel.time[-1]),
            measured=tuple(
                name
                for name, column in zip(CHANNEL_KINDS[kind].columns, channel.value.T, strict=True)
                if np.isfinite(column).any()
            ),
        )
        for kind, channel in recording.channels.items()
    }


def _describe_commands(recording: Recording) -> CommandSummary | None:
    time = recording.commands.time
    if not len(time):
        return None
    steps = np.diff(time)
    return CommandSummary(
        kind=recording.commands.kind,
        lines=len(time),
        start_s=float(time[0]),
        end_s=float(time[-1]),
        median_step_s=float(np.median(steps)) if len(steps) else None,
        longest_step_s=float(steps.max()) if len(steps) else None,
        varies=bool(np.ptp(recording.commands.value, axis=0).max() > 0.0),
    )
