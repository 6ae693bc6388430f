"""Draw the figures of a study from files that its steps wrote."""

from pathlib import Path
from typing import Mapping, Sequence

from rovsim.measurement.signals.motion import Motion
from rovsim.reporting.figures.style import save
from rovsim.reporting.report_data import ReportData
from rovsim.results.force_budget import ForceBudget
from rovsim.simulation.prediction import Replay


def draw_study(
    figure: str, contents: Mapping[str, Path], quality: Mapping[str, Path], out: Path
) -> None:
    """Draw a figure of all runs.

    Args:
        figure: its name.
        contents: files by the name of their content.
        quality: reports on quality, by run.
        out: path of the figure; PNG and PDF are written under this name.
    """
    save(ReportData.read(contents, quality).draw(figure), out.parent, out.stem)


def draw_run(
    figure: str,
    motion: Motion,
    replays: Sequence[Replay],
    budgets: Sequence[ForceBudget],
    out: Path,
) -> None:
    """Draw a figure of one run.

    Args:
        figure: its name.
        motion: the run as measured.
        replays: of this run by models.
        budgets: of forces in this run.
        out: path of the figure; PNG and PDF are written under this name.
    """
    run = motion.run.id
    data = ReportData(
        motions={run: motion},
        replays={replay.model: {run: replay} for replay in replays},
        budgets={budget.run: budget for budget in budgets},
    )
    save(data.draw(figure, run), out.parent, out.stem)
