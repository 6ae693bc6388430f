"""Does an effect with many parameters stand in for several narrower ones?

Accepted first, it may explain what a few numbers of several effects do, none of which could take
its place by itself. No swap leads there. For example, added masses of all axes and a drag were sure
in a free decay in which the centre of buoyancy had moved and a drag and a fluid memory were hidden.
"""

from typing import Callable

from rovsim.core.axes import AXES
from rovsim.diagnosis.selection.promising import explains_enough
from rovsim.diagnosis.selection.thresholds import add_term
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.estimation.file_effects import has_loose_file
from rovsim.estimation.fit import Fit

MIN_WIDE = 4  # axes with a number of their own; other effects have one to three numbers
SearchOn = Callable[[SearchWorkspace, Fit], tuple[SearchWorkspace, Fit]]


def spread_wide(
    workspace: SearchWorkspace, current: Fit, search_on: SearchOn, min_gain: float
) -> Fit:
    """Put a narrower effect in the place of a wide one and search on; keep what is likelier.

    A loose vehicle file stays as it is: all of it was freed together.

    Args:
        workspace: of the search.
        current: the fit so far.
        search_on: adds effects to a fit, and swaps, until none beats chance.
        min_gain: by how much the score has to be larger in the end.
    """
    if has_loose_file(current.hypothesis):
        return current
    removals = workspace.first_order.remove_each(current)
    for term, rest in zip(current.hypothesis.terms, removals, strict=True):
        if sum(name in AXES for name in term.free) < MIN_WIDE:
            continue
        for p in rest.others:
            narrower = p.term.id != term.id and p.term.choices < term.choices
            if narrower and explains_enough(workspace, rest, p):
                start = workspace.fit(add_term(workspace, rest.hypothesis, p.term))
                found = workspace.fit(search_on(workspace, start)[1].hypothesis)
                if workspace.score(found) > workspace.score(current) + min_gain:
                    return spread_wide(workspace, found, search_on, min_gain)
    return current
