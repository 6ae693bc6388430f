"""Leave one run out: the same runs, split anew."""

from dataclasses import replace
from typing import TypeVar

from rovsim.measurement.recording.recording import Recording
from rovsim.measurement.signals.motion import Motion, Poses

Run = TypeVar("Run", Motion, Poses, Recording)


def held_out(run: Run, test: str) -> Run:
    """The run as it is, in the fold of the run `test`: that one is for test, any other to train."""
    split = "test" if run.run.id == test else "train"
    return replace(run, run=replace(run.run, split=split))
