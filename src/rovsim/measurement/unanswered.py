"""Find questions of `rovsim init` that are still open in a `campaign.yaml`."""

import re
from pathlib import Path
from typing import Any, Iterator

from rovsim.core.errors import BadInput
from rovsim.core.files import read_text

ANSWER = "ANSWER"  # the value of keys that `rovsim init` leaves to the user
ANSWER_LINE = re.compile(rf"^[^#]*\b{ANSWER}\b")


def check_answered(content: Any, file: Path) -> None:
    """Refuse a campaign file in which a question is still open.

    Args:
        content: the file as plain values.
        file: where it was read.

    Raises:
        BadInput: names the lines and the keys that are still to be answered.
    """
    open_places = list(_unanswered(content, ""))
    if not open_places:
        return
    lines = [n for n, line in enumerate(read_text(file).split("\n"), 1) if ANSWER_LINE.match(line)]
    listed = ", ".join(f"line {n} ({p})" for n, p in zip(lines, open_places, strict=False))
    raise BadInput(
        f"still to be answered: {listed or ', '.join(open_places)}",
        where=file,
        expected=f"an answer in place of {ANSWER}; the comment above each line tells the choices",
        remedy="Write the answers into the file.",
    )


def _unanswered(content: Any, place: str) -> Iterator[str]:
    if content == ANSWER:
        yield place
    pairs = content.items() if isinstance(content, dict) else []
    for key, inner in enumerate(content) if isinstance(content, list) else pairs:
        yield from _unanswered(inner, f"{place}.{key}".lstrip("."))
