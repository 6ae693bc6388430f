"""What to do where runs differ: a clock, a thruster, a battery, or what was changed for tests."""

from statistics import median
from typing import Mapping, NamedTuple, Sequence

from rovsim.diagnosis.checks.run_differences import RunDifference
from rovsim.dynamics.effects.clocks import InputDelay
from rovsim.dynamics.effects.thrusters import ThrusterGain
from rovsim.dynamics.parameter_labels import label_parameter

ASK_WHAT_CHANGED = (
    "Find out what was changed between the runs, as they differ in {}: the battery, ballast, "
    "markers, the tether. Then diagnose runs that are alike."
)

LOOK_AT_THRUSTERS = (
    "Look at {}: fouled, blocked or dead? Diagnose such runs by themselves, and the others without "
    "them."
)
WEAK_SHARE = 0.9  # of a thruster's usual gain: gains of single ones are known to a hundredth

ALIGN_CLOCKS = (
    "The logs of commands have other clocks: add {} in campaign.yaml, and diagnose again. By so "
    "much later than in {} the motion follows its commands."
)
TRAIN_RUNS = "the train runs"

COMPARE_TEST_RUNS = (
    "Find out what was changed for the test runs: the load, the trim, the battery, the tether, the "
    "clock of the log, or holes in it. Or write `split: train` for some of them and diagnose again."
)


class HeldOutRuns(NamedTuple):
    """What is wrong with the test runs.

    Attributes:
        differ: whether the error on them is far above the noise of the train runs.
        late: by run id, by how many s its log is earlier than those of the train runs, or than that
            of the earliest one where these differ.
    """

    differ: bool = False
    late: Mapping[str, float] = {}


NOTHING_WRONG = HeldOutRuns()


def advise_on_tests(test_runs: HeldOutRuns) -> str:
    """Say what to do where test runs surely differ from the train runs."""
    return _align(test_runs.late, TRAIN_RUNS) if test_runs.late else COMPARE_TEST_RUNS


def advise_on_difference(
    difference: RunDifference, test_runs: HeldOutRuns, thrusters: Sequence[str]
) -> str:
    """Say what to do where an effect has another value in each run."""
    if weak := _list_weak_thrusters(difference, thrusters):
        return LOOK_AT_THRUSTERS.format(", and at ".join(weak))
    if difference.effect_id != InputDelay.id:
        return ASK_WHAT_CHANGED.format(difference.effect_id)
    (first, lag), *others = sorted(difference.values("delay").items(), key=lambda x: x[1])
    return _align({**{run: x - lag for run, x in others}, **test_runs.late}, first)


def _list_weak_thrusters(difference: RunDifference, thrusters: Sequence[str]) -> list[str]:
    """Thrusters that push less in some run than they usually do, where no other gain differs."""
    gains = next(iter(difference.by_run.values())).term.free
    if difference.effect_id != ThrusterGain.id or "all" in gains:
        return []
    weak = []
    for gain in gains:
        by_run = difference.values(gain)
        usual, label = median(by_run.values()), label_parameter(ThrusterGain.id, gain, thrusters)
        weak += [
            f"{label} in {run} ({value:.2f} of its thrust)"
            for run, value in by_run.items()
            if value < WEAK_SHARE * usual
        ]
    return weak


def _align(late: Mapping[str, float], reference: str) -> str:
    """Say how to shift logs, by run id, that are so many s earlier than others."""
    shifts = (f"`commands_shift_s: {x:.3f}` to {run}" for run, x in late.items())
    return ALIGN_CLOCKS.format(", ".join(shifts), reference)
