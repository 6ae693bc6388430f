"""The runs of a proposal: their names, control, split and files."""

from typing import Sequence

import numpy as np

from rovsim.intake.draft import Draft
from rovsim.intake.facts import Facts
from rovsim.intake.names import said_control
from rovsim.intake.pairing import Pair
from rovsim.intake.places import Places
from rovsim.intake.survey.timing import Timing

# rad/s that the commands alone would cause in yaw: beyond, the pilot turned the vehicle. Roll and
# pitch do not tell: whoever pushes below CO has to hold them.
TURNING = 0.2
NOTHING = (
    "guess: no log of commands was among the files, and 'none' says that nothing was commanded. If "
    "there is one, put it beside them and begin again"
)


def runs(facts: Facts, places: Places, draft: Draft) -> None:
    """All runs."""
    controls = [_control(facts, k) for k in range(len(facts.pairs))]
    splits = split([control for control, _ in controls])
    draft.content["runs"] = []
    for k, one in enumerate(facts.pairs):
        draft.say(f"runs.{k}", *described(one), *facts.motions[k].notes)
        draft.content["runs"].append(
            {
                "id": facts.ids[k],
                "control": controls[k][0],
                "split": splits[k],
                "mocap": _measured(facts, k, places),
                "commands": _log(facts, k, places, draft),
            }
        )
        draft.say(f"runs.{k}", controls[k][1])
    held = "the last run of each control is a test run: nothing is ever fitted to it"
    draft.say("runs", f"guess: {held if 'test' in splits else 'no test run, for there is one run'}")


def described(one: Pair) -> list[str]:
    """What the files of a run hold."""
    lines = [f"{one.motion.name}: {Timing.of(one.motion.track.export.time)}{missing(one)}"]
    if one.log is None:
        return lines
    time = np.unique(one.log.drive.time)
    timing = f"{Timing.of(time)}; " if len(time) > 1 else ""
    own = one.log.path == one.motion.path
    return [*lines, f"commands {one.said}" if own else f"{one.log.path.name}: {timing}{one.said}"]


def missing(one: Pair) -> str:
    """What a motion lacks."""
    export = one.motion.track.export
    if not one.motion.track.posed:
        held = [f"{kind} at {c.rate:.3g} Hz" for kind, c in export.channels.items() if c.rate]
        return f"; no full poses, but {', '.join(held)}"
    lost = int(np.sum(~export.found))
    return f", {lost} of them without the body" if lost else ""


def _measured(facts: Facts, k: int, places: Places) -> str | list[str]:
    """The file of the sensors, or the files."""
    files = [places.of(file.named) for file in facts.motions[k].files]
    return files if len(files) > 1 else files[0]


def _log(facts: Facts, k: int, places: Places, draft: Draft) -> str:
    one = facts.pairs[k]
    if one.log is not None:
        return places.of(one.log.path)
    if not one.options:
        draft.say(f"runs.{k}", NOTHING)
        return "none"
    answers = {places.of(log.path): "" for log in one.options} | {"none": "nothing was commanded"}
    asks = f"Which file holds the commands of {facts.ids[k]} ({one.said})?"
    return draft.ask(f"runs.{k}.commands", asks, answers)


def _control(facts: Facts, k: int) -> tuple[str, str]:
    """Control of a run, and why where it is a guess."""
    if said := said_control(facts.pairs[k].motion.path.stem):
        return said, ""
    log, fit = facts.pairs[k].shown, facts.choice.fit
    caused = log.caused(fit) if log and fit else None
    if caused is None:
        return "6dof", "guess: 6dof, for nothing says that it was never turned"
    spread = float(caused[1].std(axis=0)[5])
    name = "6dof" if spread > TURNING else "3dof"
    return name, f"guess: {name}, by how much its commands turn it ({spread:.2f} rad/s in yaw)"


def split(controls: Sequence[str]) -> list[str]:
    """`test` for the last run of each control, where there are two."""
    last = {control: k for k, control in enumerate(controls) if controls.count(control) > 1}
    if not last and len(controls) > 1:
        last = {"": len(controls) - 1}
    return ["test" if k in last.values() else "train" for k in range(len(controls))]
