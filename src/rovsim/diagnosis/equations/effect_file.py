"""A law as a file: one effect in the form that `docs/your_own_effect.md` explains."""

from collections import Counter
from dataclasses import dataclass
from typing import Iterator, Sequence

from rovsim import AXES
from rovsim.diagnosis.equations.as_effect import list_moved
from rovsim.diagnosis.equations.library import LawTerm
from rovsim.diagnosis.equations.variables import (
    DEEP,
    DIRECTION,
    EAST,
    IN_CODE,
    NEAR,
    NORTH,
    ON,
    SPEED,
    SWIRL,
    VARIABLES,
    WATER,
    WORLD,
    unit_of,
)
from rovsim.diagnosis.observer.hypothesis import Term

FORCES = ("X", "Y", "Z", "K", "M", "N")
WORLD_FORCES = ("F_n", "F_e", "F_d")
FLOWS = ("v_n", "v_e")
PLACES = {"x": ("m", "x_0", 0.5), "y": ("m", "y_0", 0.5), "z": ("m", "z_0", 0.5),
          "width": ("m", "s", 0.2)}  # fmt: skip
MARGIN = 88  # columns of a written line


@dataclass(frozen=True)
class Number:
    """One parameter of a written effect: in which unit, and how sure."""

    name: str
    unit: str
    symbol: str
    value: float
    std: float
    scale: float


def list_numbers(terms: Sequence[LawTerm], law: Term, std: Sequence[float]) -> list[Number]:
    """The parameters of a law in the units of its equation.

    Args:
        terms: what it is made of.
        law: with its fitted values.
        std: of its free parameters.
    """
    sure = dict(zip(law.free, std, strict=True))
    found = []
    for k, (name, term) in enumerate(zip(name_terms(terms), terms, strict=True), start=1):
        size = law.effect[f"size{k}"]
        value = law.effect[f"c{k}"] * size
        scale = float(f"{max(abs(value), 1e-6):.1g}")
        unit, symbol = unit_of(term.on, term.factors), f"c_{k}" if len(terms) > 1 else "c"
        found.append(Number(name, unit, symbol, value, sure[f"c{k}"] * size, scale))
    for name in list_moved(terms):
        unit, symbol, scale = PLACES[name]
        found.append(Number(name, unit, symbol, law.effect[name], sure[name], scale))
    return found


def name_terms(terms: Sequence[LawTerm]) -> list[str]:
    """A parameter's name for each term: of what it acts on, numbered where that comes twice."""
    heads = [ON[t.on].replace(" ", "_") for t in terms]
    count, found = Counter(heads), []
    for k, head in enumerate(heads):
        found.append(head if count[head] == 1 else f"{head}_{heads[: k + 1].count(head)}")
    return found


def write_equation(terms: Sequence[LawTerm]) -> str:
    """The law in LaTeX."""
    rows: dict[str, list[str]] = {}
    for k, term in enumerate(terms, start=1):
        symbol = f"c_{k}" if len(terms) > 1 else "c"
        factors = r"\,".join(_powers(term.factors))
        for head, extra in _heads(term.on):
            sign, inner = ("-", extra[1:]) if extra.startswith("-") else ("+", extra)
            text = r"\,".join(part for part in (symbol, factors, inner) if part)
            rows.setdefault(head, []).append(f"{sign} {text}")
    return r",\quad ".join(f"{head} = {_joined(parts)}" for head, parts in rows.items())


def _joined(parts: Sequence[str]) -> str:
    text = " ".join(parts)
    return text[2:] if text.startswith("+ ") else "-" + text[2:]


def _heads(on: int) -> list[tuple[str, str]]:
    """What stands left of the equals sign, and a further factor on the right."""
    if on < WORLD:
        return [(FORCES[on], "")]
    if on < WATER:
        return [(WORLD_FORCES[on - WORLD], "")]
    if on < SWIRL:
        return [(FLOWS[on - WATER], "")]
    return [(FLOWS[0], "-" + VARIABLES[EAST].latex), (FLOWS[1], VARIABLES[NORTH].latex)]


def _powers(factors: Sequence[int]) -> list[str]:
    """LaTeX of factors, equal ones as a power."""
    found = []
    for k, count in Counter(factors).items():
        text = VARIABLES[k].latex
        found.append(text if count == 1 else f"{text}^{count}")
    return found


def write_file(
    name: str, terms: Sequence[LawTerm], law: Term, numbers: Sequence[Number], story: str
) -> str:
    """Python source of the effect.

    Args:
        name: its id.
        terms: what it is made of.
        law: with its fitted values.
        numbers: its parameters.
        story: where it comes from, one line.
    """
    body = list(_body(terms, law))
    code = "\n".join(body)
    maths = [f for f in ("exp", "sqrt", "tanh") if f"{f}(" in code]
    imports = f"from math import {', '.join(maths)}\n\n" if maths else ""
    starts = {n.name: float(f"{n.value:.6g}") for n in numbers}
    places = [n for n in numbers if n.name in PLACES]
    return FILE.format(
        story=story, meaning=describe(terms), imports=imports, id=name,
        equation=write_equation(terms),
        title="".join(part.capitalize() for part in name.split("_")),
        parameters="\n".join(_parameter(n) for n in numbers),
        starts=f"    starts = ({starts},)\n" if places else "",
        body="\n".join(f"        {line}" for line in body),
    )  # fmt: skip


