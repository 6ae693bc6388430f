"""Propose a law for what the accepted effects leave: whether one holds, and what it is worth."""

from dataclasses import dataclass
from functools import cached_property
from typing import Callable, NamedTuple, Sequence

from rovsim.core.model_names import PROPOSED
from rovsim.diagnosis.equations.action import Action, find_action
from rovsim.diagnosis.equations.fitted_law import FittedLaw
from rovsim.diagnosis.equations.form import Form, Number, get_law, split_law
from rovsim.diagnosis.equations.law_search import search_laws
from rovsim.diagnosis.selection.accepted_effects import AcceptedEffect, find_std, name_terms
from rovsim.diagnosis.selection.cross_validation import cross_validate
from rovsim.diagnosis.selection.holdout_validation import HoldoutValidation
from rovsim.diagnosis.selection.search_result import SearchResult
from rovsim.diagnosis.structure.residual import Structure
from rovsim.diagnosis.structure.residual_structure import find_structure
from rovsim.diagnosis.uncertainty.rest_of_file import include_rest
from rovsim.dynamics.model import Model
from rovsim.estimation.file_effects import has_loose_file
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.estimation.observer.windows import score_windows
from rovsim.results.base import or_nan

ORIGIN_SENTENCE = "Proposed by `rovsim diagnose` for what no effect of the catalogue explains."
MIN_ERROR_REDUCTION = 0.05  # of the error of replays: less is not worth an equation


class Catalogued(NamedTuple):
    """The best models without a law: effects of the catalogue alone.

    Attributes:
        on_all_runs: with values fitted to all train runs.
        on_chosen: with values fitted to the stretches that the effects were chosen on.
    """

    on_all_runs: Model
    on_chosen: Model


# Fits a hypothesis once more, to all train runs; returns the fit, and the filters that suit it.
Polish = Callable[[Fit], tuple[Fit, FilterBank]]


@dataclass(frozen=True, eq=False)
class ProposedLaw:
    """A law, fitted to all train runs together with the effects that act beside it.

    Attributes:
        form: what the law is made of.
        fit: of the law and these effects, with intervals that include the rest of the vehicle file.
        error_reduction: share of the base's error in 2 s windows that the law removes in addition.
        action: on which axis it acts, and how strongly.
        rivals: equations that were tried in its place, and by how much less likely each is.
        beside: the effects that act beside it.
        left: structure that is left beside it, on any axis.
    """

    form: Form
    fit: Fit
    error_reduction: float
    action: Action
    rivals: tuple[tuple[str, float], ...]
    beside: tuple[AcceptedEffect, ...]
    left: tuple[Structure, ...] = ()

    @property
    def complete(self) -> bool:
        """Whether nothing but noise, or what is small beside it, is left on its axis.

        A law that leaves more is not proposed, but it still shows which accepted effects are
        unnecessary.
        """
        return not self.action.leaves_structure(self.left)

    @property
    def law(self) -> Term:
        """The law as a term of the hypothesis."""
        return get_law(self.fit.hypothesis)

    @property
    def model(self) -> Model:
        """The base with all accepted effects and the law."""
        return self.fit.hypothesis.model.called(f"+{PROPOSED}")

    @cached_property
    def numbers(self) -> list[Number]:
        """Its parameters in the units of its equation."""
        place = self.fit.hypothesis.terms.index(self.law)
        return self.form.list_numbers(self.law, find_std(self.fit, place))

    @property
    def source(self) -> str:
        """The law as an effect, in Python."""
        return self.form.write(PROPOSED, self.law, self.numbers, ORIGIN_SENTENCE)


def propose_law(
    selection: SearchResult,
    best: Catalogued,
    base: Model,
    holdout: HoldoutValidation,
    runs: Sequence[ObservedRun],
    polish: Polish,
    camera: Sequence[AcceptedEffect],
) -> ProposedLaw | None:
    """Propose a law for what the accepted effects leave; None where no law holds.

    A law holds if it explains more than the best of all candidate terms would by chance, if it
    helps on blocks of time that it was not fitted to, if all runs are replayed better with it than
    with effects of the catalogue alone, and the held-out stretches no worse.

    Args:
        selection: where the search ended.
        best: the best models without a law.
        base: the model that is diagnosed.
        holdout: judges replays of the held-out stretches.
        runs: all train runs.
        polish: fits a hypothesis once more to all of them.
        camera: the filter of the cameras as an effect; empty where they do not smooth.
    """
    law = search_laws(selection)
    if law is None or not _is_confirmed(law, selection, best, holdout):
        return None
    fit, bank = polish(law.fit)
    if not fit.is_finite:
        return None
    without_law = split_law(fit.hypothesis)[0].model
    errors = score_windows([base, without_law, fit.hypothesis.model], runs).normalised
    error_base, error_without, error_with = (or_nan(e) for e in errors)
    if not error_with < (1.0 - MIN_ERROR_REDUCTION) * error_without:
        return None  # values fitted to all runs may leave less to the law
    action = find_action(law.form, fit, runs)
    left = tuple(find_structure(fit, bank))
    fit, _ = include_rest(fit, runs, has_loose_file(fit.hypothesis))
    beside = (*camera, *(e for e in name_terms(fit, ()) if e.term.effect.listed))
    share = (error_without - error_with) / error_base
    return ProposedLaw(law.form, fit, share, action, law.rivals, beside, left)


def _is_confirmed(
    judged: FittedLaw, selection: SearchResult, best: Catalogued, holdout: HoldoutValidation
) -> bool:
    """Whether a law helps on blocks of time it was not fitted to, and in replays of all runs."""
    without_law: Hypothesis = split_law(judged.fit.hypothesis)[0]
    if cross_validate(judged.fit, selection.fit(without_law), selection.workspace.bank) <= 0.0:
        return False
    law = judged.fit.hypothesis.model
    return holdout.improves(law, best.on_all_runs, MIN_ERROR_REDUCTION) and holdout.keeps(
        law, best.on_chosen
    )
