"""Which vehicle: of those whose columns fit, the one that the motion is like."""

from dataclasses import dataclass
from typing import Sequence

from numpy import ndarray as Array

from rovsim.application.intake.likeness import Likeness
from rovsim.application.intake.motions import alike, turned
from rovsim.application.intake.pairing import ALIKE, Pair
from rovsim.application.intake.vehicles import Fit
from rovsim.dynamics.vehicle import default_vehicle

SAME = 0.03  # likeness by which vehicles of one hull differ


@dataclass(frozen=True, eq=False)
class Choice:
    """The vehicle, None where nobody can tell; the likeness of its runs along each body axes."""

    fit: Fit | None
    said: str
    fits: tuple[Fit, ...]
    turned: tuple[tuple[float, Array], ...]
    runs: dict[int, Likeness]


def choose(fits: Sequence[Fit], pairs: Sequence[Pair]) -> Choice:
    """The vehicle of these runs."""
    compared = {fit.name: _compared(fit, pairs) for fit in fits}
    scores = {name: turned(found) for name, found in compared.items() if found}
    ordered = sorted(fits, key=lambda fit: -_best(scores, fit))
    if not ordered:
        return Choice(None, "no vehicle file has as many commands", (), (), {})
    first = ordered[0]
    near = [fit for fit in ordered if _best(scores, fit) > _best(scores, first) - SAME]
    chosen = next((fit for fit in near if fit.name == default_vehicle()), first)
    told = Choice(None, _told(ordered, scores), tuple(ordered),
                  tuple(scores.get(chosen.name, [])), compared[chosen.name])  # fmt: skip
    alone = len(near) == 1 or chosen.name == default_vehicle() or _one_hull(near)
    shown = _best(scores, chosen) >= ALIKE
    sure = (shown and alone) or (chosen.by_name and len(ordered) == 1)
    return Choice(chosen, told.said, told.fits, told.turned, told.runs) if sure else told


def _compared(fit: Fit, pairs: Sequence[Pair]) -> dict[int, Likeness]:
    found = {k: alike(p.motion, log, fit) for k, p in enumerate(pairs) if (log := p.shown)}
    return {k: one for k, one in found.items() if one is not None and one.excited.any()}


def _best(scores: dict[str, list[tuple[float, Array]]], fit: Fit) -> float:
    return scores[fit.name][0][0] if fit.name in scores else 0.0


def _one_hull(fits: Sequence[Fit]) -> bool:
    """Whether the vehicles differ in their thrusters' curves alone."""
    hulls = [fit.vehicle.hydrodynamics.model_dump() for fit in fits]
    return all(hull == hulls[0] for hull in hulls)


def _told(fits: Sequence[Fit], scores: dict[str, list[tuple[float, Array]]]) -> str:
    if not scores:
        return f"the columns fit {', '.join(fit.name for fit in fits)}"
    told = [f"{fit.name} ({_best(scores, fit):.2f})" for fit in fits]
    return f"the columns fit, and the motion is like that of (likeness) {', '.join(told)}"
