"""Which proposals are worth a fit."""

from typing import Sequence

from rovsim.diagnosis.selection.proposals import Proposal
from rovsim.diagnosis.selection.workspace import Removed, SearchWorkspace
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.hypothesis import Term

# Of what a term explains: another name may do better than first order predicts, not twice.
PROMISING_SHARE = 0.5
# Of the best predicted decrease: effects predicted about the same are all refitted, for the order
# of first-order predictions is not that of fits (a torpedo's weight, sixth to first order, was
# best).
NEARLY_BEST_SHARE = 0.75
# Of the best predicted decrease: less has never turned out best after refitting.
WORTH_TRYING_SHARE = 0.2


def list_promising(workspace: SearchWorkspace, current: Fit) -> list[Proposal]:
    """The proposals that should lower the sum of squares by more than their penalty."""
    return [p for p in workspace.propose(current) if p.net_decrease > 0.0]


def keep_close(ranked: Sequence[Proposal], trials: int) -> list[Proposal]:
    """The first proposals, as far as they could turn out best once refitted."""
    return [
        p for p in ranked[:trials] if p.net_decrease > WORTH_TRYING_SHARE * ranked[0].net_decrease
    ]


def find_swaps(
    workspace: SearchWorkspace, term: Term, rest: Removed, trials: int
) -> list[Proposal]:
    """The first other effects that may explain what a removed term did, best first.

    All that should explain nearly as much as it did are among them: loops about three angles were
    third in the place of weak sticks and drag, and likelier once refitted. Where a term itself is
    hardly worth its penalty, a rival need not be: the two share what they explain.
    """
    others = [p for p in rest.others if p.term.id != term.id]
    trials = max(trials, sum(p.net_decrease > NEARLY_BEST_SHARE * rest.ss_increase for p in others))
    worth = keep_close([p for p in others if p.net_decrease > 0.0], trials)
    least = PROMISING_SHARE * rest.ss_increase
    return worth or [p for p in others[:trials] if measure_explained(workspace, p) > least]


def measure_explained(workspace: SearchWorkspace, proposal: Proposal) -> float:
    """Decrease of the sum of squares, without its penalty."""
    return proposal.net_decrease + workspace.penalty * proposal.term.choices
