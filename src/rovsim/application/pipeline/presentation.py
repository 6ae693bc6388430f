"""Results for the eye: figures, tables and the report of a study, from what its steps wrote."""

from pathlib import Path
from typing import Mapping, Sequence

from rovsim.dynamics.catalogue import Catalogue
from rovsim.evaluation.budget import Budget
from rovsim.measurement.signals.motion import Motion
from rovsim.reporting.figures import kind
from rovsim.reporting.figures.style import save
from rovsim.reporting.html import report
from rovsim.reporting.report_data import ONCE, ReportData, describe, select_arguments
from rovsim.reporting.tables import tabulate_errors, tabulate_ladder
from rovsim.results.comparison import Comparison
from rovsim.results.ladder import Ladder
from rovsim.simulation.prediction import Replay

STUDY = tuple(dict.fromkeys(name for name in ONCE.values() if name != "quality"))
QUANTITIES = ("velocity_rmse", "velocity_mae", "acceleration_rmse")


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


def write_tables(comparison: Path, ladder: Path, folder: Path) -> None:
    """The ladder and the errors on the test runs, as LaTeX and CSV."""
    tabulate_ladder(Ladder.read(ladder)).write(folder, "ladder")
    for quantity in QUANTITIES:
        tabulate_errors(Comparison.read(comparison), "2", "test", quantity).write(folder, quantity)


def write_report(
    campaign: str,
    contents: Mapping[str, Path],
    quality: Mapping[str, Path],
    figures: Sequence[Path],
    provenance: Mapping[str, object],
    catalogue: Catalogue,
    out: Path,
) -> None:
    """Everything on one page; files by the name of their content, reports by run."""
    data, pictures = ReportData.read(contents, quality), [_read_picture(path) for path in figures]
    report.write(out, report.Report(campaign, data, pictures, provenance, catalogue))


def _read_picture(path: Path) -> report.Picture:
    """A figure's file is called by the figure, or by figure-run."""
    name, _, run = (path.stem, "", "") if path.stem in ONCE else path.stem.partition("-")
    return report.Picture.read(path, name, describe(name, run))
