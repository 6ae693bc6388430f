"""Say what the runs cannot tell apart: effects, parameters, rivals, a common factor of forces."""

from typing import Sequence

from rovsim.core.odds import odds_of
from rovsim.dynamics.parameter_labels import label_parameters
from rovsim.reporting.wording import listed, percent, significant
from rovsim.results.base import or_nan
from rovsim.results.diagnosis import Diagnosis, RivalEffect, ScaleOfForces

MAX_TOLD_ODDS = 1e6  # odds that need no number


def apart_sentences(diagnosis: Diagnosis) -> list[str]:
    """Say which effects and parameters the runs cannot tell apart, and how likely rivals are."""
    sentences = [
        f"These runs cannot tell {listed(group)} apart." for group in diagnosis.indistinguishable
    ]
    sentences += [
        f"Known only together, not one by one: {', '.join(_named(group, diagnosis))}."
        for group in diagnosis.known_together
    ]
    return sentences + _runner_up_sentences(_list_runners_up(diagnosis))


def _named(group: Sequence[str], diagnosis: Diagnosis) -> list[str]:
    return label_parameters(group, diagnosis.thrusters)


def _list_runners_up(diagnosis: Diagnosis) -> list[RivalEffect]:
    """List the likeliest rival of each selected effect among those that can be told from it."""
    best = []
    for fit in diagnosis.selected:
        rivals = [r for r in diagnosis.rivals if r.instead_of == fit.effect]
        alike = (group for group in diagnosis.indistinguishable if fit.effect in group)
        alike_names = {name for group in alike for name in group}
        behind = [r for r in rivals if r.effect not in alike_names]
        if behind:
            best.append(min(behind, key=lambda r: or_nan(r.deficit)))
    return best


def _runner_up_sentences(best: Sequence[RivalEffect]) -> list[str]:
    """Say how much less likely the rivals are; one sentence for all that are quite improbable."""
    odds = [(r, odds_of(or_nan(r.deficit))) for r in best]
    near = [(r, significant(times, 2)) for r, times in odds if times <= MAX_TOLD_ODDS]
    far = [r for r, times in odds if times > MAX_TOLD_ODDS]
    if len(far) == 1:
        near, far = [*near, (far[0], "more than a million")], []
    sentences = [
        f"The next best explanation instead of {r.instead_of} is {r.effect}: {times} times less "
        "likely."
        for r, times in near
    ]
    if far:
        pairs = listed([f"{r.effect} instead of {r.instead_of}" for r in far])
        sentences.append(
            f"The next best explanations are each more than a million times less likely: {pairs}."
        )
    return sentences


def scale_sentences(scale: ScaleOfForces | None) -> list[str]:
    """Say that forces are known only up to a common factor; empty where they are fully known."""
    if scale is None:
        return []
    owners = listed(list(dict.fromkeys(name.split(".")[0] for name in scale.parameters)))
    return [
        "All forces are known only up to one common factor, which is uncertain by "
        f"{percent(scale.std)} (one standard deviation). A vehicle with 10 % more thrust, inertia "
        f"and drag would move in the same way. The factor acts on values of {owners}; their "
        "intervals include it."
    ]
