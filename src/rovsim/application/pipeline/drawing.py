"""Figures of a study, from what its steps wrote."""

from pathlib import Path
from typing import Mapping, Sequence

from rovsim.evaluation.budget import Budget
from rovsim.measurement.signals.motion import Motion
from rovsim.reporting.figures import kind
from rovsim.reporting.figures.style import save
from rovsim.reporting.report_data import ONCE, ReportData, select_arguments
from rovsim.simulation.prediction import Replay

STUDY = tuple(dict.fromkeys(name for name in ONCE.values() if name != "quality"))


def draw_study(
    figure: str, contents: Mapping[str, Path], quality: Mapping[str, Path], out: Path
) -> None:
    """Draw a figure of all runs into `out`, as PNG and PDF; files by the name of their content."""
    arguments = select_arguments(figure, ReportData.read(contents, quality))
    save(kind(figure).draw(**arguments), out.parent, out.stem)


def draw_run(
    figure: str, motion: Motion, replays: Sequence[Replay], budgets: Sequence[Budget], out: Path
) -> None:
    """Draw a figure of one run into `out`, as PNG and PDF."""
    run = motion.run.id
    data = ReportData(
        motions={run: motion},
        replays={replay.model: {run: replay} for replay in replays},
        budgets={budget.run: budget for budget in budgets},
    )
    arguments = select_arguments(figure, data, run, list(data.replays))
    save(kind(figure).draw(**arguments), out.parent, out.stem)
