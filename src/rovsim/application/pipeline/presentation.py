"""Write the tables and the report of a study from files that its steps wrote."""

from pathlib import Path
from typing import Mapping, Sequence

from rovsim.dynamics.catalogue import Catalogue
from rovsim.reporting.figures import list_figures
from rovsim.reporting.html import report
from rovsim.reporting.html.picture import Picture
from rovsim.reporting.report_data import ReportData, describe_figure
from rovsim.reporting.tables import tabulate_errors, tabulate_ladder
from rovsim.results.comparison import Comparison
from rovsim.results.ladder import Ladder

QUANTITIES = ("velocity_rmse", "velocity_mae", "acceleration_rmse")


def write_tables(comparison: Path, ladder: Path, folder: Path) -> None:
    """Write the ladder and the errors on the test runs into a folder, as LaTeX and CSV."""
    tabulate_ladder(Ladder.read(ladder)).write(folder, "ladder")
    for quantity in QUANTITIES:
        table = tabulate_errors(Comparison.read(comparison), quantity=quantity)
        table.write(folder, quantity)


def write_report(
    campaign: str,
    contents: Mapping[str, Path],
    quality: Mapping[str, Path],
    figures: Sequence[Path],
    provenance: Mapping[str, object],
    catalogue: Catalogue,
    out: Path,
) -> None:
    """Write the report of a study: everything on one page.

    Args:
        campaign: its name.
        contents: files by the name of their content.
        quality: reports on quality, by run.
        figures: files of the pictures.
        provenance: of the study.
        catalogue: all effects.
        out: the page.
    """
    data, pictures = ReportData.read(contents, quality), [_read_picture(path) for path in figures]
    report.write(out, report.Report(campaign, data, pictures, provenance, catalogue))


def _read_picture(path: Path) -> Picture:
    """Read a figure's file, which is named after the figure, or `figure-run`."""
    name, _, run = (path.stem, "", "") if path.stem in list_figures() else path.stem.partition("-")
    return Picture.read(path, name, describe_figure(name, run), run)
