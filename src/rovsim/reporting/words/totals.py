"""Totals of coefficients: that of the base and a change of it, and whether the sum is possible."""

from typing import NamedTuple

from rovsim.core.axes import AXES
from rovsim.dynamics.body import Body
from rovsim.reporting.wording import listed, significant


class Total(NamedTuple):
    """The total of a coefficient in words, and what is wrong with it; empty if nothing is."""

    text: str
    wrong: str


def tell_total(body: Body, effect: str, parameter: str, value: float, unit: str = "") -> Total:
    """Say what a coefficient of the base and a change of it add up to.

    Empty where the effect is no coefficient of the base, or the parameter no axis.

    Args:
        body: of the base.
        effect: id of the effect that changes the coefficient.
        parameter: of this effect.
        value: of this parameter, in its unit.
        unit: as text.
    """
    if effect not in body.stated or parameter not in AXES:
        return Total("", "")
    before = float(body.stated[effect][AXES.index(parameter)])
    sign = "+" if value >= 0.0 else "−"
    total = significant(before + value)
    text = f"in all {significant(before)} {sign} {significant(abs(value))} = {total} {unit}"
    return Total(text.strip(), warn(effect, before + value))


def warn(effect: str, total: float) -> str:
    """Say what is wrong with a coefficient below zero; empty where it is not."""
    if total >= 0.0:
        return ""
    return "no water weighs less" if effect == "added_mass" else "water would push, not brake"


def list_totals(body: Body) -> dict[tuple[str, str], float]:
    """Return the total of each coefficient of a body, by effect and axis."""
    return {
        (effect, axis): float(value)
        for effect, six in body.stated.items()
        for axis, value in zip(AXES, six, strict=True)
    }


def warn_totals(body: Body) -> str:
    """Say which coefficients of a body are below zero, and what follows; empty where none is."""
    sentences = []
    for effect, six in body.stated.items():
        wrong = {axis: float(v) for axis, v in zip(AXES, six, strict=True) if v < 0.0}
        if wrong:
            axes = listed(f"{axis} ({significant(value)})" for axis, value in wrong.items())
            reason = warn(effect, min(wrong.values()))
            sentences.append(f"In all, {effect} is below zero in {axes}: {reason}.")
    if not sentences:
        return ""
    return " ".join([*sentences, "A replay of such a model may run away: check these values."])
