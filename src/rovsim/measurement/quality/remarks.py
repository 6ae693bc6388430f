"""Plain sentences about a recording that its owner can act on."""

from typing import Iterator

from rovsim.measurement.recording.repairs import Anomalies, CommandRepairs, MotionRepairs
from rovsim.measurement.signals.measured import MAX_CUTOFF_SHARE
from rovsim.results.quality import Quality

# Above these a recording is worth a second look; they change nothing else.
MAX_MISSING_SHARE = 0.05  # of frames
NOISY_POSITION_M, NOISY_ATTITUDE_RAD = 0.003, 0.015  # three times a usual underwater MoCap
MIN_RATE_HZ = 20.0  # below it thruster lag and added mass are hard to see


def doubt(report: Quality) -> Iterator[str]:
    """Yield sentences about faults that keep a recording from being used as it was meant."""
    if report.unusable:
        yield f"This run cannot be used ({report.unusable}). Record it again or remove it."
    if report.commands is not None and not report.commands.varies:
        yield "The commands never change: check 'commands.columns', or that the log was running."


def remark(report: Quality, anomalies: Anomalies) -> list[str]:
    """List further sentences about a recording, the most important first."""
    return [
        *_motion(report),
        *_frames(report, anomalies.left_out),
        *_commands(report, anomalies.commands),
        *_repairs(report, anomalies),
    ]


def _motion(report: Quality) -> Iterator[str]:
    if report.unusable:
        return
    quiet = [axis for axis, e in report.excitation.items() if not e.excited]
    if quiet:
        yield f"Hardly any motion in {', '.join(quiet)}: little can be said about the model there."


def _frames(report: Quality, left_out: int) -> Iterator[str]:
    if not report.posed:
        yield _held_channels(report)
        return
    share = report.not_found / max(report.frames - left_out, 1)
    if share > MAX_MISSING_SHARE:
        yield f"The body was not found in {share:.0%} of the frames: check markers and cameras."
    if report.longest_gap_s > 0.5:
        yield (f"The longest gap is {report.longest_gap_s:.2f} s; motion across it is not rebuilt.")
    rate = report.rate_hz.median
    if rate < MIN_RATE_HZ:
        yield (
            f"{rate:.3g} Hz is slow: noise is overestimated, lags are hard to see, and the filter "
            f"cuts off at {MAX_CUTOFF_SHARE * rate:.2g} Hz at most."
        )
    noise = report.noise
    if rate >= MIN_RATE_HZ and (
        (noise.position_m or 0.0) > NOISY_POSITION_M
        or (noise.attitude_rad or 0.0) > NOISY_ATTITUDE_RAD
    ):
        yield "The poses are noisy: check the calibration and the marker set of the body."
    if report.outliers and report.outliers > 0.01 * report.frames:
        yield f"{report.outliers} outlier frames: look for swapped markers or reflections."


def _held_channels(report: Quality) -> str:
    channels = [
        f"{kind} ({' '.join(c.measured)}; {f'{c.rate_hz:.3g} Hz' if c.rate_hz else 'once'})"
        for kind, c in report.channels.items()
    ]
    return f"There are no full poses; what was measured is {', '.join(channels)}."


def _commands(report: Quality, repairs: CommandRepairs) -> Iterator[str]:
    if report.commands is None:
        return
    if repairs.long_steps:
        yield (
            f"{repairs.long_steps} command steps are longer than usual (up to "
            f"{report.commands.longest_step_s:.2f} s); the line before is held over them."
        )
    if repairs.clipped:
        yield (
            f"{repairs.clipped} command lines reach beyond [-1, 1] and were limited "
            "to it: check 'commands.kind'."
        )
    if repairs.dropped:
        yield f"{repairs.dropped} command lines without a value were left out."


def _repairs(report: Quality, anomalies: Anomalies) -> Iterator[str]:
    motion, left_out = anomalies.motion, anomalies.left_out
    yield from _lines("frames", motion)
    yield from _lines("command lines", anomalies.commands)
    if motion.wrong_header_rate:
        rate = report.rate_hz.median
        yield f"The header's FREQUENCY is not the {rate:.4g} Hz of the times; the times are used."
    if left_out:
        yield f"{left_out} frames lie outside of what `use` says, and were left out."
    if motion.bad_rotations:
        yield f"{motion.bad_rotations} frames hold no rotation and count as not found."


def _lines(what: str, repairs: MotionRepairs | CommandRepairs) -> Iterator[str]:
    if repairs.unsorted:
        yield f"{repairs.unsorted} {what} were out of order and were sorted by time."
    if repairs.duplicates:
        yield f"{repairs.duplicates} {what} repeated a time and were left out."
    if repairs.cut_lines:
        yield f"The last of the {what} is cut short and was left out: was the export complete?"
