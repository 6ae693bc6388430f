"""A proposed law: one force, as the engine knows it, as a file says it, and as it was searched."""

import numpy as np
import pytest

from rovsim.core.rotations import from_euler, matrix
from rovsim.core.run import Site
from rovsim.diagnosis.equations.form import get_law
from rovsim.diagnosis.equations.products.as_effect import list_moved
from rovsim.diagnosis.equations.products.columns import Columns
from rovsim.diagnosis.equations.products.library import (
    LawTerm,
    evaluate_wrenches_at,
    list_body_terms,
)
from rovsim.diagnosis.equations.products.products import Products
from rovsim.diagnosis.equations.products.search import propose
from rovsim.diagnosis.equations.products.selection import choose_kinds, stay
from rovsim.diagnosis.equations.products.targets import TARGETS
from rovsim.diagnosis.equations.products.variables import LATERAL_AXES, VARIABLES, tabulate
from rovsim.diagnosis.equations.products.wording import write_equation
from rovsim.dynamics.engine.types import EXAMPLE
from rovsim.dynamics.laws.law import COEFFICIENTS, Law, Product
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.simulation.batch import Batch
from rovsim.simulation.drive import Drive
from worlds import model, tank, write_and_read

PLACE = np.array([4.0, -2.0, 1.0, 0.8])  # north, east, down m; width m
SIGNS = np.array([1.0, -1.0, -1.0])  # of a MoCap world whose z is up
LAWS = [  # every factor, and everything that terms act on
    [LawTerm(1, (0, 0, 1)), LawTerm(5, (7, 5)), LawTerm(0, (12,))],
    [LawTerm(2, (24, 2)), LawTerm(3, (25, 1)), LawTerm(4, (18, 20))],
    [LawTerm(4, (21,)), LawTerm(3, (22, 23)), LawTerm(5, (13, 10))],
    [LawTerm(6, (26, 27)), LawTerm(7, (29,)), LawTerm(8, (28,))],
    [LawTerm(11, (29,)), LawTerm(9, (26,)), LawTerm(10, (27, 27))],
    [LawTerm(11, ()), LawTerm(0, (29, 0)), LawTerm(8, ())],
]


def states(count=5):
    rng = np.random.default_rng(3)
    poses = [
        (*rng.uniform(-3, 5, 3), *from_euler(*rng.uniform(-0.6, 0.6, 3))) for _ in range(count)
    ]
    return np.hstack([poses, rng.uniform(-0.5, 0.5, (count, 6))])


def law_of(terms, c=(2.0, -3.0, 0.5)):
    """The law of these terms, with a model's own drag."""
    body = model().body
    values = {f"linear{i}": body.linear[i] for i in range(3)}
    values |= {f"quadratic{i}": body.quadratic[i] for i in range(3)}
    values |= dict(zip(("x", "y", "z"), PLACE[:3] * SIGNS, strict=True)) | {"width": PLACE[3]}
    products = [Product(c[k], 0.7, term.on, term.factors) for k, term in enumerate(terms)]
    free = (*COEFFICIENTS[: len(terms)], *list_moved(terms))
    return Term(Law.of(products, **values), free)


def at(state):
    R = tuple(map(tuple, matrix(state[None, 3:7])[0]))
    nu = tuple(state[7:])
    return EXAMPLE._replace(position=tuple(state[:3]), R=R, nu=nu, nu_r=nu, axes=tuple(SIGNS))


def written_wrenches(effect):
    """What a written effect pushes (n, 6): its kernel is plain Python."""
    p = effect.named_parameters()(*effect.values)
    return np.array([effect.wrench(at(state), p) for state in states()])


def wrenches(law):
    """What the law pushes (n, 6) in the engine."""
    base, known = model(), states()
    count = len(known)
    idle = Drive(np.zeros((count, 6)), np.zeros((count, 8)), np.zeros((count, 6)), 60.0)
    site = Site(tank().tank, SIGNS)
    with_law, without = (
        Batch([m], site).accelerations(idle, np.zeros(count), known, np.empty((0, 6)))
        for m in (base + law.effect, base)
    )
    return (with_law - without) @ base.body.M.T


@pytest.mark.parametrize("terms", LAWS, ids=write_equation)
def test_the_file_pushes_as_the_law_does(terms, tmp_path):
    law = law_of(terms)
    cls, written = write_and_read(Products(tuple(terms)), law, tmp_path)
    np.testing.assert_allclose(written_wrenches(written), wrenches(law), rtol=1e-5, atol=1e-9)
    assert not written_wrenches(cls()).any()  # without values it does nothing


