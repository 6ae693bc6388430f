"""The numbers by which rovsim decides, each with what is said of it where it stands."""

import ast
from dataclasses import dataclass
from pathlib import Path
from typing import Iterator, Sequence

SOURCE = Path(__file__).parents[2] / "src" / "rovsim"
ROOMS = ("measurement/signals", "estimation", "diagnosis", "evaluation", "design")
INTRODUCTION = """\
# Numbers behind decisions

Every number that estimation and diagnosis decide by, as the source has it, with what is said of it
there. Those that a user may choose stand in [Configuration](../configuration.md).
"""


@dataclass(frozen=True)
class Limit:
    """One number, or several of one name."""

    module: str
    name: str
    value: str
    meaning: str


def find_limits(source: Path = SOURCE, rooms: Sequence[str] = ROOMS) -> list[Limit]:
    """All of the rooms, in the order of their files."""
    files = [file for room in rooms for file in sorted((source / room).rglob("*.py"))]
    return [limit for file in files for limit in _read(file, source)]


def write_page(limits: Sequence[Limit]) -> str:
    """A table for each module that has some."""
    lines, module = [INTRODUCTION], ""
    for one in limits:
        if one.module != module:
            module = one.module
            lines += [f"\n## {module}\n", "| number | value | meaning |", "|---|---|---|"]
        meaning = one.meaning.replace("|", r"\|")
        lines.append(f"| `{one.name}` | {one.value} | {meaning} |")
    return "\n".join(lines) + "\n"


def _read(file: Path, source: Path) -> Iterator[Limit]:
    text = file.read_text()
    lines = text.splitlines()
    for node in ast.parse(text).body:
        if not isinstance(node, ast.Assign):
            continue
        name = ast.unparse(node.targets[0]).strip("()")
        if name.upper() == name and _is_number(node.value):
            value = (ast.get_source_segment(text, node.value) or "").strip("()")
            module = file.relative_to(source).with_suffix("").as_posix()
            yield Limit(module, name, value, _comment(lines, node))


def _is_number(value: ast.expr) -> bool:
    """Whether arithmetic of numbers alone, or several of that."""
    parts = ast.walk(value)
    arithmetic = (ast.Tuple, ast.BinOp, ast.UnaryOp, ast.operator, ast.unaryop, ast.expr_context)
    return all(
        isinstance(p, arithmetic)
        or (isinstance(p, ast.Constant) and type(p.value) in (int, float))
        or (isinstance(p, ast.Name) and p.id.isupper())
        for p in parts
    ) and any(isinstance(p, ast.Constant) for p in ast.walk(value))


def _comment(lines: Sequence[str], node: ast.Assign) -> str:
    """What stands behind it, and in the lines above it."""
    above, k = [], node.lineno - 2
    while lines[k].startswith("# "):
        above.insert(0, lines[k][2:])
        k -= 1
    behind = lines[(node.end_lineno or node.lineno) - 1].partition("  # ")[2]
    return " ".join([*above, *([behind] if behind else [])])
