"""Plain sentences about a recording that its owner can act on."""

from typing import Iterator

from rovsim.measurement.signals.measured import HIGHEST
from rovsim.results.quality import Quality

# Above these a recording is worth a second look; they change nothing else.
MANY_MISSING = 0.05  # share of frames
NOISY_POSITION, NOISY_ATTITUDE = 0.003, 0.015  # m, rad: three times a usual underwater MoCap
SLOW = 20.0  # Hz; below it thruster lag and added mass are hard to see


def doubt(report: Quality) -> Iterator[str]:
    """Yield sentences about faults that keep a recording from being used as it was meant."""
    if report.unusable:
        yield f"This run cannot be used ({report.unusable}). Record it again or remove it."
    if report.commands is not None and not report.commands.varies:
        yield "The commands never change: check 'commands.columns', or that the log was running."


def remark(report: Quality) -> list[str]:
    """List further sentences about a recording, the most important first."""
    return [*_motion(report), *_frames(report), *_commands(report), *_repairs(report)]


def _motion(report: Quality) -> Iterator[str]:
    if report.unusable:
        return
    quiet = [axis for axis, e in report.excitation.items() if not e.excited]
    if quiet:
        yield f"Hardly any motion in {', '.join(quiet)}: nothing can be said about the model there."


def _frames(report: Quality) -> Iterator[str]:
    if not report.posed:
        yield _held_channels(report)
        return
    share = report.not_found / max(report.frames - report.repairs["left_out"], 1)
    if share > MANY_MISSING:
        yield f"The body was not found in {share:.0%} of the frames: check markers and cameras."
    if report.longest_gap_s > 0.5:
        yield (f"The longest gap is {report.longest_gap_s:.2f} s; motion across it is not rebuilt.")
    rate = report.rate_hz.median
    if rate < SLOW:
        yield (
            f"{rate:.3g} Hz is slow: noise is overestimated, lags are hard to see, and the filter "
            f"cuts off at {HIGHEST * rate:.2g} Hz at most."
        )
    noise = report.noise
    if rate >= SLOW and (
        (noise.position_m or 0.0) > NOISY_POSITION or (noise.attitude_rad or 0.0) > NOISY_ATTITUDE
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


def _commands(report: Quality) -> Iterator[str]:
    commands, repairs = report.commands, report.repairs
    if commands is None:
        return
    if repairs["command_long_steps"]:
        yield (
            f"{repairs['command_long_steps']} command steps are longer than usual (up to "
            f"{commands.longest_step_s:.2f} s); the line before is held over them."
        )
    if repairs["command_clipped"]:
        yield (
            f"{repairs['command_clipped']} command lines reach beyond [-1, 1] and were limited "
            "to it: check 'commands.kind'."
        )
    if repairs["command_dropped"]:
        yield f"{repairs['command_dropped']} command lines without a value were left out."


def _repairs(report: Quality) -> Iterator[str]:
    repairs = report.repairs
    for prefix, lines in (("", "frames"), ("command_", "command lines")):
        unsorted, duplicates = repairs[f"{prefix}unsorted"], repairs[f"{prefix}duplicates"]
        if unsorted:
            yield f"{unsorted} {lines} were out of order and were sorted by time."
        if duplicates:
            yield f"{duplicates} {lines} repeated a time and were left out."
        if repairs[f"{prefix}cut_lines"]:
            yield f"The last of the {lines} is cut short and was left out: was the export complete?"
    if repairs["wrong_header_rate"]:
        rate = report.rate_hz.median
        yield f"The header's FREQUENCY is not the {rate:.4g} Hz of the times; the times are used."
    if repairs["left_out"]:
        yield f"{repairs['left_out']} frames lie outside of what `use` says, and were left out."
    if repairs["bad_rotations"]:
        yield f"{repairs['bad_rotations']} frames hold no rotation and count as not found."
