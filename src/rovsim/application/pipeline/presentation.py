"""Results for the eye: figures, tables and the report of a study, from what its steps wrote."""

from pathlib import Path
from typing import Any, Mapping, Sequence

from rovsim.core.files import read_json
from rovsim.dynamics.catalogue import Catalogue
from rovsim.evaluation.budget import Budget
from rovsim.measurement.signals.motion import Motion
from rovsim.reporting.figures import kind
from rovsim.reporting.figures.style import save
from rovsim.reporting.html import page
from rovsim.reporting.report_data import ONCE, Evidence, about, arguments
from rovsim.reporting.tables import errors_table, ladder_table
from rovsim.simulation.prediction import Replay

STUDY = tuple(dict.fromkeys(name for name in ONCE.values() if name != "quality"))
QUANTITIES = ("velocity_rmse", "velocity_mae", "acceleration_rmse")


def draw_study(
    figure: str, contents: Mapping[str, Path], quality: Mapping[str, Path], out: Path
) -> None:
    """Draw a figure of all runs into `out`, as PNG and PDF; files by the name of their content."""
    found = {name: read_json(path) for name, path in contents.items()}
    reports = {run: read_json(path) for run, path in quality.items()}
    evidence = Evidence({}, {}, quality=reports, **found)
    save(kind(figure).draw(**arguments(figure, evidence)), out.parent, out.stem)


def draw_run(
    figure: str, motion: Motion, replays: Sequence[Replay], budgets: Sequence[Budget], out: Path
) -> None:
    """Draw a figure of one run into `out`, as PNG and PDF."""
    run, models = motion.run.id, [replay.model for replay in replays]
    evidence = Evidence(
        {run: motion}, {r.model: {run: r} for r in replays}, budgets={b.run: b for b in budgets}
    )
    save(kind(figure).draw(**arguments(figure, evidence, run, models)), out.parent, out.stem)


def write_tables(comparison: Path, ladder: Path, folder: Path) -> None:
    """The ladder and the errors on the test runs, as LaTeX and CSV."""
    ladder_table(read_json(ladder)).write(folder, "ladder")
    for quantity in QUANTITIES:
        errors_table(read_json(comparison), "2", "test", quantity).write(folder, quantity)


def write_report(
    campaign: str,
    contents: Mapping[str, Path],
    quality: Mapping[str, Path],
    figures: Sequence[Path],
    provenance: Mapping[str, Any],
    catalogue: Catalogue,
    out: Path,
) -> None:
    """Everything on one page; files by the name of their content, reports by run."""
    found = {name: read_json(path) for name, path in contents.items()}
    reports = {run: read_json(path) for run, path in quality.items()}
    inputs = page.ReportInputs(
        campaign, quality=reports, pictures=[_picture(path) for path in figures],
        provenance=provenance, catalogue=catalogue, **found,
    )  # fmt: skip
    page.write(out, inputs)


def _picture(path: Path) -> page.Picture:
    """A figure's file is called by the figure, or by figure-run."""
    name, _, run = (path.stem, "", "") if path.stem in ONCE else path.stem.partition("-")
    return page.Picture.read(path, name, about(name, run))
