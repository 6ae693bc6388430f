"""Draw one figure of one run."""

from pathlib import Path

from rovsim.application.snakemake_job import job
from rovsim.evaluation.budget import Budget
from rovsim.measurement.signals.motion import Motion
from rovsim.reporting.figures import kind
from rovsim.reporting.figures.style import save
from rovsim.reporting.report_data import Evidence, arguments
from rovsim.simulation.prediction import Replay


def main(*, figure: str, motion: Path, replays: list[Path], budgets: list[Path], out: Path) -> None:
    measured, found = Motion.read(motion), [Replay.read(path) for path in replays]
    run = measured.run.id
    pushed = {found.run: found for found in map(Budget.read, budgets)}
    evidence = Evidence({run: measured}, {r.model: {run: r} for r in found}, budgets=pushed)
    drawn = kind(figure).draw(**arguments(figure, evidence, run, [r.model for r in found]))
    save(drawn, out.parent, out.stem)


if __name__ == "__main__":
    with job(snakemake):
        main(
            figure=snakemake.params.figure,
            motion=Path(snakemake.input.motion),
            replays=[Path(path) for path in snakemake.input.replays],
            budgets=[Path(path) for path in snakemake.input.budget],
            out=Path(snakemake.output.png),
        )
