"""List columns of the files that nothing uses: they are named, never dropped in silence."""

from collections import defaultdict
from pathlib import Path
from typing import Sequence

from rovsim.intake.draft import CampaignDraft
from rovsim.intake.facts import Facts
from rovsim.intake.pairing import Pair
from rovsim.intake.spans import list_run_entries
from rovsim.intake.survey.contents import Contents

MAX_LISTED = 20  # names of columns or files in a sentence


def list_unread(facts: Facts, draft: CampaignDraft) -> list[str]:
    """List unused columns: a sentence for all files whose unused columns are the same."""
    files: dict[tuple[str, ...], list[str]] = defaultdict(list)
    for contents in _every(facts):
        if columns := _left(contents, facts, draft):
            files[columns].append(contents.named.name)
    return [f"not used: {_named(columns)} (in {_named(names)})" for columns, names in files.items()]


def comment_unread(facts: Facts, draft: CampaignDraft) -> None:
    """Write unused columns as comments above the first run of each file."""
    by_path = {item.named: item for item in _every(facts)}
    first_run = {item.file: n for n, item in reversed([*enumerate(list_run_entries(facts))])}
    for k, (motion, pair) in enumerate(zip(facts.motions, facts.pairs, strict=True)):
        paths = dict.fromkeys([*(file.named for file in motion.files), *_log(pair)])
        for item in (by_path[path] for path in paths):
            if columns := _left(item, facts, draft):
                draft.comment(
                    f"runs.{first_run[k]}", f"{item.named.name}: not used: {_named(columns)}"
                )


def _every(facts: Facts) -> list[Contents]:
    """List all files; those that were put together for one run are listed one by one."""
    collected = (*facts.motions, *facts.collected.logs)
    return [file for contents in collected for file in contents.files]


def _log(pair: Pair) -> list[Path]:
    return [] if pair.log is None else [pair.log.path]


def _left(one: Contents, facts: Facts, draft: CampaignDraft) -> tuple[str, ...]:
    """List columns of a file that are neither measurements nor commands of a run."""
    section = draft.content.get("commands", {})
    used: set[str] = set()
    if any(log.path == one.named for log in facts.logs):
        columns = section.get("columns", [])
        # an open question names all columns that may be meant
        listed = columns if isinstance(columns, list) else one.unread
        used = {name.removeprefix("-") for name in (*listed, *section.get("auxiliary", []))}
    return tuple(name for name in one.unread if name not in used)


def _named(names: Sequence[str]) -> str:
    suffix = f" and {len(names) - MAX_LISTED} more" if len(names) > MAX_LISTED else ""
    return ", ".join(names[:MAX_LISTED]) + suffix
