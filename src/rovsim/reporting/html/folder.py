"""A command's results for the eye: figures as files, and all of them on one page."""

from pathlib import Path
from typing import Iterable, Mapping

from rovsim.core.progress import counted
from rovsim.dynamics.effects.base import Effect
from rovsim.reporting.figures import kind
from rovsim.reporting.figures.style import save
from rovsim.reporting.html import report
from rovsim.reporting.report_data import ReportData, describe, select_arguments

Wanted = tuple[str, str]  # figure and run; no run for a figure that is drawn once


def present(
    out: Path,
    campaign: str,
    data: ReportData,
    wanted: Iterable[Wanted],
    provenance: Mapping[str, object],
    catalogue: Mapping[str, type[Effect]],
) -> list[Path]:
    """Draw figures into `out`/figures and write `out`/report.html; returns all that was written."""
    drawn = [_draw(out, *one, data) for one in counted(list(wanted), "drawing")]
    pictures = [picture for picture, _ in drawn]
    report.write(
        out / "report.html", report.Report(campaign, data, pictures, provenance, catalogue)
    )
    return [out / "report.html", *(path for _, paths in drawn for path in paths)]


def _draw(out: Path, figure: str, run: str, data: ReportData) -> tuple[report.Picture, list[Path]]:
    drawn = kind(figure).draw(**select_arguments(figure, data, run, list(data.replays)))
    paths = save(drawn, out / "figures", f"{figure}-{run}" if run else figure)
    png = next(path for path in paths if path.suffix == ".png")
    return report.Picture.read(png, figure, describe(figure, run, data), run), paths
