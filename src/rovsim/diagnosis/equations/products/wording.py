"""A law of products in LaTeX and in words."""

from collections import Counter
from typing import Sequence

from rovsim import AXES
from rovsim.core.axes import FORCE
from rovsim.diagnosis.equations.products.library import LawTerm
from rovsim.diagnosis.equations.products.variables import ON, VARIABLES
from rovsim.dynamics.effects.law_codes import EAST, NORTH, SWIRL, WATER, WORLD

WORLD_FORCES = ("F_n", "F_e", "F_d")
FLOWS = ("v_n", "v_e")


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
        return [(FORCE[on], "")]
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


def list_quantities(term: LawTerm) -> tuple[str, ...]:
    """What a term varies with: velocities by their symbols, attitude, place, depth, speed."""
    found = [_QUANTITY.get(VARIABLES[k].meaning, VARIABLES[k].symbol) for k in term.factors]
    found += ["place"] if term.on == SWIRL else []
    plain = [name.replace("|", "").removeprefix("sign(").rstrip(")") for name in found]
    return tuple(dict.fromkeys(plain))


_QUANTITY = {
    "place along north": "place", "place along east": "place", "one place": "place",
    "depth": "depth", "speed": "speed", "pitch": "attitude", "roll": "attitude",
    "uprightness": "attitude",
}  # fmt: skip


def name_target(term: LawTerm) -> str:
    """What a term acts on: an axis, `force` along the world's axes, or `water`."""
    if term.on < WORLD:
        return ON[term.on]
    return "force" if term.on < WATER else "water"
