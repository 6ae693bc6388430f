"""A search that its limit stopped is only finished where no joint fit of everything is better."""

from types import SimpleNamespace

import pytest

from rovsim.diagnosis import validated_search
from rovsim.diagnosis.selection.filter_delay import SearchStart

NOISE = SimpleNamespace(drift=None)


def found(name, stopped):
    return SimpleNamespace(name=name, stopped=stopped, best=SimpleNamespace(noise=NOISE))


def settled(selection):
    fit = SimpleNamespace(noise=NOISE)
    return SimpleNamespace(selection=selection, fit=fit, leaves_physics=True, complete=False)


@pytest.mark.parametrize(
    ("stopped", "joint_is_better", "finished", "given"),
    [
        (False, False, 1, "finished"),
        (True, True, 0, "joint"),
        (True, False, 1, "finished"),
    ],
)
def test_it_is_finished_where_nothing_is_better(
    monkeypatch, stopped, joint_is_better, finished, given
):
    finishing = []

    def finish(begun, seed):
        finishing.append(begun)
        return found("finished", begun.stopped)

    def challenge(answer, *context):
        return settled(found("joint", False)) if joint_is_better else answer

    usable = SimpleNamespace(runs=())
    settings = SimpleNamespace(seed=0)
    replaced = {
        "find_smoothing": lambda *of: None,
        "keep_apart": lambda runs: ([], []),
        "_make_starts": lambda *of: iter([SearchStart(None, None, None)]),
        "begin_search": lambda *of: found("begun", stopped),
        "finish_search": finish,
        "settle_noticed": lambda selection, *of: settled(selection),
        "_unmask": lambda answer: answer,
        "_challenge_jointly": challenge,
        "choose_answer": lambda one, other, holdout: other,
        "find_run_difference": lambda selection: None,
    }
    for name, function in replaced.items():
        monkeypatch.setattr(validated_search, name, function)
    problem = validated_search.DiagnosisProblem(None, usable, settings, None)
    validated = validated_search.search_and_validate(problem)
    assert len(finishing) == finished
    assert validated.answer.selection.name == given
