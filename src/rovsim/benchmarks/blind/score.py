"""One answer judged against the truth. Pure: a case and a diagnosis in, numbers out.

An answer is `exact` if it names what is hidden and nothing else, and its verdict is right.
Strictly: the very names. Leniently: up to the groups that the diagnosis itself calls
indistinguishable, each hidden effect matched by one named effect. How large such groups are is
counted, so that an answer cannot win by calling everything alike.
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
    """One hidden number: relative `error`, and whether its 95 % interval covers it (None: none)."""

    effect: str
    name: str
    error: float
    covered: bool | None


@dataclass(frozen=True)
class Score:
    """What one answer is worth.

    `first` whether the first name is right (None where nothing is hidden); `false` names that are
    neither hidden nor forgiven; `alike` size of the largest group that a hidden effect is in;
    `unseen` whether all is right but for hidden effects of which the answer says that the runs
    cannot show them.
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
    """Judge what was said of the campaign of a case."""
    selected = [one.effect for one in answer.selected]
    counted = [s for s in selected if s not in case.forgiven]
    groups = [set(group) for group in answer.indistinguishable]
    right = answer.verdict in case.verdicts and set(case.silent) <= set(answer.not_observable)
    matched = matching(counted, case.names, groups)
    strict = set(counted) & set(case.names)
    complete = len(counted) == len(case.names)
    return Score(
        verdict=right,
        flagged=answer.verdict == "unexplained",
        first_strict=_first(selected, case.names, []),
        first=_first(selected, case.names, groups),
        exact_strict=right and complete and set(counted) == set(case.names),
        exact=right and complete and matched == len(case.names),
        false_strict=len(counted) - len(strict),
        false=len(counted) - matched,
        alike=max((len(g) for g in groups if g & set(case.names)), default=1),
        unseen=_lacks_only_unseen(case, answer, set(counted)),
        parameters=tuple(_parameters(case, answer)),
    )


def _lacks_only_unseen(case: Case, answer: Answer | Diagnosis, named: set[str]) -> bool:
    """Whether the answer would be exact if what it calls not observable were not hidden."""
    missing = set(case.names) - named
    if not missing or not missing <= set(answer.not_observable) or named - set(case.names):
        return False
    rest = tuple(entry for entry in case.hidden if entry.effect not in missing)
    return answer.verdict in case.model_copy(update={"hidden": rest}).verdicts


def _first(selected: Sequence[str], truth: Sequence[str], groups: list[set[str]]) -> bool | None:
    if not truth:
        return None
    return bool(selected) and any(_same(selected[0], one, groups) for one in truth)


def _same(a: str, b: str, groups: list[set[str]]) -> bool:
    return a == b or any({a, b} <= group for group in groups)


def matching(named: Sequence[str], truth: Sequence[str], groups: list[set[str]]) -> int:
    """How many names can be paired with hidden effects, each used once (augmenting paths)."""
    owner: dict[str, str] = {}

    def place(one: str, seen: set[str]) -> bool:
        for hidden in truth:
            if hidden not in seen and _same(one, hidden, groups):
                seen.add(hidden)
                if hidden not in owner or place(owner[hidden], seen):
                    owner[hidden] = one
                    return True
        return False

    return sum(place(one, set()) for one in named)


def _parameters(case: Case, answer: Answer | Diagnosis) -> Iterator[ParameterScore]:
    """Every number of a hidden effect that was named by its own name."""
    named = {one.effect: one for one in answer.selected}
    for entry in case.hidden:
        if entry.effect in case.names and entry.effect in named:
            known = {p.name: p for p in built_in()[entry.effect].parameters}
            for name, truth in entry.parameters.items():
                if known[name].fitted:
                    yield _parameter(known[name], truth.value, named[entry.effect])


def _parameter(declared: Parameter, truth: float, answer: FittedEffect) -> ParameterScore:
    """The change from the default is what was hidden; a number left out says: the default."""
    fitted = answer.parameters.get(declared.name)
    value, std = (fitted.value, fitted.std) if fitted else (declared.default, None)
    miss = abs(or_nan(value) - truth)
    covered = None if std is None else miss <= Z_95 * std
    size = max(declared.size(truth), 1e-9)
    return ParameterScore(answer.effect, declared.name, miss / size, covered)
