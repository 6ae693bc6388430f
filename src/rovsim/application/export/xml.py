"""Write XML for several targets: documents, comments, numbers, tables of thrust."""

import re
from typing import Sequence
from xml.etree import ElementTree as ET

import numpy as np
from numpy import ndarray as Array

from rovsim.application.export.equation import Equation
from rovsim.core.errors import one_line

# characters that no document of XML 1.0 may hold (sec. 2.2)
ILLEGAL_LETTERS = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
TABLE_COMMANDS = np.linspace(-1.0, 1.0, 11)


def document(root: ET.Element) -> str:
    """Return the text of an XML file, indented."""
    for tag in root.iter():
        tag.text, tag.tail = _legal(tag.text), _legal(tag.tail)
        tag.attrib.update({key: _legal(value) or "" for key, value in tag.attrib.items()})
    ET.indent(root)
    return '<?xml version="1.0"?>\n' + ET.tostring(root, encoding="unicode") + "\n"


def comment(parent: ET.Element, lines: Sequence[str]) -> None:
    """Add lines as a comment, with spaces between hyphens, since two hyphens would end it."""
    inside = "\n".join(f"  {one_line(line)}" for line in lines)
    inside = re.sub("-(?=-)", "- ", inside)
    parent.append(ET.Comment(f"\n{inside}\n"))


def _legal(text: str | None) -> str | None:
    """Replace characters that XML cannot hold, even escaped, by their Python escapes."""
    return text and ILLEGAL_LETTERS.sub(lambda match: repr(match[0])[1:-1], text)


def numbers(values: Sequence[float] | Array) -> str:
    """Format numbers with spaces between them."""
    return " ".join(number(v) for v in values)


def number(value: float) -> str:
    """Format a number to 15 significant digits."""
    return f"{float(value) + 0.0:.15g}"


def force_tables(equation: Equation) -> list[str]:
    """List each thruster's force in N by command, for simulators whose thrusters take newtons."""
    count = len(equation.names)
    if not count:
        return []
    force = equation.static_force(np.tile(TABLE_COMMANDS[:, None], (1, count)))
    head = "  ".join(f"{c:+.1f}" for c in TABLE_COMMANDS)
    lines = ["Thrust in N at the commands", f"  {head}"]
    forces = (force * equation.reach).T
    for name, column, row in zip(equation.names, equation.columns, forces, strict=True):
        note = f"  (follows the command of {equation.names[column]})"
        suffix = note if equation.names[column] != name else ""
        lines.append(f"  {name}: {'  '.join(f'{f:+.2f}' for f in row)}{suffix}")
    return lines