def describe(terms: Sequence[LawTerm]) -> str:
    """What a law says, in a sentence."""
    parts = []
    for term in terms:
        varies = list(dict.fromkeys(VARIABLES[k].meaning for k in term.factors)) or ["nothing"]
        if term.on == SWIRL:
            varies = ["the distance from a place", *(v for v in varies if v != "nothing")]
        acts = _acts(term.on)
        parts.append(f"{acts} that varies with {' and '.join(varies)}")
    text = "; ".join(parts)
    return text[0].upper() + text[1:] + "."


def _acts(on: int) -> str:
    if on < WORLD:
        return f"a {AXES[on]} {'moment' if on >= 3 else 'force'}"
    if on < WATER:
        return f"a force towards {ON[on]}" if on < WORLD + 2 else "a force downwards"
    return (
        f"water that moves {ON[on].split()[-1]}" if on < SWIRL else "water that turns about a place"
    )


def _parameter(n: Number) -> str:
    more = ", low=0.05" if n.name == "width" else ""
    more += f", default={n.value:.6g}" if n.name in PLACES else ""
    return f'        Parameter("{n.name}", "{n.unit}", r"{n.symbol}"{more}, scale={n.scale:g}),'


def _body(terms: Sequence[LawTerm], law: Term) -> Iterator[str]:
    """Lines of the method."""
    used = {k for t in terms for k in t.factors}
    yield from _velocities(used, terms)
    yield from _surroundings(used, terms)
    values: dict[str, list[str]] = {}
    for name, term in zip(name_terms(terms), terms, strict=True):
        text = " * ".join([f"p.{name}", *(VARIABLES[k].code for k in term.factors)])
        for head, extra in _heads_in_code(term.on):
            values.setdefault(head, []).append(text + extra)
    for head, parts in values.items():
        yield f"{head} = " + " + ".join(parts)
    body = {f: f for f in FORCES if f in values}
    world = [v if v in values else "0.0" for v in ("Fn", "Fe", "Fd")]
    if any(v != "0.0" for v in world):
        yield from _turned(world)
        body |= {
            f: f"{body[f]} + force_{f.lower()}" if f in body else f"force_{f.lower()}"
            for f in FORCES[:3]
        }
    flow = [v if v in values else "0.0" for v in ("vn", "ve")]
    if any(v != "0.0" for v in flow):
        yield from _carried(flow, law)
        body |= {
            f: f"{body[f]} + drag_{f.lower()}" if f in body else f"drag_{f.lower()}"
            for f in FORCES[:3]
        }
    yield "return " + ", ".join(body.get(f, "0.0") for f in FORCES)


def _heads_in_code(on: int) -> list[tuple[str, str]]:
    if on < WORLD:
        return [(FORCES[on], "")]
    if on < WATER:
        return [(("Fn", "Fe", "Fd")[on - WORLD], "")]
    if on < SWIRL:
        return [(("vn", "ve")[on - WATER], "")]
    return [("vn", " * -east"), ("ve", " * north")]


def _velocities(used: set[int], terms: Sequence[LawTerm]) -> Iterator[str]:
    named = {k % 6 for k in used if k < 18}
    if used & {SPEED, DIRECTION} or any(t.on >= WATER for t in terms):
        named |= {0, 1, 2}
    for i in sorted(named):
        yield f"{IN_CODE[i]} = at.nu_r[{i}]"
    if used & {SPEED, DIRECTION}:
        yield "U = sqrt(u * u + v * v + w * w)"
    for i in sorted({(k - 18) % 3 for k in used if 18 <= k < 24}):
        yield f"d{'xyz'[i]} = at.R[2][{i}]  # the world's down, seen in the body"


def _surroundings(used: set[int], terms: Sequence[LawTerm]) -> Iterator[str]:
    turning = any(t.on == SWIRL for t in terms)
    if used & {NORTH, NEAR} or turning:
        yield "north = at.position[0] - p.x * at.axes[0]"
    if used & {EAST, NEAR} or turning:
        yield "east = at.position[1] - p.y * at.axes[1]"
    if DEEP in used:
        yield "deep = at.position[2] - p.z * at.axes[2]"
    if NEAR in used:
        yield "near = exp(-(north * north + east * east) / (2.0 * p.width * p.width))"


def _turned(world: Sequence[str]) -> Iterator[str]:
    """A force of the world seen in the body."""
    for j, f in enumerate("xyz"):
        parts = [f"at.R[{i}][{j}] * {v}" for i, v in enumerate(world) if v != "0.0"]
        yield f"force_{f} = " + " + ".join(parts)


def _carried(flow: Sequence[str], law: Term) -> Iterator[str]:
    """What water that moves adds to the drag of the vehicle."""
    yield "# drag in water that moves, less that in still water, with the model's coefficients"
    for j, (f, v) in enumerate(zip("xyz", IN_CODE[:3], strict=True)):
        parts = [f"at.R[{i}][{j}] * {one}" for i, one in enumerate(flow) if one != "0.0"]
        a, b = (float(f"{law.effect[f'{kind}{j}']:.6g}") for kind in ("linear", "quadratic"))
        yield f"a = {v} - ({' + '.join(parts)})"
        yield f"drag_{f} = ({a:g} + {b:g} * abs({v})) * {v} - ({a:g} + {b:g} * abs(a)) * a"


FILE = '''\
"""{story}

A proposal: read it, change it, and see with `rovsim compare effects_file=…` what it is worth.
"""

{imports}from rovsim.dynamics.effects.base import Parameter, Wrench


class {title}(Wrench):
    """{meaning}"""

    id = "{id}"
    equation = r"{equation}"
    neglects = "whatever the recordings did not show"
    source = "regression on what no effect of the catalogue explained"
    parameters = (
{parameters}
    )
{starts}
    @staticmethod
    def wrench(at, p):
        """Wrench at CO along the body's axes: ahead, starboard, down."""
{body}
'''
