"""Earlier reports in a folder: those of another command are kept, outdated ones removed."""

import os
import re
from base64 import b64encode
from dataclasses import dataclass
from html import unescape
from pathlib import Path
from typing import Iterable, Sequence

# What only the report of a command contains; that of a study contains both.
SECTION_MARKS = {"compare": 'id="compare"', "diagnose": 'id="verdict"'}
CAMPAIGN_PATTERN = re.compile(r'<meta name="campaign" content="([^"]*)">')


def keep_other(page: Path, command: str) -> str:
    """Rename the report `page` if another command wrote it, so that it is not overwritten.

    Args:
        page: where a report is about to be written.
        command: that writes it.

    Returns:
        A sentence that says so; empty where nothing was renamed.
    """
    writer = _find_kind(page)
    if writer in ("", command):
        return ""
    new_path = _page_of_command(page, writer)
    os.replace(page, new_path)
    return f"{page} was the report of {writer}: it is {new_path} now."


@dataclass(frozen=True)
class Outdated:
    """What the next report of a command makes outdated.

    Attributes:
        figures: PNG files that the earlier reports of this command show.
        pages: earlier reports that the new one does not overwrite.
        notice: a sentence if the earlier reports are of another campaign; else empty.
    """

    figures: tuple[Path, ...] = ()
    pages: tuple[Path, ...] = ()
    notice: str = ""

    def remove(self, drawn: Iterable[Path]) -> None:
        """Remove all that the new report did not overwrite; `drawn` are its figures."""
        names = {path.stem for path in drawn}
        for path in self.figures:
            if path.stem not in names:
                path.unlink(missing_ok=True)
                path.with_suffix(".pdf").unlink(missing_ok=True)
        for page in self.pages:
            page.unlink(missing_ok=True)


def find_outdated(page: Path, command: str, campaign: str | None) -> Outdated:
    """Find what a new report makes outdated; changes nothing.

    Call it before the first figure of the new report is drawn: a figure belongs to an earlier
    report if that contains the same picture, whatever its file is called.

    Args:
        page: where the report is about to be written.
        command: that writes it.
        campaign: folder of its campaign; None if there is none.
    """
    other_page = _page_of_command(page, command)
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
    """Say that results of another campaign were replaced; empty if that is the same or is gone."""
    match = CAMPAIGN_PATTERN.search(text)
    other = Path(unescape(match[1])) if match else Path()
    if not match or campaign is None or not other.exists():
        return ""
    if _description(other) == _description(Path(campaign)):
        return ""
    return (
        f"{out} held the results of another campaign, {other}: these have replaced them. To keep "
        "both, give another out=, or each its own 'name' in campaign.yaml."
    )


def _description(campaign: Path) -> Path:
    """The file that describes a campaign, which may be named by its folder as well."""
    place = campaign.expanduser().resolve()
    return place / "campaign.yaml" if place.is_dir() else place


def _page_of_command(page: Path, command: str) -> Path:
    return page.with_name(f"{page.stem}_{command}{page.suffix}")


def _find_kind(page: Path) -> str:
    """Return which command wrote a report, or "study"; empty where there is no such report."""
    if not page.is_file():
        return ""
    text = page.read_text(encoding="utf-8", errors="replace")
    kinds = [command for command, section in SECTION_MARKS.items() if section in text]
    return "study" if len(kinds) > 1 else kinds[0] if kinds else ""
