"""Of answers that leave something: what is tried next, and which of two is given."""

from types import SimpleNamespace

import pytest

from rovsim.diagnosis import answer
from rovsim.diagnosis.answer import choose_answer, settle_noticed
from rovsim.diagnosis.selection.search_result import SearchResult

UNLIKELY = SimpleNamespace(score=10.0, complete=False, replayed="unlikely", fit="unlikely")
LIKELY = SimpleNamespace(score=50.0, complete=False, replayed="likely", fit="likely")


def told(held: bool | None, between: bool | None) -> SimpleNamespace:
    """Hold-out validation by which LIKELY is better than UNLIKELY, or not, or neither."""

    def prefers(says):
        return lambda one, other: None if says is None else says is (one == "likely")

    return SimpleNamespace(
        runs=["a run"], prefers=prefers(held), prefers_between_runs=prefers(between)
    )


@pytest.mark.parametrize("order", [(UNLIKELY, LIKELY), (LIKELY, UNLIKELY)])
@pytest.mark.parametrize(
    ("held", "between", "given"),
    [
        (True, False, LIKELY),  # stretches kept apart decide
        (False, True, UNLIKELY),
        (None, True, LIKELY),  # else whole runs
        (None, False, UNLIKELY),
        (None, None, LIKELY),  # else the likelier
    ],
)
def test_what_replays_better_is_given_or_else_the_likelier(order, held, between, given):
    assert choose_answer(*order, told(held, between)) is given


def test_what_leaves_nothing_comes_before_what_is_likelier():
    complete = SimpleNamespace(**vars(UNLIKELY) | {"complete": True})
    assert choose_answer(LIKELY, complete, told(None, None)) is complete


@pytest.mark.parametrize("stopped", [False, True])
def test_only_where_the_evidence_ended_a_search_unnoticed_effects_are_sought(monkeypatch, stopped):
    sought = []
    selection = SimpleNamespace(best="noticed", stopped=stopped)

    def search_unnoticed(found, seed):
        sought.append(found)
        return found

    for name in ("drop_unsure", "drop_idle", "drop_unlogged"):
        monkeypatch.setattr(answer, name, lambda selection: selection)
    monkeypatch.setattr(answer, "search_unnoticed", search_unnoticed)
    left = SimpleNamespace(leaves_physics=True)
    monkeypatch.setattr(answer, "settle", lambda *of: left)
    assert settle_noticed(selection, None, None, 0) is left
    assert sought == ([] if stopped else [selection])


@pytest.mark.parametrize(
    ("trial", "surely_worse", "kept"),
    [
        (None, None, "gain"),  # no common gain was fitted
        ("file", None, "file"),  # where replays cannot tell, the file's gain
        ("file", False, "file"),
        ("file", True, "gain"),  # a thruster may be faulty
    ],
)
def test_beside_unknown_physics_the_gain_is_the_files_unless_replays_say_else(
    monkeypatch, trial, surely_worse, kept
):
    def settled(name):
        fit = SimpleNamespace(is_finite=True)
        selection = SearchResult(None, name, ())
        left = {"structures": ["left"], "score": 0.0}
        return SimpleNamespace(selection=selection, fit=fit, replayed=name, name=name, **left)

    fit = SimpleNamespace(is_finite=True) if trial else None
    monkeypatch.setattr(answer, "without_gain", lambda workspace, best: fit)
    monkeypatch.setattr(answer, "_settle_values", lambda selection, usable: settled("file"))
    holdout = SimpleNamespace(runs=["a run"], prefers=lambda one, other: surely_worse)
    assert answer._keep_file_gain(settled("gain"), None, holdout).name == kept


@pytest.mark.parametrize(
    ("left", "score", "kept"),
    [
        ((), -500.0, ("push",)),  # a disturbance of 500 in twice the log likelihood hides it
        ((), 2.0, ()),
        (("other",), -500.0, ("other",)),
    ],
)
def test_fewer_and_less_likely_effects_leave_what_more_effects_left(monkeypatch, left, score, kept):
    def settled(structures, score):
        fit = SimpleNamespace(is_finite=True)
        return answer.SettledAnswer(SearchResult(None, score, ()), fit, None, score, structures)

    more, fewer = settled((SimpleNamespace(moment=False),), 0.0), settled(left, score)
    holdout = SimpleNamespace(
        validate=lambda selection: (selection, True), keep_earning=lambda selection: fewer.selection
    )
    monkeypatch.setattr(
        answer, "_settle_values", lambda own, usable: more if own is more.selection else fewer
    )
    monkeypatch.setattr(answer, "_keep_file_gain", lambda settled, usable, holdout: settled)
    found = answer.settle(more.selection, None, holdout)
    assert found.selection is fewer.selection
    assert found.structures == (more.structures if kept == ("push",) else kept)
