"""Draw one figure of one run."""

from rovsim.application.pipeline.drawing import draw_run
from rovsim.application.snakemake_job import job
from rovsim.results.force_budget import ForceBudget
from rovsim.simulation.prediction import Replay

if __name__ == "__main__":
    with job(snakemake) as rule:
        (motion,) = rule.motions("motion")
        draw_run(
            figure=rule.params.figure,
            motion=motion,
            replays=[Replay.read(path) for path in rule.paths("replays")],
            budgets=[ForceBudget.read(path) for path in rule.paths("budget")],
            out=rule.output("png"),
        )
