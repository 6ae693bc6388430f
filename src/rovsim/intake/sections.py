"""Write the sections of a proposal: what is known, what is a guess, and what has to be asked."""

from typing import Any

from numpy import ndarray as Array

from rovsim.core.robust import usual_range
from rovsim.core.shipped import conf_names
from rovsim.intake.draft import CampaignDraft
from rovsim.intake.facts import Facts
from rovsim.measurement.recording.candidates import CommandCandidate
from rovsim.measurement.recording.readers import mocap_readers

AXES_MEANINGS = {
    "z_up": "right-handed, z up",
    "ned": "right-handed, z down",
    "y_up": "right-handed, y up: what Motive exports unless it was changed",
    "flu": "x forward, y left, z up",
    "frd": "x forward, y right, z down",
    "fur": "x forward, y up, z right",
}
KIND_MEANINGS = {
    "pwm": "pulses in µs, 1500 at rest",
    "normalized": "-1 to 1 for each thruster",
    "demand": "-1 to 1 for each axis, through the vehicle's mixer",
    "wrench": "N and N m for each axis",
}
WALLS_COMMENT = (
    "tank: {{x: [0, 10], y: [0, 5], z: [0, 3]}} would tell walls, floor and surface (m, along the "
    "axes of the world); the motion is within {}"
)


def vehicle(facts: Facts, draft: CampaignDraft) -> None:
    """Write the key `vehicle` into the draft, as a guess or as a question."""
    choice = facts.choice
    if choice.fit is not None:
        draft.content["vehicle"] = choice.fit.name
        draft.comment("vehicle", f"guess: {choice.reason}")
        return
    names = [fit.name for fit in choice.fits] or conf_names("vehicle")
    asks = (
        f"Which vehicle was it ({choice.reason})? Its name, or the path of your own vehicle file:"
    )
    draft.content["vehicle"] = draft.ask("vehicle", asks, names, free=True)


def mocap(facts: Facts, draft: CampaignDraft) -> None:
    """Write the section `mocap`: what measured the motion, of which body, along which axes."""
    motion, track = facts.motions[0], facts.pairs[0].motion.track
    section: dict[str, Any] = {"format": motion.format}
    draft.content["mocap"] = section
    if facts.body.choices != ("",):
        asks = "Which one is the vehicle?"
        section["body"] = facts.body.name or draft.ask("mocap.body", asks, facts.body.choices)
        draft.comment("mocap.body", facts.body.reason)
    if track.topics:
        section["topics"] = dict(track.topics)
    _axes(facts, draft, section)
    if track.export.nu is not None:
        section["velocity"] = "mean"
        draft.comment(
            "mocap.velocity",
            "guess: a line's velocity is the mean up to the next line; 'instant' where it holds at "
            "its time",
        )
    if track.posed:
        draft.comment(
            "mocap", WALLS_COMMENT.format(_extent(track.export.position[track.export.tracked]))
        )


def _extent(position: Array) -> str:
    low, high = usual_range(position)
    return ", ".join(f"{n} {a:.2f} to {b:.2f}" for n, a, b in zip("xyz", low, high, strict=True))


def _axes(facts: Facts, draft: CampaignDraft, section: dict[str, Any]) -> None:
    axes = facts.axes
    file_axes = mocap_readers()[section["format"]].axes
    if axes.body and axes.world:
        section |= {"world_axes": axes.world, "body_axes": axes.body}
        draft.comment("mocap.world_axes", axes.reason)
        return
    pairs = " or ".join(f"{world} with {body}" for world, body in axes.likely)
    level = f" The vehicle is upright on average in {pairs}." if pairs else ""
    reason = f" ({axes.reason})" if axes.reason else ""
    for key, answer, choices, owner in (
        ("world_axes", axes.world, file_axes.world, "world"),
        ("body_axes", axes.body, file_axes.body, "rigid body"),
    ):
        asks = f"Which way do the axes of the {owner} point{reason}?{level}"
        meanings: dict[str, str] = {name: AXES_MEANINGS[name] for name in choices}
        section[key] = answer or draft.ask(f"mocap.{key}", asks, meanings)


def commands(facts: Facts, draft: CampaignDraft) -> None:
    """Write the section `commands`: how the commands were logged; nothing without a log."""
    if facts.log is None:
        return
    drive, fit = facts.log.drive, facts.choice.fit
    section: dict[str, Any] = {"format": drive.format}
    section |= {"topic": drive.topic} if drive.topic else {}
    kind = None if facts.kind_asked else fit.kind if fit else drive.kind
    asks = f"What are these ({_first_asked(facts).reason})?"
    section["kind"] = kind or draft.ask("commands.kind", asks, _kinds(facts))
    draft.comment("commands.kind", drive.reason if kind else "")
    section["columns"] = list(fit.columns) if fit else _columns(facts, draft)
    section |= {"axes": list(drive.axes)} if drive.axes else {}
    section |= {"auxiliary": list(drive.auxiliary)} if drive.auxiliary else {}
    if fit and kind in ("pwm", "normalized") and not fit.by_name:
        draft.comment("commands.columns", "guess: in the order of the vehicle's thrusters")
    topics = {d.topic for motion in facts.motions for d in motion.drives if d.topic} - {drive.topic}
    if topics:
        draft.comment(
            "commands.topic", f"other commands there: {', '.join(sorted(map(str, topics)))}"
        )
    draft.content["commands"] = section


def _first_asked(facts: Facts) -> CommandCandidate:
    """Return the commands whose kind has to be asked, if any, else those of `facts.log`."""
    assert facts.log is not None
    drives = (log.drive for log in facts.logs if log.drive.asked)
    return next(drives, facts.log.drive)


def _kinds(facts: Facts) -> dict[str, str]:
    """List kinds to choose from: only demand and wrench for columns that are named after axes."""
    of_axes = ("demand", "wrench")
    named_by_axis = facts.kind_asked and _first_asked(facts).kind in of_axes
    return {name: KIND_MEANINGS[name] for name in (of_axes if named_by_axis else KIND_MEANINGS)}


def _columns(facts: Facts, draft: CampaignDraft) -> list[str] | str:
    """Return all columns of the log if every vehicle that fits takes all of them; else ask."""
    assert facts.log is not None
    drive = facts.log.drive
    choices = dict.fromkeys(fit.columns for fit in facts.choice.fits)
    if all(len(columns) == len(drive.columns) for columns in choices):
        return list(drive.columns)
    answers = [f"[{', '.join(columns)}]" for columns in choices]
    asks = f"Which of {', '.join(drive.columns)} go to the vehicle's thrusters, in its order?"
    return draft.ask("commands.columns", asks, answers, free=True)
