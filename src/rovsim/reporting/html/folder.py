"""A command's results for the eye: figures as files, and all of them on one page."""

from pathlib import Path
from typing import Any, Iterable, Mapping

from rovsim.core.progress import counted
from rovsim.dynamics.effects.base import Effect
from rovsim.reporting.figures import kind
from rovsim.reporting.figures.style import save
from rovsim.reporting.html import page
from rovsim.reporting.report_data import Evidence, about, arguments

Wanted = tuple[str, str]  # figure and run; no run for a figure that is drawn once


def present(
    out: Path,
    campaign: str,
    evidence: Evidence,
    wanted: Iterable[Wanted],
    provenance: Mapping[str, Any],
    catalogue: Mapping[str, type[Effect]],
) -> list[Path]:
    """Draw figures into `out`/figures and write `out`/report.html; returns all that was written."""
    drawn = [_drawn(out, *one, evidence) for one in counted(list(wanted), "drawing")]
    inputs = page.ReportInputs(
        campaign, evidence.comparison, evidence.ladder, evidence.timing, evidence.quality,
        [picture for picture, _ in drawn], provenance, evidence.where, evidence.diagnosis,
        catalogue=catalogue,
    )  # fmt: skip
    page.write(out / "report.html", inputs)
    return [out / "report.html", *(path for _, paths in drawn for path in paths)]


def _drawn(out: Path, figure: str, run: str, evidence: Evidence) -> tuple[page.Picture, list[Path]]:
    content = kind(figure).draw(**arguments(figure, evidence, run, list(evidence.replays)))
    paths = save(content, out / "figures", f"{figure}-{run}" if run else figure)
    png = next(path for path in paths if path.suffix == ".png")
    return page.Picture.read(png, figure, about(figure, run, evidence)), paths
