"""Which other effects are tried in the place of one that was selected."""

from types import SimpleNamespace

import pytest

from rovsim.diagnosis.selection.promising import find_swaps, list_swaps
from rovsim.diagnosis.selection.proposals import Proposal
from rovsim.dynamics.effects.constant_wrench import ConstantWrench
from rovsim.estimation.observer.hypothesis import Term


@pytest.mark.parametrize(("loss", "tried"), [(100.0, 3), (300.0, 1)])
def test_all_that_promise_nearly_what_a_term_explains_challenge_it(loss, tried):
    term = Term(ConstantWrench(surge=1.0), ("surge",))
    others = [Proposal(SimpleNamespace(id=str(size)), size) for size in (95.0, 90.0, 80.0, 30.0)]
    found = find_swaps(
        SimpleNamespace(penalty=0.0),
        term,
        SimpleNamespace(ss_increase=loss, others=others),
        trials=1,
    )
    assert [p.net_decrease for p in found] == [95.0, 90.0, 80.0][:tried]


def test_the_likeliest_swap_of_all_terms_is_tried_first():
    """A swap that is accepted begins anew, and with it all refits that failed before it."""
    force = Term(ConstantWrench(surge=1.0), ("surge",))
    forces = Term(ConstantWrench(surge=1.0, sway=1.0), ("surge", "sway"))

    def removed(loss, *promised):
        others = [Proposal(SimpleNamespace(id=str(size)), size) for size in promised]
        return SimpleNamespace(ss_increase=loss, others=others)

    workspace = SimpleNamespace(
        penalty=10.0,
        settings=None,
        first_order=SimpleNamespace(
            remove_each=lambda fit: [removed(100.0, 95.0, 60.0), removed(120.0, 110.0)]
        ),
    )
    current = SimpleNamespace(hypothesis=SimpleNamespace(terms=(force, forces)))
    swaps = list_swaps(workspace, current, trials=2)
    assert [(s.term, s.predict_deficit(workspace)) for s in swaps] == [
        (forces, -10.0),
        (force, -5.0),
        (force, 30.0),
    ]
