"""The section `runs` of a proposal: their ids, control, split and files."""

from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.intake.draft import CampaignDraft
from rovsim.intake.facts import Facts
from rovsim.intake.names import find_control
from rovsim.intake.pairing import Pair
from rovsim.intake.places import Places
from rovsim.intake.spans import RunEntry, list_run_entries
from rovsim.intake.survey.timing import RowTiming

# rad/s in yaw that the commands alone would cause: beyond, the pilot turned the vehicle. Roll and
# pitch do not tell: whoever pushes below CO has to hold them.
MIN_TURN_RATE = 0.2
NO_LOG_COMMENT = (
    "guess: no log of commands was among the files, and 'none' says that nothing was commanded. If "
    "there is one, put it beside them and begin again"
)


PART_COMMENT = "guess: a run of its own, for nothing was recorded for {:.0f} s before it"
FIRST_COMMENT = (
    "guess: several runs are in this file, one after the other; 'use' says where each is"
)


def runs(facts: Facts, places: Places, draft: CampaignDraft) -> None:
    """Write the section `runs` into the draft, with comments and questions."""
    entries = list_run_entries(facts)
    controls = [_control(facts, entry) for entry in entries]
    splits = split([control for control, _ in controls])
    draft.content["runs"] = []
    for n, entry in enumerate(entries):
        draft.comment(f"runs.{n}", *_remarks(facts, entry))
        content = {
            "id": entry.id,
            "control": controls[n][0],
            "split": splits[n],
            "mocap": _measured(facts, entry.file, places),
            "commands": _log(facts, entry, f"runs.{n}", places, draft),
        }
        draft.content["runs"].append(content | ({"use": [[*entry.use]]} if entry.use else {}))
        draft.comment(f"runs.{n}", controls[n][1])
    reason = "the last run of each control is a test run: nothing is ever fitted to it"
    draft.comment(
        "runs", f"guess: {reason if 'test' in splits else 'no test run, for there is one run'}"
    )


def _remarks(facts: Facts, one: RunEntry) -> list[str]:
    """List comments on a run: what its files hold, and why it is a run."""
    if one.pause:
        return [PART_COMMENT.format(one.pause)]
    comments = [*described(facts.pairs[one.file]), *facts.motions[one.file].notes]
    return [*comments, FIRST_COMMENT] if one.use else comments


def described(one: Pair) -> list[str]:
    """Describe the files of a run: name and timing of its motion, and of its commands."""
    lines = [f"{one.motion.name}: {RowTiming.of(one.motion.track.export.time)}{missing(one)}"]
    if one.log is None:
        return lines
    time = np.unique(one.log.drive.time)
    timing = f"{RowTiming.of(time)}; " if len(time) > 1 else ""
    same_file = one.log.path == one.motion.path
    return [
        *lines,
        f"commands {one.reason}" if same_file else f"{one.log.path.name}: {timing}{one.reason}",
    ]


def missing(one: Pair) -> str:
    """Say what a motion lacks (full poses, or some frames), to append to a sentence; or nothing."""
    export = one.motion.track.export
    if not one.motion.track.posed:
        channels = [f"{kind} at {c.rate:.3g} Hz" for kind, c in export.channels.items() if c.rate]
        return f"; no full poses, but {', '.join(channels)}"
    untracked = int(np.sum(~export.tracked))
    return f", {untracked} of them without the body" if untracked else ""


def _measured(facts: Facts, k: int, places: Places) -> str | list[str]:
    """Return the path of the motion's file, or a list where the run has several."""
    files = [places.of(file.named) for file in facts.motions[k].files]
    return files if len(files) > 1 else files[0]


def _log(facts: Facts, run: RunEntry, place: str, places: Places, draft: CampaignDraft) -> str:
    """Return the path of a run's commands, `none`, or the placeholder of a question."""
    pair = facts.pairs[run.file]
    if pair.log is not None:
        return places.of(pair.log.path)
    if not pair.options:
        draft.comment(place, NO_LOG_COMMENT)
        return "none"
    answers = {places.of(log.path): "" for log in pair.options} | {"none": "nothing was commanded"}
    asks = f"Which file holds the commands of {run.id} ({pair.reason})?"
    return draft.ask(f"{place}.commands", asks, answers)


def _control(facts: Facts, run: RunEntry) -> tuple[str, str]:
    """Tell the control of a run, `3dof` or `6dof`, and why if it is a guess (else nothing)."""
    pair, fit = facts.pairs[run.file], facts.choice.fit
    if control := find_control(pair.motion.path.stem):
        return control, ""
    caused = pair.shown.caused(fit) if pair.shown and fit else None
    if caused is None:
        return "6dof", "guess: 6dof, for nothing says that it was never turned"
    spread = float(_during(run, *caused).std(axis=0)[5])
    name = "6dof" if spread > MIN_TURN_RATE else "3dof"
    return name, f"guess: {name}, by how much its commands turn it ({spread:.2f} rad/s in yaw)"


def _during(run: RunEntry, time: Array, nu: Array) -> Array:
    """Return the rows of velocities (m, 6) that lie in a run; all where the clocks differ."""
    begin, end = run.use or (-np.inf, np.inf)
    during = (time >= begin) & (time <= end)
    return nu[during] if during.any() else nu


def split(controls: Sequence[str]) -> list[str]:
    """Split runs: `test` for the last run of each control that has several, else `train`.

    If no control has several, the last of all runs is a test run, unless it is the only one.
    """
    test_runs = {control: k for k, control in enumerate(controls) if controls.count(control) > 1}
    if not test_runs and len(controls) > 1:
        test_runs = {"": len(controls) - 1}
    return ["test" if k in test_runs.values() else "train" for k in range(len(controls))]
