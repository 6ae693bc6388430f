"""Choose the proposals that are worth a fit."""

from typing import NamedTuple, Sequence

from rovsim.diagnosis.selection.first_order import Removed
from rovsim.diagnosis.selection.proposals import Proposal
from rovsim.diagnosis.selection.thresholds import add_term
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.hypothesis import Hypothesis, Term

# Of what a term explains: another effect may do better than first order predicts, but not twice.
PROMISING_SHARE = 0.5
# Of the best predicted decrease: effects predicted about the same are all refitted, for the order
# of first-order predictions is not that of fits (a torpedo's weight, sixth to first order, was
# best).
NEARLY_BEST_SHARE = 0.75
# Of the best predicted decrease: less has never turned out best after refitting.
WORTH_TRYING_SHARE = 0.2


def list_promising(workspace: SearchWorkspace, current: Fit) -> list[Proposal]:
    """Proposals that are predicted to lower the sum of squares by more than their penalty."""
    return [p for p in workspace.first_order.propose(current) if p.net_decrease > 0.0]


def keep_close(ranked: Sequence[Proposal], trials: int) -> list[Proposal]:
    """The first `trials` proposals, without those that cannot turn out best once refitted."""
    return [
        p for p in ranked[:trials] if p.net_decrease > WORTH_TRYING_SHARE * ranked[0].net_decrease
    ]


class Swap(NamedTuple):
    """Another effect in the place of a term."""

    term: Term
    rest: Removed
    proposal: Proposal

    def predict_deficit(self, workspace: SearchWorkspace) -> float:
        """By how much the score is smaller with the other effect, to first order."""
        lost = self.rest.ss_increase - workspace.penalty * self.term.choices
        return lost - self.proposal.net_decrease

    def begin(self, workspace: SearchWorkspace) -> Hypothesis:
        """The hypothesis with the other effect, where a fit of it begins."""
        return add_term(workspace, self.rest.hypothesis, self.proposal.term)


def list_swaps(workspace: SearchWorkspace, current: Fit, trials: int) -> list[Swap]:
    """List effects that may stand in the place of a term, of all terms, the likeliest first.

    Args:
        workspace: of the search.
        current: the fit so far.
        trials: how many effects are wanted for each term, at least.
    """
    removals = workspace.first_order.remove_each(current)
    swaps = [
        Swap(term, rest, p)
        for term, rest in zip(current.hypothesis.terms, removals, strict=True)
        for p in find_swaps(workspace, term, rest, trials)
    ]
    return sorted(swaps, key=lambda swap: swap.predict_deficit(workspace))


def find_swaps(
    workspace: SearchWorkspace, term: Term, rest: Removed, trials: int
) -> list[Proposal]:
    """Find other effects that may explain what a removed term did, the best first.

    All effects that are predicted to explain nearly as much are among them: in one case loops on
    board came third in the place of weak sticks and drag, and were likelier once refitted. Where
    the term itself is hardly worth its penalty, a rival need not be worth its own: the two share
    what they explain.

    Args:
        workspace: of the search.
        term: that was removed.
        rest: the hypothesis without it.
        trials: how many effects are wanted, at least.
    """
    proposals = [p for p in rest.others if p.term.id != term.id]
    trials = max(
        trials, sum(p.net_decrease > NEARLY_BEST_SHARE * rest.ss_increase for p in proposals)
    )
    promising = keep_close([p for p in proposals if p.net_decrease > 0.0], trials)
    return promising or [p for p in proposals[:trials] if explains_enough(workspace, rest, p)]


def explains_enough(workspace: SearchWorkspace, rest: Removed, proposal: Proposal) -> bool:
    """Whether an effect may explain what a removed term did, however large its penalty is."""
    explained = proposal.net_decrease + workspace.penalty * proposal.term.choices
    return explained > PROMISING_SHARE * rest.ss_increase
