"""Write the figures and the report of a command's results into a folder."""

from concurrent.futures import Executor, Future, wait
from pathlib import Path
from typing import Any, Iterable, Mapping

from rovsim.core.progress import counted
from rovsim.dynamics.effects.base import Effect
from rovsim.reporting.figures import find_figure
from rovsim.reporting.figures.style import save
from rovsim.reporting.html import report
from rovsim.reporting.html.picture import Drawn, Picture, Wanted
from rovsim.reporting.report_data import ReportData, describe_figure, list_run_figures


def present(
    out: Path,
    campaign: str,
    data: ReportData,
    provenance: Mapping[str, object],
    catalogue: Mapping[str, type[Effect]],
    drawn: Iterable[Drawn] = (),
    other: Executor | None = None,
) -> list[Path]:
    """Draw all figures that are not yet drawn, and write report.html.

    Args:
        out: the folder.
        campaign: its name.
        data: the results.
        provenance: nested plain values: settings, code digest, versions.
        catalogue: effects of the diagnosis, by id.
        drawn: figures that are drawn already.
        other: a second process, which draws half of them; None for none.

    Returns:
        All files that were written.
    """
    figures = draw(out, data, drawn, other)
    page = report.Report(campaign, data, [f.picture for f in figures], provenance, catalogue)
    report.write(out / "report.html", page)
    return [out / "report.html", *(path for f in figures for path in f.files)]


def draw(
    out: Path, data: ReportData, drawn: Iterable[Drawn] = (), other: Executor | None = None
) -> list[Drawn]:
    """Return all figures of the results; those that are not yet `drawn` go into `out`/figures."""
    finished = {figure.wanted: figure for figure in drawn}
    elsewhere: dict[Wanted, Future[Drawn]] = {}
    pending = [figure for figure in list_wanted(data) if figure not in finished]
    try:
        for k, figure in enumerate(counted(pending, "drawing")):
            content = describe_figure(*figure, data), data.select(*figure)
            if other is not None and k % 2:
                elsewhere[figure] = other.submit(draw_selected, out, *figure, *content)
            else:
                finished[figure] = draw_selected(out, *figure, *content)
        finished |= {figure: future.result() for figure, future in elsewhere.items()}
    finally:  # after an error the folder is removed: nothing may still be drawn into it
        for future in elsewhere.values():
            future.cancel()
        wait(elsewhere.values())
    return [finished[figure] for figure in list_wanted(data)]


def list_wanted(data: ReportData) -> list[Wanted]:
    """List all figures that can be drawn of the results, in the order of the page."""
    once = [(figure, "") for figure in data.figures]
    return once + [(figure.name, run) for run in data.drawn for figure in list_run_figures()]


def draw_one(out: Path, figure: str, run: str, data: ReportData) -> Drawn:
    """Draw one figure of the results, or of one run, into `out`/figures."""
    return draw_selected(
        out, figure, run, describe_figure(figure, run, data), data.select(figure, run)
    )


def draw_selected(
    out: Path, figure: str, run: str, about: str, content: Mapping[str, Any]
) -> Drawn:
    """Draw one figure into `out`/figures.

    Args:
        out: the folder of the report.
        figure: its name.
        run: that it shows; empty for a figure of all runs.
        about: what it shows, see `Picture`.
        content: arguments of its `draw`, as `ReportData.select` returns them.
    """
    plot = find_figure(figure).draw(**content)
    paths = save(plot, out / "figures", f"{figure}-{run}" if run else figure)
    png = next(path for path in paths if path.suffix == ".png")
    return Drawn((figure, run), Picture.read(png, figure, about, run), paths)
