"""A run of a sweep, unless it is finished: an interrupted sweep goes on where it stopped."""

from pathlib import Path

from rovsim.application.settings import Settings
from rovsim.apps.cli.dispatch import run_command
from rovsim.apps.cli.output import say
from rovsim.core.columns import fold

CONTINUED = ("compare", "diagnose", "train")  # commands all of whose results are in `out`


def run_unfinished(settings: Settings, out: Path) -> None:
    """Run a command whose results go to the folder `out`; say so where that was done before.

    A run is marked as finished only if all that it depends on is the same at its end.
    """
    from rovsim.application.pipeline.finished_runs import (
        MARK,
        digest_inputs,
        is_finished,
        mark_finished,
    )

    run = settings.model_copy(update={"out": str(out)})
    if settings.command not in CONTINUED or settings.campaign is None:
        run_command(run)
        return
    inputs = digest_inputs(settings, settings.campaign)
    if is_finished(out, inputs):
        text = (
            f"{out}: finished before, and nothing that it depends on has changed since: kept. "
            f"(Without {out / MARK} it is run again.)"
        )
        say(settings, "\n".join(fold(text)), {"kept": str(out)})
        return
    run_command(run)
    if digest_inputs(settings, settings.campaign) == inputs:
        mark_finished(out, inputs)
