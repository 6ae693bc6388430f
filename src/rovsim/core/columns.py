"""Fold text between words to fit a terminal of 80 columns; commands to type are not broken."""

import re
import textwrap

TERMINAL_WIDTH = 80  # unless it was made wider
PIP_COMMAND = re.compile(r"pip install '[^']*'")
NO_BREAK_SPACE = "\N{NO-BREAK SPACE}"


def fold(text: str, first: str = "", then: str | None = None) -> list[str]:
    """Fold one paragraph into lines.

    Args:
        text: the paragraph.
        first: put in front of the first line.
        then: put in front of the other lines; by default `first`.
    """
    lines = textwrap.wrap(
        PIP_COMMAND.sub(lambda match: match[0].replace(" ", NO_BREAK_SPACE), text),
        TERMINAL_WIDTH,
        initial_indent=first,
        subsequent_indent=first if then is None else then,
        break_long_words=False,
        break_on_hyphens=False,
    )
    return [line.replace(NO_BREAK_SPACE, " ") for line in lines]


def fold_page(text: str) -> str:
    """Fold a text of several paragraphs; lines of a usage (`rovsim …`) stay separate lines."""
    paragraphs = (_fold_paragraph(paragraph) for paragraph in text.strip().split("\n\n"))
    return "\n\n".join("\n".join(lines) for lines in paragraphs)


def _fold_paragraph(text: str) -> list[str]:
    usage = re.match(r"rovsim \w+ ", text)
    if usage is None:
        return fold(" ".join(text.split()))
    margin = " " * len(usage[0])
    lines = text.splitlines()
    return [
        line
        for row in lines
        for line in ([row] if len(row) <= TERMINAL_WIDTH else fold(row, "", margin))
    ]
