"""A special effect beside a vehicle file that may be off everywhere.

Where several effects that the file states were selected, it is off elsewhere too, mostly by too
little to be found: a dozen such numbers, none of them worth its penalty, may explain together what
a special effect seems to. So there it is judged with all of the file free, as far as such files are
off (`stated.py`), and to first order. Where the file explains it, its numbers are sought
together: linear and quadratic drag of opposite sign look like friction, and neither alone explains
anything.
"""

from typing import NamedTuple

import numpy as np
from numpy import ndarray as Array

from rovsim.core.odds import lr_statistic_of
from rovsim.diagnosis.observer.hypothesis import Hypothesis, Term
from rovsim.diagnosis.observer.least_squares import eliminate_columns, solve
from rovsim.diagnosis.selection.candidates import Candidate
from rovsim.diagnosis.selection.fit import Fit
from rovsim.diagnosis.selection.vehicle_file.stated import ONE_GAIN, STATED, is_off, spread_of_file
from rovsim.diagnosis.selection.workspace import HOPELESS_LR, SearchWorkspace
from rovsim.dynamics.effects.thrusters import ThrusterGain

# Some thirty effects, each there once in thirty times, against a coefficient of a file that is
# known to be off.
FILE_LR = lr_statistic_of(odds=1000.0)


class FileNumber(NamedTuple):
    """A parameter of a candidate that the file states.

    `row` of the workspace's Gram matrix; `spread`, in scales, how far the file may be off.
    """

    candidate: Candidate
    parameter: str
    row: int
    spread: float


def list_numbers(workspace: SearchWorkspace) -> list[FileNumber]:
    """All that the vehicle file can be wrong about."""
    base, numbers = workspace.sensitivities.base_model, []
    for block in workspace.sensitivities.blocks:
        effect = block.candidate.effect
        if not block.candidate.absent or effect.id not in STATED:
            continue
        each = zip(block.derivatives, block.candidate.term().parameters, strict=True)
        for column, parameter in each:
            if (
                effect.id != ThrusterGain.id or parameter.name in ONE_GAIN
            ):  # one thruster's: a fault
                spread = spread_of_file(base, effect, parameter)
                numbers.append(FileNumber(block.candidate, parameter.name, 1 + column, spread))
    return numbers


def cost_beside(numbers: list[FileNumber], G: Array) -> float:
    """What is left of the sum of squares with all numbers of the file free, to first order.

    Args:
        numbers: of the file.
        G: Gram matrix (1 + c, 1 + c) of the innovations and the candidates' columns.
    """
    H, b, spread = _take(numbers, G)
    return float(G[0, 0] - b @ solve(H + np.diag(spread**-2.0), b))


def _take(numbers: list[FileNumber], G: Array) -> tuple[Array, Array, Array]:
    """Inner products of the numbers with each other and with the innovations, and spread."""
    own = [number.row for number in numbers]
    spread = np.array([number.spread for number in numbers])
    return G[np.ix_(own, own)], G[own, 0], spread


def measure_cost(workspace: SearchWorkspace, fit: Fit) -> float:
    """The same of a fit."""
    return cost_beside(list_numbers(workspace), workspace.columns.gram(fit.seen))


def measure_doubt(workspace: SearchWorkspace, fit: Fit) -> float:
    """How much likelier a file is that is off everywhere than one that is right beside a fit.

    Twice the log of Bayes' factor, to first order, of all numbers of the file as free as
    such files are off. Each number that nothing asks for counts against it.
    """
    numbers, G = list_numbers(workspace), workspace.columns.gram(fit.seen)
    H, _, spread = _take(numbers, G)
    needless = float(np.linalg.slogdet(np.eye(len(H)) + spread[:, None] * H * spread)[1])
    return float(G[0, 0]) - cost_beside(numbers, G) - needless


def measure_loss(workspace: SearchWorkspace, fit: Fit, term: Term) -> float:
    """How much more is left beside a loose file without one term of a fit."""
    numbers, rest = list_numbers(workspace), workspace.gram_without(fit, term)
    return cost_beside(numbers, rest) - cost_beside(numbers, workspace.columns.gram(fit.seen))


def find_limit(workspace: SearchWorkspace, term: Term) -> float:
    """What a term must take away beside a loose file; nothing if it is of the file."""
    return 0.0 if term.id in STATED else workspace.penalty * term.choices + FILE_LR


def explains(workspace: SearchWorkspace, fit: Fit, name: str) -> bool:
    """Whether all of the file together explains what a special effect of a fit does."""
    if name in STATED:
        return False
    term = next(one for one in fit.hypothesis.terms if one.id == name)
    return measure_loss(workspace, fit, term) <= find_limit(workspace, term)


def weigh(
    workspace: SearchWorkspace,
    own: tuple[Fit, Term],
    other: tuple[Fit, Term],
    deviance_difference: float,
) -> float:
    """How much less likely the other term's fit is, beside a file that is off if it is.

    Both of the file, or hopeless: `deviance_difference`, what is known of the two fits as they are.
    """
    (current, term), (trial, rival) = own, other
    both = term.id in STATED and rival.id in STATED
    if both or not is_off(current.hypothesis) or deviance_difference >= HOPELESS_LR:
        return deviance_difference
    more = measure_cost(workspace, trial) - measure_cost(workspace, current)
    return more + find_limit(workspace, rival) - find_limit(workspace, term)


def propose_file(workspace: SearchWorkspace, current: Fit) -> Hypothesis | None:
    """With all numbers of the file that are worth their penalty beside each other; None: nothing.

    To first order. Without the gain of the thrusters: any other number left out would seem to fix
    the common scale, and the gain would follow it away from what the file says.
    """
    numbers = [n for n in list_numbers(workspace) if n.candidate.effect.id != ThrusterGain.id]
    own, G = [number.row for number in numbers], workspace.columns.gram(current.seen)
    reduction = eliminate_columns(G[np.ix_(own, own)], G[own, 0], workspace.penalty)
    h = current.hypothesis
    for j, x in zip(reduction.chosen, reduction.x, strict=True):
        term = numbers[j].candidate.term([numbers[j].parameter])
        h = h.with_term(term.at(term.x + x))
    return h if reduction.chosen else None
