"""Write a law of products in LaTeX and in words."""

from collections import Counter
from typing import Sequence

from rovsim.diagnosis.equations.products.library import LawTerm
from rovsim.diagnosis.equations.products.targets import TARGETS
from rovsim.diagnosis.equations.products.variables import VARIABLES
from rovsim.dynamics.laws.codes import SWIRL


def name_coefficients(terms: Sequence[LawTerm]) -> list[str]:
    """Name the coefficient of each term after what it acts on, numbered where terms share that."""
    heads = [TARGETS[t.on].name.replace(" ", "_") for t in terms]
    count, names = Counter(heads), []
    for k, head in enumerate(heads):
        names.append(head if count[head] == 1 else f"{head}_{heads[: k + 1].count(head)}")
    return names


def write_equation(terms: Sequence[LawTerm]) -> str:
    """Write a law in LaTeX, with an equation for each left side."""
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
    """Join signed terms to a sum, without a plus sign in front."""
    text = " ".join(parts)
    return text[2:] if text.startswith("+ ") else "-" + text[2:]


def _powers(factors: Sequence[int]) -> list[str]:
    """Write factors, given by their codes, in LaTeX; equal ones as a power."""
    texts = []
    for k, count in Counter(factors).items():
        text = VARIABLES[k].latex
        texts.append(text if count == 1 else f"{text}^{count}")
    return texts


def tell_law(terms: Sequence[LawTerm]) -> str:
    """Write a law as a sentence."""
    parts = []
    for term in terms:
        varies = list(dict.fromkeys(VARIABLES[k].meaning for k in term.factors)) or ["nothing"]
        if term.on == SWIRL:
            varies = ["the distance from a place", *(v for v in varies if v != "nothing")]
        parts.append(f"{TARGETS[term.on].acts} that varies with {' and '.join(varies)}")
    text = "; ".join(parts)
    return text[0].upper() + text[1:] + "."


def list_quantities(term: LawTerm) -> tuple[str, ...]:
    """List the quantities that a term varies with, each once.

    These are velocities by their symbols, `attitude`, `place`, `depth` and `speed`.
    """
    names = [_QUANTITY.get(VARIABLES[k].meaning, VARIABLES[k].symbol) for k in term.factors]
    names += ["place"] if term.on == SWIRL else []
    quantities = [name.replace("|", "").removeprefix("sign(").rstrip(")") for name in names]
    return tuple(dict.fromkeys(quantities))


_QUANTITY = {
    "place along north": "place", "place along east": "place", "one place": "place",
    "depth": "depth", "speed": "speed", "pitch": "attitude", "roll": "attitude",
    "uprightness": "attitude",
}  # fmt: skip
