"""Of two answers that each leave something: which one is given."""

from types import SimpleNamespace

import pytest

from rovsim.diagnosis.answer import choose_answer

SMALL = SimpleNamespace(size=3, score=10.0, complete=False, replayed="small", fit="small")
LARGE = SimpleNamespace(size=9, score=50.0, complete=False, replayed="large", fit="large")


def told(held: bool | None, between: bool | None) -> SimpleNamespace:
    """Hold-out validation by which LARGE is better than SMALL, or not, or neither."""

    def prefers(says):
        return lambda one, other: None if says is None else says is (one == "large")

    return SimpleNamespace(
        runs=["a run"], prefers=prefers(held), prefers_between_runs=prefers(between)
    )


@pytest.mark.parametrize("order", [(SMALL, LARGE), (LARGE, SMALL)])
@pytest.mark.parametrize(
    ("held", "between", "given"),
    [
        (True, False, LARGE),  # stretches kept apart decide
        (False, True, SMALL),
        (None, True, LARGE),  # else whole runs
        (None, False, SMALL),
        (None, None, SMALL),  # else the smaller, however likely the other
    ],
)
def test_what_replays_better_is_given_or_else_the_smaller(order, held, between, given):
    assert choose_answer(*order, told(held, between)) is given


def test_of_two_alike_the_likelier_is_given():
    likelier = SimpleNamespace(**vars(SMALL) | {"score": 11.0})
    assert choose_answer(SMALL, likelier, told(None, None)) is likelier
    assert choose_answer(likelier, SMALL, told(None, None)) is likelier


def test_what_leaves_nothing_comes_before_what_is_smaller():
    complete = SimpleNamespace(**vars(LARGE) | {"complete": True})
    assert choose_answer(SMALL, complete, told(None, None)) is complete
