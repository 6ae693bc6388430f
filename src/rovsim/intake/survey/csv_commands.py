"""Find commands among the columns of a csv file, by their names and numbers."""

import re
from dataclasses import replace
from typing import Iterable, NamedTuple

import numpy as np
from numpy import ndarray as Array

from rovsim.core import pwm
from rovsim.core.axes import AXES
from rovsim.core.pwm import PILOT_CHANNELS
from rovsim.intake.survey.command_names import find_range, find_wrench, has_other_unit
from rovsim.intake.survey.other_numbers import TimedColumns, find_numbers, find_sparse
from rovsim.measurement.campaign_file import LoggedKind
from rovsim.measurement.recording.candidates import CommandCandidate
from rovsim.measurement.recording.commands import MAX_PERCENT, guess_unit, within
from rovsim.measurement.recording.tables.delimited import Lines

RADIO_CHANNEL = re.compile(r"(?:rc|rcin_?c?|chan)_?(\d+)(?:_raw)?", re.IGNORECASE)
MAX_THOUSANDTHS = 1050.0  # how far shares of a full stick reach that were multiplied by 1000
HALF_TOLERANCE = 0.1  # of commands whose medians lie so near to it
HALF_AT_REST = "numbers within 0 and 1 about 0.5; if 0.5 is at rest, write 2 x - 1 and normalized"


def find_commands(lines: Lines, others: TimedColumns) -> CommandCandidate | None:
    """Find the columns that look like commands; None where there are none.

    Args:
        lines: of the file.
        others: its columns that are no measured channel.
    """
    voltage = ("voltage",) if lines.names.count("voltage") == 1 else ()
    candidate = _commands(*find_numbers(others), voltage)
    if candidate is None:
        candidate = _commands(*find_sparse(others), ())
        return candidate if candidate and candidate.kind else None
    return candidate


def _commands(
    time: Array, columns: dict[str, Array], voltage: tuple[str, ...]
) -> CommandCandidate | None:
    """Find commands among columns of numbers: radio channels, forces, pulses or shares.

    Args:
        time: (m,) s.
        columns: (m,) each, by name.
        voltage: name of a column of battery voltage, if there is one.
    """
    if radio := _radio(columns):
        candidate = _pilot(time, columns, radio)
    else:
        likely = _likely_commands(columns)
        forces = find_wrench(columns) if likely.kind not in ("pwm", "demand") else {}
        if not forces and not likely.columns:
            return None
        candidate = _forces(time, columns, forces) if forces else _logged(time, columns, likely)
    return replace(candidate, auxiliary=voltage)


def _pilot(time: Array, columns: dict[str, Array], radio: dict[str, str]) -> CommandCandidate:
    """Take columns of a pilot's radio, by ArduSub's channels (`_radio`), for demands."""
    return CommandCandidate(
        "csv",
        tuple("-" * (c[0] == "-") + name for c, name in radio.items()),
        time,
        _stacked(columns, radio.values()),
        "demand",
        "the pilot's radio by ArduSub's order of channels",
        axes=tuple(PILOT_CHANNELS[c] for c in radio),
    )


def _forces(time: Array, columns: dict[str, Array], forces: dict[str, str]) -> CommandCandidate:
    """Take columns for forces and moments, by the axes on which they act."""
    value = _stacked(columns, forces.values())
    return CommandCandidate(
        "csv",
        tuple(forces.values()),
        time,
        value,
        "wrench",
        "guess: forces and moments by their names, N and N m: x forward, y right, z down",
        axes=tuple(forces),
        asked=within(value.ravel(), "demand"),
    )


def _logged(time: Array, columns: dict[str, Array], likely: "_LikelyCommands") -> CommandCandidate:
    """Take the columns that are likely commands; the others are kept beside them."""
    kind, names, reason = likely
    value = _stacked(columns, names)
    return CommandCandidate(
        "csv",
        tuple(names),
        time,
        pwm.of_outputs(value)[0] if kind == "pwm" else value,
        kind,
        reason,
        rest={name: column for name, column in columns.items() if name not in names},
        asked=kind == "wrench" or reason == HALF_AT_REST,
    )


