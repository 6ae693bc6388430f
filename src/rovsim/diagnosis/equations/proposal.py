"""A law that holds: its values on all runs, what it is worth, and how it is written."""

from dataclasses import dataclass
from functools import cached_property
from typing import Callable, NamedTuple, Sequence

from rovsim.core.extras import installed
from rovsim.core.model_names import PROPOSED
from rovsim.diagnosis.equations.action import find_action, is_half
from rovsim.diagnosis.equations.fitted_law import FittedLaw
from rovsim.diagnosis.equations.form import Form, Number, get_law, split_law
from rovsim.diagnosis.equations.law_search import search_laws
from rovsim.diagnosis.selection.cross_validation import cross_validate
from rovsim.diagnosis.selection.holdout_validation import HoldoutValidation
from rovsim.diagnosis.selection.ranking import Named, find_std, name_terms
from rovsim.diagnosis.selection.search_result import SearchResult
from rovsim.dynamics.model import Model
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.estimation.observer.windows import score_windows
from rovsim.results.base import or_nan

STORY = "Proposed by `rovsim diagnose` for what no effect of the catalogue explains."
MIN_ERROR_REDUCTION = 0.05  # of the error of replays: less is not worth an equation


class Catalogued(NamedTuple):
    """The best that the catalogue can do, of the `whole` runs, and of what it was `chosen` by."""

    whole: Model
    chosen: Model


Polish = Callable[[Fit], tuple[Fit, FilterBank]]


@dataclass(frozen=True, eq=False)
class ProposedLaw:
    """A law of this form, fitted with all else to all train runs.

    `error_reduction`: share of the base's error in 2 s windows that it removes on top of all else;
    `sizes` N or N m, RMS of each term; `axis` on which it acts most; `rivals`: equations that were
    tried in its place, and by how much less likely each is; `beside`: effects of the catalogue that
    act with it; `whole`: whether nothing but noise is left on its axis. Half a law is no equation
    to propose, and tells all the same which names it makes unnecessary.
    """

    form: Form
    fit: Fit
    error_reduction: float
    sizes: tuple[float, ...]
    axis: str
    rivals: tuple[tuple[str, float], ...]
    beside: tuple[Named, ...]
    whole: bool = True

    @property
    def law(self) -> Term:
        """The law, as the engine knows it."""
        return get_law(self.fit.hypothesis)

    @property
    def model(self) -> Model:
        """All that was found, with the law."""
        return self.fit.hypothesis.model.called(f"+{PROPOSED}")

    @cached_property
    def numbers(self) -> list[Number]:
        """Its parameters in the units of its equation."""
        place = self.fit.hypothesis.terms.index(self.law)
        return self.form.list_numbers(self.law, find_std(self.fit, place))

    @property
    def source(self) -> str:
        """The effect as a Python file."""
        return self.form.write(PROPOSED, self.law, self.numbers, STORY)


def propose_law(
    selection: SearchResult,
    best: Catalogued,
    base: Model,
    holdout: HoldoutValidation,
    runs: Sequence[ObservedRun],
    polish: Polish,
    camera: Sequence[Named],
) -> ProposedLaw | None:
    """An equation for what is left; None where none holds.

    A law holds if it gains more than the best of so many terms would by chance, if it helps on
    blocks it was not fitted to, if the runs are replayed better with it than by the best that the
    catalogue can do, and the stretches that were kept apart no worse. It is `whole` if nothing is
    left on its axis but noise.

    Args:
        selection: what the search selected.
        best: models of catalogued effects that a law must better.
        base: the model that is diagnosed.
        holdout: stretches that were kept apart.
        runs: all train runs.
        polish: fits once more to all runs.
        camera: what the camera does, as an effect, where it does something.
    """
    if not installed("equations"):
        return None
    judged = search_laws(selection)
    if judged is None or not _holds(judged, selection, best, holdout):
        return None
    fit, bank = polish(judged.fit)
    if not fit.is_finite:
        return None
    action = find_action(judged.form, fit, runs)
    whole = not is_half(action.axis, fit, bank)
    bare = split_law(fit.hypothesis)[0].model
    errors = score_windows([base, bare, fit.hypothesis.model], runs).normalised
    start, before, after = (or_nan(e) for e in errors)
    beside = (*camera, *(one for one in name_terms(fit, ()) if one.term.effect.listed))
    share = (before - after) / start
    return ProposedLaw(
        judged.form, fit, share, action.sizes, action.axis, judged.rivals, beside, whole
    )


def _holds(
    judged: FittedLaw, selection: SearchResult, best: Catalogued, holdout: HoldoutValidation
) -> bool:
    rest: Hypothesis = split_law(judged.fit.hypothesis)[0]
    if cross_validate(judged.fit, selection.fit(rest), selection.workspace.bank) <= 0.0:
        return False
    law = judged.fit.hypothesis.model
    return holdout.improves(law, best.whole, MIN_ERROR_REDUCTION) and holdout.keeps(
        law, best.chosen
    )
