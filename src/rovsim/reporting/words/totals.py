"""What a coefficient comes to: that of the base, the change, and whether such a vehicle brakes."""

from typing import NamedTuple

from rovsim import AXES
from rovsim.dynamics.body import Body
from rovsim.reporting.wording import listed, significant


class Total(NamedTuple):
    """What a coefficient comes to, and what is wrong with that, in words."""

    told: str
    wrong: str


def tell_total(body: Body, effect: str, parameter: str, value: float, unit: str = "") -> Total:
    """The sum of what the base has and a change of it; nothing where there is no sum."""
    if effect not in body.stated or parameter not in AXES:
        return Total("", "")
    before = float(body.stated[effect][AXES.index(parameter)])
    sign = "+" if value >= 0.0 else "−"
    total = significant(before + value)
    text = f"in all {significant(before)} {sign} {significant(abs(value))} = {total} {unit}"
    return Total(text.strip(), warn(effect, before + value))


def warn(effect: str, total: float) -> str:
    """What is wrong with a coefficient below zero; empty where nothing is."""
    if total >= 0.0:
        return ""
    return "no water weighs less" if effect == "added_mass" else "water would push, not brake"


def list_totals(body: Body) -> dict[tuple[str, str], float]:
    """What each coefficient of a body comes to, by effect and axis."""
    return {
        (effect, axis): float(value)
        for effect, six in body.stated.items()
        for axis, value in zip(AXES, six, strict=True)
    }


def warn_totals(body: Body) -> str:
    """Which coefficients of a body are below zero, and what that does; empty where none is."""
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