def _stacked(columns: dict[str, Array], names: Iterable[str]) -> Array:
    return np.stack([columns[name] for name in names], axis=1)


def _radio(columns: dict[str, Array]) -> dict[str, str]:
    """Find columns of a pilot's radio, such as RC1 or chan1_raw, by ArduSub's channels."""
    numbered = {
        f"RC{int(match[1])}": name
        for name, value in columns.items()
        if (match := RADIO_CHANNEL.fullmatch(name)) and within(value, "pwm")
    }
    return {c: numbered[c.lstrip("-")] for c in PILOT_CHANNELS if c.lstrip("-") in numbered}


class _LikelyCommands(NamedTuple):
    """Columns that are likely commands.

    Attributes:
        kind: of the commands; None where the numbers do not tell it.
        columns: their names; none where there are no commands.
        reason: how both are known, for a person to read.
    """

    kind: LoggedKind | None
    columns: list[str]
    reason: str


def _likely_commands(columns: dict[str, Array]) -> _LikelyCommands:
    """Find the columns that are likely commands, and their kind, by their names and numbers."""
    axes = [name for name in columns if name in AXES]
    if len(axes) > 1 or (axes and len(columns) == 1):
        if all(within(columns[name], "demand") for name in axes):
            return _LikelyCommands("demand", axes, "named after axes, within -1 and 1")
        if all(within(columns[name], "pwm") for name in axes):
            reason = "named after axes, pulses in us (-heave where long is up)"
            return _LikelyCommands("demand", axes, reason)
        return _LikelyCommands("wrench", axes, _wrench([columns[name] for name in axes]))
    plain = {name: value for name, value in columns.items() if not has_other_unit(name)}
    pulses = [name for name in plain if within(columns[name], "pwm")]
    if pulses:
        values = [value[~pwm.absent(value)] for value in map(columns.__getitem__, pulses)]
        low, high = find_range(values)
        reason = f"all from {low:.0f} to {high:.0f}: pulses in us"
        return _LikelyCommands("pwm", ordered(pulses), reason)
    shares = [name for name in plain if within(columns[name], "normalized")]
    if shares and len(shares) == len(columns):
        if _rests_at_half([columns[name] for name in shares]):
            return _LikelyCommands("normalized", ordered(shares), HALF_AT_REST)
        return _LikelyCommands("normalized", ordered(shares), "all within -1 and 1")
    numbered = [name for name in columns if re.search(r"\d$", name)]
    reason = _sizes([columns[name] for name in numbered])
    return _LikelyCommands(None, ordered(numbered), reason)


def _rests_at_half(values: list[Array]) -> bool:
    """Whether shares lie within 0 and 1, about the middle: then 0.5 may be at rest."""
    low, high = find_range(values)
    usual = float(np.median([np.nanmedian(value) for value in values]))
    return low >= 0.0 and high <= 1.0 and low < 0.5 < high and abs(usual - 0.5) < HALF_TOLERANCE


def ordered(names: list[str]) -> list[str]:
    """Sort names by the numbers they end in, if they differ in nothing else."""
    parts = [re.fullmatch(r"(.*?)(\d+)", name) for name in names]
    if not all(parts) or len({part[1] for part in parts if part}) > 1:
        return names
    return sorted(names, key=lambda name: int(re.sub(r".*?(\d+)$", r"\1", name)))


def _wrench(values: list[Array]) -> str:
    """Say what columns named after axes may be: their size does not tell forces from percent."""
    low, high = find_range(values)
    remark = f"named after axes, beyond -1 and 1 ({low:.4g} to {high:.4g})"
    if max(-low, high) <= MAX_PERCENT:
        return f"{remark}. If these are percent, divide them by 100 and write demand"
    if max(-low, high) <= MAX_THOUSANDTHS:
        return f"{remark}. If these are thousandths, divide them by 1000 and write demand"
    return remark


def _sizes(values: list[Array]) -> str:
    if not values:
        return ""
    low, high = find_range(values)
    unit = guess_unit(low, high)
    return f"numbers from {low:.4g} to {high:.4g}" + (f", perhaps {unit}" if unit else "")
