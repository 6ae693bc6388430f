"""Score one answer against the truth, from a case and a diagnosis alone.

An answer is `exact` if it names what is hidden and nothing else, and its verdict is right. Strict
scores ask for the very names. Lenient ones also accept an effect of a group that the diagnosis
itself calls indistinguishable from the hidden one; each hidden effect is matched by one named
effect. The size of such groups is counted, so that an answer cannot win by calling everything
alike.
"""

from dataclasses import dataclass
from typing import Iterator, Sequence

from rovsim.benchmarks.blind.case import Case
from rovsim.core.normal import Z_95
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effects.base import Parameter
from rovsim.results.base import or_nan
from rovsim.results.diagnosis import Answer, Diagnosis
from rovsim.results.fitted import FittedEffect


@dataclass(frozen=True)
class ParameterScore:
    """How well one hidden parameter was found.

    Attributes:
        effect: its id.
        name: of the parameter.
        error: relative to the size of the hidden change.
        covered: whether the 95 % interval contains the truth; None without an interval.
    """

    effect: str
    name: str
    error: float
    covered: bool | None


@dataclass(frozen=True)
class Score:
    """The score of one answer.

    Attributes:
        verdict: whether the verdict is right, and hidden effects that the recordings cannot show
            are said to be not observable.
        flagged: whether the verdict is `unexplained`.
        first_strict: as `first`, by the very name.
        first: whether the first name is right; None where nothing is hidden.
        exact_strict: as `exact`, by the very names.
        exact: whether verdict and names are right, and nothing else is named.
        false_strict: number of false names by the very names.
        false: number of names that are neither hidden nor forgiven.
        alike: size of the largest group of indistinguishable effects with a hidden one in it.
        unseen: whether all is right except that hidden effects are missing of which the answer says
            that the runs cannot show them.
        parameters: of hidden effects that were named.
    """

    verdict: bool
    flagged: bool
    first_strict: bool | None
    first: bool | None
    exact_strict: bool
    exact: bool
    false_strict: int
    false: int
    alike: int
    unseen: bool
    parameters: tuple[ParameterScore, ...]


def score(case: Case, answer: Answer | Diagnosis) -> Score:
    """Score the answer to a case."""
    selected = [fitted.effect for fitted in answer.selected]
    names = [s for s in selected if s not in case.forgiven]
    groups = [set(group) for group in answer.indistinguishable]
    right = answer.verdict in case.verdicts and set(case.silent) <= set(answer.not_observable)
    matches = matching(names, case.names, groups)
    hits = set(names) & set(case.names)
    as_many = len(names) == len(case.names)
    return Score(
        verdict=right,
        flagged=answer.verdict == "unexplained",
        first_strict=_first_is_hidden(selected, case.names, []),
        first=_first_is_hidden(selected, case.names, groups),
        exact_strict=right and as_many and set(names) == set(case.names),
        exact=right and as_many and matches == len(case.names),
        false_strict=len(names) - len(hits),
        false=len(names) - matches,
        alike=max((len(g) for g in groups if g & set(case.names)), default=1),
        unseen=_lacks_only_unseen(case, answer, set(names)),
        parameters=tuple(_parameters(case, answer)),
    )


def _lacks_only_unseen(case: Case, answer: Answer | Diagnosis, named: set[str]) -> bool:
    """Whether the answer is exact except for hidden effects that it calls not observable."""
    missing = set(case.names) - named
    if not missing or not missing <= set(answer.not_observable) or named - set(case.names):
        return False
    without_missing = case.model_copy(update={"silent": (*case.silent, *missing)})
    return answer.verdict in without_missing.verdicts


def _first_is_hidden(
    selected: Sequence[str], truth: Sequence[str], groups: list[set[str]]
) -> bool | None:
    """Whether the first selected effect is hidden; None where nothing is."""
    if not truth:
        return None
    return bool(selected) and any(_same(selected[0], name, groups) for name in truth)


def _same(a: str, b: str, groups: list[set[str]]) -> bool:
    """Whether two effects are the same or in one group."""
    return a == b or any({a, b} <= group for group in groups)


def matching(named: Sequence[str], truth: Sequence[str], groups: list[set[str]]) -> int:
    """Count the names that can be paired with hidden effects, each used once (augmenting paths)."""
    owner: dict[str, str] = {}

    def place(one: str, seen: set[str]) -> bool:
        for hidden in truth:
            if hidden not in seen and _same(one, hidden, groups):
                seen.add(hidden)
                if hidden not in owner or place(owner[hidden], seen):
                    owner[hidden] = one
                    return True
        return False

    return sum(place(name, set()) for name in named)


def _parameters(case: Case, answer: Answer | Diagnosis) -> Iterator[ParameterScore]:
    """Score every fitted parameter of each hidden effect that was named by its own name."""
    selected = {fitted.effect: fitted for fitted in answer.selected}
    for entry in case.hidden:
        if entry.effect in case.names and entry.effect in selected:
            declared = {p.name: p for p in built_in()[entry.effect].parameters}
            for name, truth in entry.parameters.items():
                if declared[name].fitted:
                    yield _parameter(declared[name], truth.value, selected[entry.effect])


def _parameter(declared: Parameter, truth: float, answer: FittedEffect) -> ParameterScore:
    """Score one parameter; one that the answer leaves out counts as left at its default."""
    fitted = answer.parameters.get(declared.name)
    value, std = (fitted.value, fitted.std) if fitted else (declared.default, None)
    miss = abs(or_nan(value) - truth)
    covered = None if std is None else miss <= Z_95 * std
    size = max(declared.size(truth), 1e-9)
    return ParameterScore(answer.effect, declared.name, miss / size, covered)
