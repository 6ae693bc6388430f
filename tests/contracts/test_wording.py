"""Words of the terminal and the report: whole phrases, one name for one thing."""

import pytest

from rovsim.dynamics.catalogue import built_in
from rovsim.reporting.wording import listed
from rovsim.reporting.words import terminal
from rovsim.reporting.words.verdict import explain
from synthetic_study import study


@pytest.fixture(scope="module")
def content():
    return study()


def test_a_phrase_is_listed_as_a_whole():
    phrases = [f"cubic_damping instead of {name}" for name in ("quadratic_damping", "lift")]
    assert listed(phrases) == " and ".join(phrases)


def test_shares_of_several_effects_are_said_to_add_up(content):
    first, *others = explain(content["diagnosis"], built_in()).missing
    assert " of the error, " in first.worth
    assert others
    assert all(one.worth.startswith("removes another ") for one in others)
    told = " ".join(terminal.tell_diagnosis(content["diagnosis"], built_in()).split())
    assert "on top of those above it" in told


def test_an_effect_that_harms_is_not_said_to_remove_anything(content):
    harmful = content["diagnosis"].selected[0].model_copy(update={"error_reduction": -0.03})
    found = content["diagnosis"].model_copy(update={"selected": (harmful,)})
    (said,) = explain(found, built_in()).missing
    assert said.worth.startswith("raises the error by 3")
