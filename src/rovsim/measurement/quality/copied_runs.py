"""Find runs with the same files: test runs that copy a train run, and runs that share a log."""

import filecmp
from pathlib import Path
from typing import Iterator

from rovsim.measurement.campaign import Campaign
from rovsim.measurement.campaign_file import Run


def doubt_copy(campaign: Campaign, run: Run) -> Iterator[str]:
    """Yield a sentence for each train run whose files and used spans a test run copies."""
    if run.split != "test":
        return
    paths = campaign.mocap_paths(run)
    for other in campaign.runs:
        other_paths = campaign.mocap_paths(other)
        if other.split == "train" and _overlap(run, other) and _equal(paths, other_paths):
            yield (
                f"This test run holds the recording of train run {other.id}: its errors say "
                "nothing of a run that nobody has seen. Hold another run out."
            )


def list_same_log(campaign: Campaign, run: Run) -> list[str]:
    """List the ids of other runs that name the log of commands of a run, with other recordings."""
    if not run.commanded:
        return []
    mocap, log = campaign.mocap_paths(run), campaign.commands_path(run)
    return [
        other.id
        for other in campaign.runs
        if other.commanded
        and campaign.commands_path(other) == log
        and campaign.mocap_paths(other) != mocap
    ]


def _overlap(run: Run, other: Run) -> bool:
    """Whether the used spans of two runs overlap."""
    if run.use is None or other.use is None:
        return True
    return any(a < d and c < b for a, b in run.use for c, d in other.use)


def _equal(own: list[Path], theirs: list[Path]) -> bool:
    return len(own) == len(theirs) and all(
        a == b or (a.is_file() and b.is_file() and filecmp.cmp(a, b, shallow=False))
        for a, b in zip(own, theirs, strict=True)
    )
