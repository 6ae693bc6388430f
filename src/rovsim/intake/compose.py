"""Compose the proposal of a campaign.yaml from files."""

from pathlib import Path
from typing import Iterator, Sequence

from numpy import ndarray as Array

from rovsim.evaluation.commanded_motion.cross_correlation import MIN_CORRELATION, rotations
from rovsim.intake import checks, sections
from rovsim.intake.axes import BODY_ROTATIONS
from rovsim.intake.collect_files import collect_files
from rovsim.intake.draft import CampaignDraft
from rovsim.intake.facts import Facts, find_facts
from rovsim.intake.places import Places
from rovsim.intake.proposal import CampaignProposal
from rovsim.intake.runs import missing, runs
from rovsim.intake.survey.timing import RowTiming
from rovsim.intake.unread import comment_unread, list_unread
from rovsim.intake.vehicles import VehicleMatch
from rovsim.measurement.quality.velocity_conventions import doubt_velocities
from rovsim.measurement.recording.readers import mocap_readers


def propose(paths: Sequence[Path], out: Path, scratch: Path) -> CampaignProposal:
    """Propose a campaign.yaml for recordings.

    Args:
        paths: files, bags and folders that the user named.
        out: folder in which campaign.yaml will be written.
        scratch: folder for copies of files that rovsim cannot read as they are. It has to exist
            until the proposal is written.

    Raises:
        RovsimError: files that cannot be used, a message for each.
    """
    collected = collect_files(paths, scratch)
    facts, places, draft = find_facts(collected), Places.beside(collected, out), CampaignDraft()
    draft.content["name"] = places.name
    sections.vehicle(facts, draft)
    if places.folder:
        draft.content["folder"] = places.folder
        draft.comment("folder", "where the recordings lie: they stay there, nothing was copied")
    sections.mocap(facts, draft)
    sections.commands(facts, draft)
    runs(facts, places, draft)
    comment_unread(facts, draft)
    notes = dict.fromkeys(
        note for contents in (*collected.motions, *collected.logs) for note in contents.notes
    )
    return CampaignProposal(
        draft.content,
        {place: tuple(lines) for place, lines in draft.comments.items()},
        tuple(draft.questions),
        (*_lines(facts), *notes, *list_unread(facts, draft), *collected.left_out),
        (*collected.apart, *_checked(facts)),
        places.copies,
    )


def _lines(facts: Facts) -> Iterator[str]:
    """Describe each run in a line: its files, timing, and what its motion lacks."""
    for name, pair in zip(facts.ids, facts.pairs, strict=True):
        log = (
            f" with {pair.log.path.name}" if pair.log and pair.log.path != pair.motion.path else ""
        )
        timing = RowTiming.of(pair.motion.track.export.time)
        yield f"{name}: {pair.motion.name}{log}, {timing}{missing(pair)}"


def _unused(facts: Facts) -> Iterator[str]:
    """Tell of files that hold commands, or may hold some, and that no run uses."""
    if not facts.logs:
        for item in facts.collected.unknown:
            yield f"not used as commands: {item}. The runs say 'commands: none'"
    used_logs = [item.log for item in facts.pairs]
    if not any(item.options for item in facts.pairs):
        yield from (
            f"{log.path.name} belongs to no run" for log in facts.logs if log not in used_logs
        )


def _checked(facts: Facts) -> Iterator[str]:
    """Tell of all that looks wrong in the files."""
    for name, item in zip(facts.ids, facts.pairs, strict=True):
        if reason := checks.unusable(item.motion):
            yield f"{name} will not be used: {reason}"
    sources = (*facts.motions, *facts.collected.logs)
    yield from (
        f"{file.named.name}: {d}" for item in sources for file in item.files for d in file.doubts
    )
    for name, item in zip(facts.ids, facts.pairs, strict=True):
        yield from (f"{name}: {doubt}" for doubt in doubt_velocities(item.motion.track.export))
    yield from _unused(facts)
    if facts.choice.likeliest is not None and facts.choice.runs:
        yield from _against_commands(facts, facts.choice.likeliest)


def _against_commands(facts: Facts, fit: VehicleMatch) -> Iterator[str]:
    """Tell of runs whose motion does not go with the motion that a vehicle's commands cause."""
    runs, body = facts.choice.runs, facts.axes.body
    axes = BODY_ROTATIONS[body] if body else facts.choice.turned[0][1]
    most_excited = max(runs, key=lambda n: int(runs[n].excited.sum()))
    remarks = dict(_by_convention(facts, fit, axes, most_excited))
    if body and facts.choice.fit:
        yield from checks.check_clocks(facts, axes, remarks)
    log = facts.pairs[most_excited].shown
    if log and facts.choice.fit and not remarks:
        lag = runs[most_excited].best(axes)[1]
        remarks[most_excited] = checks.check_order(
            facts.pairs[most_excited].motion, log, fit, axes, lag
        )
    yield from (f"{facts.ids[k]}: {remark}" for k, remark in remarks.items() if remark)


def _by_convention(
    facts: Facts, fit: VehicleMatch, axes: Array, most: int
) -> Iterator[tuple[int, str]]:
    """Tell of runs whose poses seem to be in another convention than the format's.

    Only the run that excites most axes, `most`, and runs that do not follow their commands are
    checked.

    Yields:
        The position of the run, and a sentence.
    """
    possible = [axes] if facts.axes.body else rotations()
    angles = "y_up" not in mocap_readers()[facts.motions[0].format].axes.world
    for k, correlation in facts.choice.runs.items():
        score, lag = correlation.best(axes)
        pair, unrelated = facts.pairs[k], score < MIN_CORRELATION
        if pair.shown and (k == most or unrelated):
            delay = 0.0 if unrelated else lag
            remark = checks.check_attitudes(pair.motion, pair.shown, fit, possible, delay, angles)
            if remark:
                yield k, remark
