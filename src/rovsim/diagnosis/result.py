"""A diagnosis as plain content: `diagnosis.json`."""

from typing import Any, Mapping, Sequence

from rovsim.diagnosis.advice import next_experiment
from rovsim.diagnosis.checks.identifiability import group_joint_parameters
from rovsim.diagnosis.observer.hypothesis import Term
from rovsim.diagnosis.procedure import Ranked, Selected, TrainDiagnosis
from rovsim.diagnosis.selection.rivals import SURE, Rival
from rovsim.dynamics.catalogue import Catalogue

SCHEMA = "rovsim.diagnosis/1"
LISTED = 10  # effects of the ranking


def content(
    found: TrainDiagnosis,
    where: Sequence[Mapping[str, Any]],
    error: Mapping[str, float | None],
    base: Mapping[str, Any],
    catalogue: Catalogue,
) -> dict[str, Any]:
    """`diagnosis.json` (docs/formats.md).

    Args:
        found: the diagnosis.
        where: conditions in which the base fails, as listed by rovsim.evaluation.error_conditions.
        error: of the base, with the effects, and the noise floor, on the test runs.
        base: the base model's own content, so that `rovsim add` needs nothing else.
        catalogue: what the effects are.
    """
    alike = indistinguishable(found.rivals)
    joint = group_joint_parameters(found.fit) if found.fit else []
    return {
        "schema": SCHEMA,
        "verdict": found.verdict,
        "selected": [_entry(one, one.std) for one in found.selected],
        "ranking": [_entry(one, {}) for one in _listed(found)],
        "indistinguishable": alike,
        "known_together": joint,
        "where": list(where),
        "unexplained": unexplained(found),
        "next_experiment": next_experiment(found, alike, joint, catalogue),
        "error": {name: _rounded(value) for name, value in error.items()},
        "not_excited": list(found.still),
        "rivals": [
            {"effect": r.effect, "instead_of": r.instead_of, "deficit": _rounded(r.deficit)}
            for r in found.rivals
        ],
        "noise": _noise(found),
        "base": dict(base),
    }


def _entry(one: Selected | Ranked, std: Mapping[str, float]) -> dict[str, Any]:
    return {
        "effect": one.term.id,
        "parameters": _parameters(one.term, std),
        "error_reduction": _rounded(one.error_reduction),
        "probability": _rounded(one.probability),
    }


def _listed(found: TrainDiagnosis) -> list[Ranked]:
    """The first effects of the ranking, and those selected."""
    named = {one.term.id for one in found.selected}
    return [r for k, r in enumerate(found.ranking) if k < LISTED or r.term.id in named]


def _rounded(value: float | None) -> float | None:
    return None if value is None or value != value else float(f"{value:.6g}")


def _parameters(term: Term, std: Mapping[str, float]) -> dict[str, Any]:
    """What the fit chose, and what else differs from the default."""
    given = term.effect.given()
    units = {p.name: p.unit for p in term.effect.parameters}
    names = [p.name for p in term.effect.parameters if p.name in given or p.name in std]
    return {
        name: {
            "value": _rounded(term.effect[name]),
            **({"std": _rounded(std[name])} if name in std else {}),
            "unit": units[name],
        }
        for name in names
    }


def indistinguishable(rivals: Sequence[Rival]) -> list[list[str]]:
    """Groups of effects that explain the data about equally well; groups that meet are one."""
    groups: list[set[str]] = []
    for one in rivals:
        if one.deficit < SURE:
            pair = {one.effect, one.instead_of}
            met = [g for g in groups if g & pair]
            groups = [g for g in groups if not g & pair] + [pair.union(*met)]
    return sorted(sorted(g) for g in groups)


def unexplained(found: TrainDiagnosis) -> dict[str, Any]:
    """What no effect of the catalogue explains."""
    if not found.structures:
        return {"fraction": 0.0, "significant": False, "hint": "Nothing is left but noise."}
    first = found.structures[0]
    also = [s for s in found.structures[1:] if s.axis != first.axis]
    hint = f"{first.axis.capitalize()}: the remainder shows {first.what}."
    if also:
        axes = ", ".join(dict.fromkeys(s.axis for s in also))
        hint += f" Also {axes}: {also[0].what}."
    return {"fraction": _rounded(first.share), "significant": True, "hint": hint}


def _noise(found: TrainDiagnosis) -> dict[str, Any]:
    if found.fit is None:
        return {}
    noise = found.fit.noise
    return {
        "disturbance": [_rounded(x) for x in noise.level],
        "memory_s": [_rounded(x) for x in noise.memory],
        "reading": [_rounded(x) for x in noise.reading],
    }
