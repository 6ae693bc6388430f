"""Explain the symbols of an effect's equation, from what the effect declares."""

import re
from typing import Collection, Iterator

from rovsim.dynamics.effects.base import Effect, Parameter

# Symbols that effects share; an effect that uses one otherwise declares it (`Effect.symbols`).
COMMON_SYMBOLS = {
    r"\tau_i": "force or moment on the vehicle along axis i",
    r"\tau": "force and moment on the vehicle",
    r"\nu_{r,i}": "velocity through the water along axis i",
    r"\nu_{r,j}": "velocity through the water along axis j",
    r"\nu_r": "velocity through the water",
    r"\nu_i": "velocity along axis i",
    r"\nu": "velocity of the vehicle",
    "F": "force of a thruster",
    "F_i": "force of thruster i",
    "R": "rotation from the body's axes to those of the world",
    "t": "time",
    "u": "command",
}
WORD_PATTERN = re.compile(r"(?<!_)\\text\{[^}]*\}|\\mathrm\{[^}]*\}")  # no symbols inside
INDEXED_PATTERN = re.compile(r"(.+)_\{(.+)\}")  # a parameter for each axis, pair or thruster
Meaning = tuple[str, str]  # symbol in LaTeX, what it is


def explain_symbols(effect: type[Effect], values: Collection[str] | None = None) -> list[Meaning]:
    """Explain the symbols of an effect's equation, in the order in which they appear.

    Args:
        effect: with its equation.
        values: names of the parameters that have a value. For all others the explanation states
            their neutral value. None: for no parameter.
    """
    meanings = COMMON_SYMBOLS | dict(effect.symbols) | dict(_name_parameters(effect, values))
    remaining, by_place = WORD_PATTERN.sub(lambda words: " " * len(words[0]), effect.equation), {}
    for symbol in sorted(meanings, key=len, reverse=True):
        begin = "" if symbol.startswith("\\") else r"(?<![A-Za-z\\])"
        pattern = rf"{begin}{re.escape(symbol)}(?![A-Za-z_])"
        if match := re.search(pattern, remaining):
            by_place[match.start()] = (symbol, meanings[symbol])
            remaining = re.sub(pattern, lambda hit: " " * len(hit[0]), remaining)
    return [by_place[place] for place in sorted(by_place)]


def _name_parameters(effect: type[Effect], values: Collection[str] | None) -> Iterator[Meaning]:
    """Explain the symbols of parameters by their names.

    An indexed symbol is explained by all its parameters: d_i is surge and sway.
    """
    together: dict[str, list[str]] = {}
    for parameter in effect.parameters:
        yield parameter.symbol, _name(parameter, values)
        if indexed := INDEXED_PATTERN.fullmatch(parameter.symbol):
            base, index = indexed.groups()
            symbol = f"{base}_{{ij}}" if "," in index else f"{base}_i"
            together.setdefault(symbol, []).append(parameter.name)
    for symbol, names in together.items():
        chosen = [name for name in names if values is None or name in values]
        if chosen and symbol not in dict(effect.symbols):
            parts = chosen if values else [chosen[0], "…", chosen[-1]]
            yield symbol, ", ".join(parts).replace(", …,", " …")


def _name(parameter: Parameter, values: Collection[str] | None) -> str:
    if values is None or parameter.name in values:
        return parameter.name
    return f"{parameter.name}, {parameter.neutral_value:g} here"
