"""A special effect beside a vehicle file that may be off everywhere.

Where something that the file states was selected, the file is off elsewhere too, mostly by too
little to be found: a dozen such numbers, none of them worth its price, may explain together what a
special effect seems to. So there it is judged with all of the file free, as far as such files are
off (`nominal_terms.py`), and to first order.
"""

from rovsim.diagnosis.observer.hypothesis import Hypothesis, Term
from rovsim.diagnosis.selection.gauss_newton import Fit
from rovsim.diagnosis.selection.nominal_terms import STATED
from rovsim.diagnosis.selection.workspace import SearchWorkspace

# In twice the log likelihood, odds of a thousand to one: some thirty effects, each there once in
# thirty times, against a coefficient of a file that is known to be off.
FILE_ODDS = 13.8
ARGUABLE = 100.0  # in twice the log likelihood: beyond it no file makes up for the difference


def is_off(h: Hypothesis) -> bool:
    """Whether something was selected that the vehicle file states."""
    return any(term.id in STATED for term in h.terms)


def measure_cost(workspace: SearchWorkspace, found: Fit) -> float:
    """What a fit leaves of the sum of squares, all of the file free beside it."""
    return workspace.cost_beside_file(workspace.products(found.seen))


def find_limit(workspace: SearchWorkspace, term: Term) -> float:
    """What a term must take away beside a loose file; nothing if it is of the file."""
    return 0.0 if term.id in STATED else workspace.price * term.choices + FILE_ODDS


def explains(workspace: SearchWorkspace, found: Fit, name: str) -> bool:
    """Whether a file that is off anyway explains what a special effect of a fit does."""
    term = next(one for one in found.hypothesis.terms if one.id == name)
    if name in STATED or not is_off(found.hypothesis):
        return False
    rest = workspace.products_without(found, term)
    loss = workspace.cost_beside_file(rest) - measure_cost(workspace, found)
    return loss <= find_limit(workspace, term)


def weigh(
    workspace: SearchWorkspace, own: tuple[Fit, Term], other: tuple[Fit, Term], deficit: float
) -> float:
    """How much less likely the other term's fit is, beside a file that is off if it is.

    Both of the file: `deficit`, what is known of the two fits as they are.
    """
    (current, term), (trial, rival) = own, other
    both = term.id in STATED and rival.id in STATED
    if both or not is_off(current.hypothesis) or deficit > ARGUABLE:
        return deficit
    more = measure_cost(workspace, trial) - measure_cost(workspace, current)
    return more + find_limit(workspace, rival) - find_limit(workspace, term)
