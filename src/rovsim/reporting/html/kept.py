"""Reports already in the folder that one is written to: kept if another command's, or outdated."""

import os
import re
from base64 import b64encode
from dataclasses import dataclass
from html import unescape
from pathlib import Path
from typing import Iterable, Sequence

# What only the report of that command shows; one of a study shows both.
SECTIONS = {"compare": 'id="compare"', "diagnose": 'id="verdict"'}
FOLDER = re.compile(r'<meta name="campaign" content="([^"]*)">')


def keep_other(page: Path, command: str) -> str:
    """Rename the report `page` if another command wrote it, so that one of `command` replaces none.

    Returns a sentence that says so; empty where there was nothing to keep.
    """
    writer = _find_kind(page)
    if writer in ("", command):
        return ""
    new_path = _kept(page, writer)
    os.replace(page, new_path)
    return f"{page} was the report of {writer}: it is {new_path} now."


@dataclass(frozen=True)
class Outdated:
    """What the next report of a command makes outdated.

    Attributes:
        figures: PNG files beside the earlier reports of this command that these show.
        pages: those of them that do not have the name of the new one.
        told: a sentence where they were of another campaign; empty where not.
    """

    figures: tuple[Path, ...] = ()
    pages: tuple[Path, ...] = ()
    told: str = ""

    def remove(self, drawn: Iterable[Path]) -> None:
        """Remove what the new report, with these figures, did not replace."""
        names = {path.stem for path in drawn}
        for path in self.figures:
            if path.stem not in names:
                path.unlink(missing_ok=True)
                path.with_suffix(".pdf").unlink(missing_ok=True)
        for page in self.pages:
            page.unlink(missing_ok=True)


def find_outdated(page: Path, command: str, campaign: str | None) -> Outdated:
    """What a report `page` that `command` is about to write makes outdated; changes nothing.

    To be asked before the first of its figures is drawn. A figure that an earlier report shows
    belongs to it, whatever it is called; one that was drawn anew since does not.
    """
    other_page = _kept(page, command)
    earlier = [report for report in (page, other_page) if _find_kind(report) == command]
    texts = [report.read_text(encoding="utf-8", errors="replace") for report in earlier]
    figures = [
        path
        for path in sorted((page.parent / "figures").glob("*.png"))
        if _shows(texts, path.read_bytes())
    ]
    notice = next(filter(None, (_tell_other(page.parent, text, campaign) for text in texts)), "")
    return Outdated(tuple(figures), (other_page,) if other_page in earlier else (), notice)


def _shows(texts: Sequence[str], picture: bytes) -> bool:
    code = b64encode(picture).decode()
    return any(code in text for text in texts)


def _tell_other(out: Path, text: str, campaign: str | None) -> str:
    """What is replaced, if it is of another campaign that is still there."""
    match = FOLDER.search(text)
    other = Path(unescape(match[1])) if match else Path()
    if not match or campaign is None or not other.exists():
        return ""
    if other.resolve() == Path(campaign).expanduser().resolve():
        return ""
    return (
        f"{out} held the results of another campaign, {other}: these have replaced them. To keep "
        "both, give another out=, or each its own 'name' in campaign.yaml."
    )


def _kept(page: Path, command: str) -> Path:
    return page.with_name(f"{page.stem}_{command}{page.suffix}")


def _find_kind(page: Path) -> str:
    """Which command wrote a report, or `study`; empty: there is none that a command wrote."""
    if not page.is_file():
        return ""
    text = page.read_text(encoding="utf-8", errors="replace")
    kinds = [command for command, section in SECTIONS.items() if section in text]
    return "study" if len(kinds) > 1 else kinds[0] if kinds else ""
