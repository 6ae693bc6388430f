"""Reports of another command in the folder that the next one is written to."""

import os
from pathlib import Path

# What only the report of that command shows; one of a study shows both.
SECTIONS = {"compare": 'id="compare"', "diagnose": 'id="verdict"'}


def keep_other(page: Path, command: str) -> str:
    """Rename the report `page` if another command wrote it, so that one of `command` replaces none.

    Returns a sentence that says so; empty where there was nothing to keep.
    """
    found = _find_kind(page)
    if found in ("", command):
        return ""
    kept = page.with_name(f"{page.stem}_{found}{page.suffix}")
    os.replace(page, kept)
    return f"{page} was the report of {found}: it is {kept} now."


def _find_kind(page: Path) -> str:
    """Which command wrote a report, or `study`; empty: there is none that a command wrote."""
    if not page.is_file():
        return ""
    text = page.read_text(encoding="utf-8", errors="replace")
    kinds = [command for command, section in SECTIONS.items() if section in text]
    return "study" if len(kinds) > 1 else kinds[0] if kinds else ""
