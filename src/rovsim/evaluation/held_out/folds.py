"""Leave one run out: split the same runs anew, with one run to test and all others to train."""

from dataclasses import replace
from pathlib import Path
from typing import Iterable, Mapping, Sequence, TypeVar

from rovsim.measurement.signals.chain import Stage, read_stage
from rovsim.measurement.signals.motion import Motion

Run = TypeVar("Run", Motion, Stage)


def relabel_split(run: Run, test: str) -> Run:
    """Label a run for the fold that holds out one run: "test" for that run, "train" for others.

    Args:
        run: any run, unchanged but for its split.
        test: id of the run that is held out.
    """
    split = "test" if run.run.id == test else "train"
    return replace(run, run=replace(run.run, split=split))


def write_fold(
    test: str, motions: Iterable[Motion], stages: Iterable[Path], out: Mapping[str, Sequence[Path]]
) -> None:
    """Write all runs anew for the fold that holds out one of them.

    Args:
        test: id of the run that is held out.
        motions: of all runs.
        stages: files of their poses before the filter.
        out: files that are written, of the `motions` and of the `stages`.
    """
    for motion, path in zip(motions, out["motions"], strict=True):
        relabel_split(motion, test).write(path)
    for stage, path in zip(map(read_stage, stages), out["stages"], strict=True):
        relabel_split(stage, test).write(path)
