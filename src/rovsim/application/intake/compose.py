"""From files to a proposal."""

from pathlib import Path
from typing import Iterator, Sequence

from rovsim.application.intake import checks, sections
from rovsim.application.intake.axes import BODY
from rovsim.application.intake.collect_files import collect_files
from rovsim.application.intake.draft import Draft
from rovsim.application.intake.facts import Facts, find_facts
from rovsim.application.intake.places import Places
from rovsim.application.intake.proposal import CampaignProposal
from rovsim.application.intake.runs import missing, runs
from rovsim.application.intake.unread import list_unread, tell_unread
from rovsim.measurement.survey.timing import Timing


def propose(paths: Sequence[Path], out: Path, scratch: Path) -> CampaignProposal:
    """What a campaign.yaml in the folder `out` would say of these files.

    Copies of files that only rovsim cannot read as they are lie in `scratch` until it is written.

    Raises:
        RovsimError: files that cannot be used, a message for each.
    """
    found = collect_files(paths, scratch)
    facts, places, draft = find_facts(found), Places.beside(found, out), Draft()
    draft.content["name"] = places.name
    sections.vehicle(facts, draft)
    if places.folder:
        draft.content["folder"] = places.folder
        draft.say("folder", "where the recordings lie: they stay there, nothing was copied")
    sections.mocap(facts, draft)
    sections.commands(facts, draft)
    runs(facts, places, draft)
    tell_unread(facts, draft)
    notes = dict.fromkeys(note for one in (*found.motions, *found.logs) for note in one.notes)
    return CampaignProposal(
        draft.content,
        {place: tuple(lines) for place, lines in draft.comments.items()},
        tuple(draft.questions),
        (*_lines(facts), *notes, *list_unread(facts, draft), *found.left_out),
        (*found.apart, *_checked(facts)),
        places.copies,
    )


def _lines(facts: Facts) -> Iterator[str]:
    """A line for each run."""
    for name, one in zip(facts.ids, facts.pairs, strict=True):
        log = f" with {one.log.path.name}" if one.log and one.log.path != one.motion.path else ""
        timing = Timing.of(one.motion.track.export.time)
        yield f"{name}: {one.motion.name}{log}, {timing}{missing(one)}"


def _unused(facts: Facts) -> Iterator[str]:
    """What may hold commands, and is no run's."""
    if not facts.logs:
        for one in facts.collected.unknown:
            yield f"not used as commands: {one}. The runs say 'commands: none'"
    used = [one.log for one in facts.pairs]
    if not any(one.options for one in facts.pairs):
        yield from (f"{log.path.name} belongs to no run" for log in facts.logs if log not in used)


def _checked(facts: Facts) -> Iterator[str]:
    """What looks wrong."""
    for name, one in zip(facts.ids, facts.pairs, strict=True):
        if reason := checks.unusable(one.motion):
            yield f"{name} will not be used: {reason}"
    every = (*facts.motions, *facts.collected.logs)
    yield from (
        f"{file.named.name}: {d}" for one in every for file in one.files for d in file.doubts
    )
    yield from _unused(facts)
    if facts.choice.fit is None or not facts.choice.runs:
        return
    body = facts.axes.body
    axes = BODY[body] if body else facts.choice.turned[0][1]
    if body:
        yield from checks.check_clocks(facts.choice, axes, facts.ids)
    k = max(facts.choice.runs, key=lambda n: int(facts.choice.runs[n].excited.sum()))
    one = facts.pairs[k]
    log = one.shown
    assert log is not None
    lag = facts.choice.runs[k].best(axes)[1]
    said = checks.check_mirror(one.motion, log, facts.choice.fit, axes, lag)
    said = said or checks.check_order(one.motion, log, facts.choice.fit, axes, lag)
    if said:
        yield f"{facts.ids[k]}: {said}"
