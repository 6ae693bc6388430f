"""Write the report of a study from files that its steps wrote."""

from pathlib import Path
from typing import Any, Mapping, Sequence

from rovsim.application.provenance import add_origin
from rovsim.dynamics.catalogue import Catalogue
from rovsim.reporting.figures import list_figures
from rovsim.reporting.html import report
from rovsim.reporting.html.picture import Picture
from rovsim.reporting.report_data import ReportData, describe_figure


def write_report(
    name: str,
    contents: Mapping[str, Path],
    quality: Mapping[str, Path],
    figures: Sequence[Path],
    given: Mapping[str, Any],
    catalogue: Catalogue,
    out: Path,
) -> None:
    """Write the report of a study: everything on one page.

    Args:
        name: of the campaign.
        contents: files by the name of their content.
        quality: reports on quality, by run.
        figures: files of the pictures.
        given: settings and recordings of the study; the code that writes is added.
        catalogue: all effects.
        out: the page.
    """
    data, pictures = ReportData.read(contents, quality), [_read_picture(path) for path in figures]
    story = add_origin(given, catalogue)
    report.write(out, report.Report(name, data, pictures, story, catalogue))


def _read_picture(path: Path) -> Picture:
    """Read a figure's file, which is named after the figure, or `figure-run`."""
    name, _, run = (path.stem, "", "") if path.stem in list_figures() else path.stem.partition("-")
    return Picture.read(path, name, describe_figure(name, run), run)
