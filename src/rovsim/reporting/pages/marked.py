"""Replace the tables between two marks of a page."""

from pathlib import Path
from typing import Iterable, Sequence

from rovsim.core.errors import BadInput
from rovsim.core.files import read_text, write_text

BEGIN, END = "<!-- tables: begin -->", "<!-- tables: end -->"


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a Markdown table."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def replace_tables(path: Path, text: str) -> None:
    """Replace what stands between the marks of a page.

    Raises:
        BadInput: the page does not have each mark once.
    """
    page = read_text(path)
    if page.count(BEGIN) != 1 or page.count(END) != 1:
        raise BadInput(
            "the marks of the tables are not there once each",
            where=path,
            expected=f"one line '{BEGIN}' and one line '{END}'",
            remedy="Restore them.",
        )
    before, rest = page.split(BEGIN)
    write_text(path, f"{before}{BEGIN}\n\n{text}\n\n{END}{rest.split(END)[1]}")
