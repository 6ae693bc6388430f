"""A special effect beside a loose vehicle file."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rovsim.diagnosis.selection.proposals import rank_proposals
from rovsim.diagnosis.selection.vehicle_file.loose_file import (
    PRIOR_ODDS_LR,
    Contender,
    LooseFile,
    cost_within,
)
from rovsim.dynamics.effects.damping import LinearDamping, QuadraticDamping
from rovsim.dynamics.model import nominal
from rovsim.dynamics.vehicle import default_vehicle, load_vehicle
from rovsim.estimation.candidates import Candidate
from rovsim.estimation.observer.hypothesis import Hypothesis
from rovsim.estimation.sensitivities import CandidateColumns

PENALTY = 10.0
OFF = ("linear_damping", "quadratic_damping", "added_mass")
LIMIT = PENALTY + PRIOR_ODDS_LR  # of an effect with one number


@given(seed=st.integers(0, 10_000), count=st.integers(1, 6))
def test_a_loose_file_takes_what_its_numbers_take_within_their_spread(seed, count):
    random = np.random.default_rng(seed)
    rows, spread = random.normal(size=(1 + count, 40)), random.uniform(0.01, 3.0, count)
    cost = cost_within(rows @ rows.T, range(1, 1 + count), spread)
    stacked = np.hstack([rows, np.vstack([np.zeros(count), np.diag(1.0 / spread)])])
    x = np.linalg.lstsq(stacked[1:].T, -stacked[0], rcond=None)[0]
    assert cost == pytest.approx(np.sum((stacked[0] + x @ stacked[1:]) ** 2), rel=1e-6)


def term(name):
    return SimpleNamespace(id=name, choices=1)


def fit(cost, *names):
    """A fit that leaves `cost` of the sum of squares beside a loose file."""
    return SimpleNamespace(
        linearised=cost, hypothesis=SimpleNamespace(terms=[term(n) for n in names])
    )


def loose_file(without=0.0):
    """`without`: what is left beside it if a term is taken away."""
    return LooseFile(
        SimpleNamespace(
            penalty=PENALTY,
            columns=SimpleNamespace(gram=lambda seen: np.array([[seen]])),
            first_order=SimpleNamespace(gram_without=lambda fit, term: np.array([[without]])),
            sensitivities=SimpleNamespace(base_model=None, blocks=()),
        )
    )


@pytest.mark.parametrize(
    ("loss", "name", "explained"),
    [
        (LIMIT - 1.0, "constant_wrench", True),
        (LIMIT + 1.0, "constant_wrench", False),
        (LIMIT - 1.0, "net_buoyancy", False),  # of the file itself
    ],
)
def test_a_special_effect_must_do_without_a_loose_file(loss, name, explained):
    found = fit(100.0, "added_mass", name)
    assert loose_file(100.0 + loss).explains(found, name) is explained


@given(more=st.floats(-60.0, 60.0))
def test_who_is_likelier_does_not_depend_on_who_was_selected(more):
    file = fit(100.0, "net_buoyancy", *OFF)
    special = fit(100.0 + more, "constant_wrench", *OFF)
    own = Contender(file, term("net_buoyancy"))
    other = Contender(special, term("constant_wrench"))
    there = loose_file().weigh(own, other, 0.0)
    assert there == pytest.approx(-loose_file().weigh(other, own, 0.0))
    assert there == pytest.approx(more + LIMIT)


def test_two_effects_of_the_file_are_weighed_as_they_are():
    own = Contender(fit(100.0, "net_buoyancy", *OFF), term("net_buoyancy"))
    other = Contender(fit(1.0, "buoyancy_center", *OFF), term("buoyancy_center"))
    assert loose_file().weigh(own, other, 7.0) == 7.0


def test_a_file_with_one_or_two_wrong_effects_may_be_right_elsewhere():
    own, other = Contender(fit(100.0, *OFF[:2]), term(OFF[0])), fit(1.0, "lift")
    assert loose_file().weigh(own, Contender(other, term("lift")), 7.0) == 7.0


def test_two_that_hide_each_other_are_proposed_together_and_neither_alone():
    drags = [Candidate(one, one(), ("heave",)) for one in (LinearDamping, QuadraticDamping)]
    blocks = [CandidateColumns(drag, None, (k,)) for k, drag in enumerate(drags)]
    random = np.random.default_rng(3)
    slow = random.normal(size=400)
    columns = np.vstack([slow, slow + 0.1 * random.normal(size=400)])
    hidden = columns[0] - columns[1]  # of opposite sign: hardly anything is left of them
    rows = np.vstack([-50.0 * hidden, columns])
    alone = rank_proposals(rows @ rows.T, blocks, penalty=400.0)
    assert all(one.net_decrease < 0.0 for one in alone)
    base = nominal(load_vehicle(default_vehicle()))
    workspace = SimpleNamespace(
        penalty=400.0,
        columns=SimpleNamespace(gram=lambda seen: rows @ rows.T),
        sensitivities=SimpleNamespace(base_model=base, blocks=blocks),
    )
    current = SimpleNamespace(linearised=None, hypothesis=Hypothesis(base))
    both = LooseFile(workspace).propose(current)
    assert [(one.id, one.free) for one in both.terms] == [
        ("linear_damping", ("heave",)),
        ("quadratic_damping", ("heave",)),
    ]
    assert both.x == pytest.approx([50.0, -50.0])
