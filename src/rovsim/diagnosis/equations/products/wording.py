"""A law of products in LaTeX and in words."""

from collections import Counter
from typing import Sequence

from rovsim.diagnosis.equations.products.library import LawTerm
from rovsim.diagnosis.equations.products.targets import TARGETS
from rovsim.diagnosis.equations.products.variables import VARIABLES
from rovsim.dynamics.effects.law_codes import SWIRL


def name_terms(terms: Sequence[LawTerm]) -> list[str]:
    """A parameter's name for each term: of what it acts on, numbered where that comes twice."""
    heads = [TARGETS[t.on].name.replace(" ", "_") for t in terms]
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
        for head in TARGETS[term.on].heads:
            sign = "-" if head.inner_latex.startswith("-") else "+"
            inner = head.inner_latex.removeprefix("-")
            text = r"\,".join(part for part in (symbol, factors, inner) if part)
            rows.setdefault(head.latex, []).append(f"{sign} {text}")
    return r",\quad ".join(f"{head} = {_joined(parts)}" for head, parts in rows.items())


def _joined(parts: Sequence[str]) -> str:
    text = " ".join(parts)
    return text[2:] if text.startswith("+ ") else "-" + text[2:]


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
        parts.append(f"{TARGETS[term.on].acts} that varies with {' and '.join(varies)}")
    text = "; ".join(parts)
    return text[0].upper() + text[1:] + "."


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
