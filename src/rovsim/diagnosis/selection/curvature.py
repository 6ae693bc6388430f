"""Effects that to first order do what accepted ones do already: their curvature tells them apart.

A short lag of the thrusters is a delay, to first order. Beside a delay nothing of its derivative is
left, so that no other proposal finds it, and the delay is their sum.
"""

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.selection.proposals import MAX_LINEAR_STEP, Proposal
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.hypothesis import Term
from rovsim.estimation.observer.least_squares import gram, project_out

# Of a column's square, left beside the accepted effects: with more, first order does not hide it.
MAX_LEFT_SHARE = 0.2
TRIED_SHARES = (0.25, 1.0)  # of a usual size: farther off, higher orders hide the curvature


def list_curved(workspace: SearchWorkspace, current: Fit) -> list[Proposal]:
    """Effects that act by their curvature alone beside the accepted ones, the best first.

    The innovations left beside the accepted effects, Pe(x) = Pe(0) + x^2 Pq, are least at
    x^2 = -<Pe, Pq> / <Pq, Pq>.

    Args:
        workspace: of the search.
        current: the fit so far.
    """
    terms = _list_hidden(workspace, current) if current.is_finite else []
    trials = [term.at(share * term.x) for term in terms for share in TRIED_SHARES]
    trials = [trial for trial in trials if (current.hypothesis.model + trial.effect).possible]
    if not trials:
        return []
    proposals = []
    for trial, G in zip(trials, _measure_curvatures(workspace, current, trials), strict=True):
        towards, length = -G[0, 1], G[1, 1]
        if towards > 0.0 and length > 0.0:
            x = np.minimum(trial.x * np.sqrt(towards / length), MAX_LINEAR_STEP)
            net_decrease = towards**2 / length - workspace.penalty * trial.choices
            proposals.append(Proposal(trial.at(x), net_decrease))
    best: dict[str, Proposal] = {}
    for proposal in sorted(proposals, key=lambda p: -p.net_decrease):
        best.setdefault(proposal.term.id, proposal)
    return [p for p in best.values() if p.net_decrease > 0.0]


def _list_hidden(workspace: SearchWorkspace, current: Fit) -> list[Term]:
    """Terms with one free parameter, at a usual size, that accepted effects explain to first order.

    That size is where fits of the effect start, or one scale where they start from its absence.
    """
    accepted = {term.id for term in current.hypothesis.terms}
    sizes = workspace.columns.sizes(current.hypothesis)
    left = np.diag(workspace.columns.gram(current.linearised))[1:]
    hidden = (sizes > 0.0) & (left < MAX_LEFT_SHARE * sizes**2)
    terms = []
    for block in workspace.columns.sensitivities_at(current.hypothesis).blocks:
        candidate = block.candidate
        if candidate.effect.id in accepted or candidate.thresholds:
            continue
        if block.secant is None:
            pairs = zip(candidate.sloped, block.derivatives, strict=True)
            terms += [candidate.term((name,)).at(np.ones(1)) for name, j in pairs if hidden[j]]
        elif len(candidate.sloped) == 1 and hidden[block.secant]:
            terms.append(candidate.term())
    return terms


def _measure_curvatures(
    workspace: SearchWorkspace, current: Fit, trials: list[Term]
) -> list[Array]:
    """For each trial, the Gram matrix (2, 2) of the innovations and of what it changes in them.

    What the free parameters of the current fit can explain is projected out of both.
    """
    bank, linearised = workspace.bank, current.linearised
    outputs = bank.evaluate([current.hypothesis.model + trial.effect for trial in trials])
    changes = [e_run - e[None] for e_run, e in zip(outputs, linearised.e, strict=True)]
    finite = np.all([np.isfinite(c).all(axis=(1, 2)) for c in changes], axis=0)
    changes = [np.where(finite[:, None, None], c, 0.0) for c in changes]
    rows = [np.concatenate([r, c]) for r, c in zip(linearised.rows, changes, strict=True)]
    G = gram(bank.flatten(rows, workspace.noise))
    k = len(linearised.hypothesis.x)
    projected = project_out(G, range(1, k + 1))
    return [projected[np.ix_((0, k + 1 + i), (0, k + 1 + i))] for i in range(len(trials))]
