"""Say what the recordings of a diagnosis could not show, and which parts were not used."""

from typing import Mapping, Sequence

from rovsim.core.axes import AXES, VELOCITY_UNITS
from rovsim.reporting.wording import listed, significant
from rovsim.results.diagnosis import Diagnosis, DisturbedEnd, LookedAt, Standstill


def shown_sentences(diagnosis: Diagnosis) -> list[str]:
    """Say all that the recordings could not show, and which parts of them were not used."""
    return [
        *held_sentences(diagnosis.standstills),
        *map(_say_end, diagnosis.disturbed_ends),
        *unlogged_sentences(diagnosis.unlogged_s),
        *still_sentences(diagnosis.not_excited),
        *idle_sentences(diagnosis.not_commanded),
        *silent_sentences(diagnosis),
        *part_sentences(diagnosis.looked_at),
        *lost_sentences(diagnosis.not_followed_from_s),
    ]


def held_sentences(standstills: Sequence[Standstill]) -> list[str]:
    """Say which runs stand still although the model would move: they may have been held."""
    return [_say_standstill(one) for one in standstills]


def _say_standstill(one: Standstill) -> str:
    unit, use = VELOCITY_UNITS[AXES.index(one.axis)], str([list(span) for span in one.use])
    return (
        f"Run {one.run} stands still from {one.from_s:.1f} to {one.to_s:.1f} s, where the model "
        f"would gain {significant(one.gained, 2)} {unit} in {one.axis}. If it was held by hand or "
        f"lay on the floor, leave that out: `use: {use}` in this run of campaign.yaml."
    )


def _say_end(one: DisturbedEnd) -> str:
    """Say that an end of a run leaves far more than the rest: hands may have moved the vehicle."""
    return (
        f"Run {one.run} leaves {significant(one.times, 2)} times as much from {one.from_s:.1f} to "
        f"{one.to_s:.1f} s as runs do elsewhere (variance), and such ends are most of what is "
        "unexplained. If the vehicle was moved by hand, lifted or aground, leave that out with "
        "`use` in this run of campaign.yaml."
    )


def unlogged_sentences(unlogged: Mapping[str, float]) -> list[str]:
    """Say how many s of train runs were left out, as nobody knows what was commanded."""
    if not unlogged:
        return []
    parts = listed(f"{seconds:.1f} s of {run}" for run, seconds in unlogged.items())
    return [
        f"Not used, as the log of commands has a hole there, begins later or ends earlier: {parts}."
    ]


def still_sentences(axes: Sequence[str]) -> list[str]:
    """Say on which axes no train run moves."""
    if not axes:
        return []
    return [f"Nothing can be said about {listed(axes)}: no train run moves on that axis."]


def idle_sentences(names: Sequence[str]) -> list[str]:
    """Say which thrusters, surfaces or axes were never commanded."""
    if not names:
        return []
    return [f"Never commanded in a train run, and so not judged: {listed(names)}."]


def silent_sentences(diagnosis: Diagnosis) -> list[str]:
    """Say which axes were not measured, and which effects the recordings could not show."""
    axes, effects = diagnosis.not_measured, diagnosis.not_observable
    unmeasured = f"Not measured, and so without errors: {listed(axes)}."
    unseen = f"Even if present, these could not be seen in these recordings: {listed(effects)}."
    return [*([unmeasured] if axes else []), *([unseen] if effects else [])]


def lost_sentences(lost: Mapping[str, float]) -> list[str]:
    """Say which parts of train runs were left out, because the model diverges there.

    Args:
        lost: start of that part by run, s.
    """
    if not lost:
        return []
    parts = listed(f"{run} from {start:.1f} s on" for run, start in lost.items())
    return [f"The model runs away although it is corrected at every reading: {parts} is not used."]


def part_sentences(looked_at: LookedAt | None) -> list[str]:
    """Say how much of long train runs was used, and how much wider that makes intervals."""
    if looked_at is None or looked_at.wider <= 1.0:
        return []
    part, whole = (significant(s / 60.0, 3) for s in (looked_at.seconds, looked_at.of))
    return [
        f"Of {whole} min of train runs, the {part} min that tell most were looked at. With all of "
        f"them the intervals could be up to {looked_at.wider:.1f} times narrower "
        "(search.most_seconds)."
    ]