@pytest.mark.parametrize("terms", LAWS, ids=write_equation)
def test_the_search_sees_what_the_law_does(terms):
    """To first order in the velocity of water that moves."""
    small = 1e-6
    for term in terms:
        law = law_of([term], (small,))
        sought = evaluate_wrenches_at([LawTerm(term.on, term.factors)], states(), model(), PLACE)[0]
        np.testing.assert_allclose(wrenches(law), 0.7 * small * sought, rtol=1e-4, atol=1e-11)


def test_terms_along_the_body_turn_with_the_mirror():
    """Port and starboard exchanged: sway, roll and yaw change sign, and so does the push."""
    turned = np.where(np.isin(np.arange(6), LATERAL_AXES), -1.0, 1.0)
    state = states()
    mirrored = state.copy()
    mirrored[:, 7:] *= turned
    mirrored[:, 3:7] *= [1.0, -1.0, 1.0, -1.0]
    mirrored[:, 1] *= -1.0
    for i in range(6):
        terms = list(list_body_terms(i, np.arange(6)))
        one, other = (
            evaluate_wrenches_at(terms, s, model(), PLACE * 0.0 + 1.0) for s in (state, mirrored)
        )
        np.testing.assert_allclose(other, one * turned, atol=1e-12)


def test_units_make_newtons():
    assert TARGETS[1].unit_of((0, 0, 1)) == "N s3/m3"
    assert TARGETS[5].unit_of((7, 5)) == "N m s2/(m rad)"
    assert TARGETS[11].unit_of(()) == "1/s"
    assert TARGETS[9].unit_of((26,)) == "1/s"
    assert TARGETS[10].unit_of((29,)) == "m/s"
    assert TARGETS[0].unit_of((12,)) == "N"
    assert len(VARIABLES) == len(tabulate(states(), PLACE))


def test_a_law_lists_its_terms_and_is_made_of_them_again():
    law = Law.of([Product(2.0, 0.7, 1, (0, 0, 1)), Product(0.0, 0.5, 11, ())], x=3.0)
    assert law.given() | {"c2": law["c2"]} == {
        **{"c1": 2.0, "size1": 0.7, "on1": 1.0, "factor11": 0.0, "factor12": 0.0, "factor13": 1.0},
        **{"c2": 0.0, "size2": 0.5, "on2": 11.0, "x": 3.0},
    }
    np.testing.assert_array_equal(Law.of(law.terms, **law.others).values, law.values)


def test_a_term_is_dropped_and_the_others_stay():
    terms = LAWS[3]
    fewer, rest = Products(tuple(terms)).simplify(Hypothesis(model(), (law_of(terms),)))[1]
    law = get_law(rest)
    assert fewer.terms == (terms[0], terms[2])
    assert law.free == ("c1", "c2", "x", "y", "z")
    both = [wrenches(law_of([t], (c,))) for t, c in ((terms[0], 2.0), (terms[2], 0.5))]
    np.testing.assert_allclose(wrenches(law), sum(both), atol=1e-9)


def test_the_regression_finds_the_terms_that_made_the_data():
    rng = np.random.default_rng(0)
    X = rng.normal(size=(3, 400, 8))
    X[..., 5] += 0.9 * X[..., 2]  # a term that resembles one of the true ones
    y = 2.0 * X[..., 2] - 1.0 * X[..., 6] + rng.normal(size=(3, 400))
    rows = np.concatenate([y[..., None], X], axis=2)
    terms = tuple(LawTerm(0, (k, k)) for k in range(8))
    columns = Columns(terms, np.ones(8), tuple(part.T @ part for part in rows), np.zeros(4))
    assert set(propose(columns, 2)[:2]) == {terms[2], terms[6]}


def test_what_is_known_of_a_place_stays_and_the_rest_is_sought():
    middle, own = np.array([1.0, 2.0, 3.0, 0.6]), np.array([5.0, 0.0, 0.0, 0.5])
    kept, known = stay(middle, ("x",), own)  # a term of the way north alone
    np.testing.assert_array_equal(kept, [5.0, 2.0, 3.0, 0.6])
    assert known == (5.0, None)
    assert stay(middle, ("z",), own)[1] == (None, None)


def test_of_one_kind_the_first_place_is_tried():
    here, there, other = (
        LawTerm(6, (29,), (0.0, 0.0)),
        LawTerm(6, (29,), (1.0, 0.0)),
        LawTerm(1, (7,)),
    )
    assert choose_kinds([there, other, here]) == [there, other]
