"""What targets that are written as XML have in common: numbers, comments, tables of thrust."""

import re
from typing import Sequence
from xml.etree import ElementTree as ET

import numpy as np
from numpy import ndarray as Array

from rovsim.application.export.equation import Equation
from rovsim.core.errors import one_line

# what no document of XML 1.0 holds (sec. 2.2)
ILLEGAL = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
TABLE = np.linspace(-1.0, 1.0, 11)  # commands


def document(root: ET.Element) -> str:
    """The file of a tree, indented."""
    for tag in root.iter():
        tag.text, tag.tail = _legal(tag.text), _legal(tag.tail)
        tag.attrib.update({key: _legal(value) or "" for key, value in tag.attrib.items()})
    ET.indent(root)
    return '<?xml version="1.0"?>\n' + ET.tostring(root, encoding="unicode") + "\n"


def comment(parent: ET.Element, lines: Sequence[str]) -> None:
    """Put in lines as they may stand in XML, where two hyphens end a comment."""
    inside = "\n".join(f"  {one_line(line)}" for line in lines)
    inside = re.sub("-(?=-)", "- ", inside)
    parent.append(ET.Comment(f"\n{inside}\n"))


def _legal(text: str | None) -> str | None:
    """A text as XML may hold it: what it cannot hold, even escaped, as it is typed in Python."""
    return text and ILLEGAL.sub(lambda found: repr(found[0])[1:-1], text)


def numbers(values: Sequence[float] | Array) -> str:
    """Numbers with spaces between them."""
    return " ".join(number(v) for v in values)


def number(value: float) -> str:
    """A number to 15 digits."""
    return f"{float(value) + 0.0:.15g}"


def force_tables(equation: Equation) -> list[str]:
    """Newtons of commands, for whoever sends newtons to a simulator that takes no commands."""
    count = len(equation.names)
    if not count:
        return []
    force = equation.static_force(np.tile(TABLE[:, None], (1, count)))
    head = "  ".join(f"{c:+.1f}" for c in TABLE)
    lines = ["Thrust in N at the commands", f"  {head}"]
    pulls = (force * equation.reach).T
    for name, column, row in zip(equation.names, equation.columns, pulls, strict=True):
        follows = f"  (follows the command of {equation.names[column]})"
        swapped = follows if equation.names[column] != name else ""
        lines.append(f"  {name}: {'  '.join(f'{f:+.2f}' for f in row)}{swapped}")
    return lines
