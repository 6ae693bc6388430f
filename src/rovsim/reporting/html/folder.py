"""A command's results for the eye: figures as files, and all of them on one page."""

from pathlib import Path
from typing import Iterable, Mapping

from rovsim.core.progress import counted
from rovsim.dynamics.effects.base import Effect
from rovsim.reporting.figures.style import save
from rovsim.reporting.html import report
from rovsim.reporting.html.picture import Drawn, Picture, Wanted
from rovsim.reporting.report_data import ReportData, describe, list_run_figures


def present(
    out: Path,
    campaign: str,
    data: ReportData,
    provenance: Mapping[str, object],
    catalogue: Mapping[str, type[Effect]],
    drawn: Iterable[Drawn] = (),
) -> list[Path]:
    """Draw what is known and not yet `drawn`, write `out`/report.html; returns all files."""
    shown = draw(out, data, drawn)
    page = report.Report(campaign, data, [one.picture for one in shown], provenance, catalogue)
    report.write(out / "report.html", page)
    return [out / "report.html", *(path for one in shown for path in one.files)]


def draw(out: Path, data: ReportData, drawn: Iterable[Drawn] = ()) -> list[Drawn]:
    """All figures of what is known; those that are not yet `drawn` go into `out`/figures."""
    known = {one.wanted: one for one in drawn}
    left = [one for one in list_wanted(data) if one not in known]
    known |= {one: draw_one(out, *one, data) for one in counted(left, "drawing")}
    return [known[one] for one in list_wanted(data)]


def list_wanted(data: ReportData) -> list[Wanted]:
    """All figures of what is known, in the order of the page."""
    once = [(figure, "") for figure in data.figures]
    return once + [(figure.name, run) for run in data.drawn for figure in list_run_figures()]


def draw_one(out: Path, figure: str, run: str, data: ReportData) -> Drawn:
    """Draw one figure of what is known, or of one run of it, into `out`/figures."""
    paths = save(data.draw(figure, run), out / "figures", f"{figure}-{run}" if run else figure)
    png = next(path for path in paths if path.suffix == ".png")
    picture = Picture.read(png, figure, describe(figure, run, data), run)
    return Drawn((figure, run), picture, paths)
