"""Which other effects are tried in the place of one that was selected."""

from types import SimpleNamespace

import pytest

from rovsim.diagnosis.selection.forward_selection import find_swaps
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
