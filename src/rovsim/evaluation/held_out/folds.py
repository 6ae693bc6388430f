"""Leave one run out: split the same runs anew, with one run to test and all others to train."""

from dataclasses import replace
from typing import TypeVar

from rovsim.measurement.recording.recording import Recording
from rovsim.measurement.signals.motion import Motion, Poses

Run = TypeVar("Run", Motion, Poses, Recording)


def relabel_split(run: Run, test: str) -> Run:
    """Label a run for the fold that holds out one run: "test" for that run, "train" for others.

    Args:
        run: any run, unchanged but for its split.
        test: id of the run that is held out.
    """
    split = "test" if run.run.id == test else "train"
    return replace(run, run=replace(run.run, split=split))
