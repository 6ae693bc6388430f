"""Laws of the thrust: one force, as the engine knows it, as a file says it, as it was searched."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from rovsim.core.run import Site
from rovsim.diagnosis.equations.products.variables import LATERAL_AXES
from rovsim.diagnosis.equations.with_thrust import (
    ThrustTerm,
    WithThrust,
    build_law,
    evaluate_thrust_at,
    list_thrust_terms,
)
from rovsim.dynamics.engine.kernel_inputs import Actuators, example_reading
from rovsim.dynamics.laws.thrust_law import MAX_THRUSTERS, SECOND_THRUST
from rovsim.simulation.batch import Batch
from rovsim.simulation.drive import Drive
from worlds import model, tank, write_and_read

TERMS = [
    ThrustTerm(4, 0),
    ThrustTerm(2, 0, True),
    ThrustTerm(0, 2, True, 0),
    ThrustTerm(5, 0, True, 1),
    ThrustTerm(1, 1, False, 9),
    ThrustTerm(4, 0, False, SECOND_THRUST, 2),
    ThrustTerm(1, 5, True, SECOND_THRUST, 1),
    ThrustTerm(2, 2, False, SECOND_THRUST, 2),
]
EVERY = pytest.mark.parametrize("term", TERMS, ids=lambda term: WithThrust(term).equation)
RNG = np.random.default_rng(3)
NU, FORCE = RNG.uniform(-0.5, 0.5, (5, 6)), RNG.uniform(-20.0, 20.0, (5, 8))  # m/s, rad/s; N


def law_of(term, c=2.0, size=0.7):
    """The law of a term, with that coefficient per unit of its size."""
    return build_law(term, model(), size, c)


def wrenches(effect):
    """What an effect pushes (n, 6) in the engine."""
    count = len(NU)
    still = np.zeros((count, 6))
    drive = Drive(still, FORCE, still, 60.0, read=np.hstack([FORCE, 0.0 * FORCE]))
    state = np.hstack([np.zeros((count, 3)), np.eye(4)[[0] * count], NU])
    site = Site(tank().tank, np.array([1.0, -1.0, -1.0]))
    with_law, without = (
        Batch([m], site).accelerations(drive, np.zeros(count), state, np.empty((0, 6)))
        for m in (model() + effect, model())
    )
    return (with_law - without) @ model().body.M.T


def written_wrenches(effect):
    """What a written effect pushes (n, 6): its kernel is plain Python."""
    p = effect.named_parameters()(*effect.values)
    found = []
    for nu, force in zip(NU, FORCE, strict=True):
        seen = Actuators(force, 0.0 * force, np.zeros((8, 3)))
        at = example_reading(None)._replace(nu=tuple(nu), nu_r=tuple(nu), actuators=seen)
        found.append(effect.wrench(at, p))
    return np.array(found)


@EVERY
def test_the_search_the_engine_and_the_file_push_alike(term, tmp_path):
    law = law_of(term)
    (sought,) = evaluate_thrust_at([term], NU, FORCE @ model().body.B.T)
    assert np.abs(sought).max() > 1e-3
    np.testing.assert_allclose(wrenches(law.effect), 2.0 / 0.7 * sought, rtol=1e-9, atol=1e-12)
    cls, written = write_and_read(WithThrust(term), law, tmp_path)
    np.testing.assert_allclose(written_wrenches(written), 2.0 / 0.7 * sought, rtol=1e-4, atol=1e-9)
    np.testing.assert_array_equal(written_wrenches(cls()), 0.0)  # without values it does nothing


def runs(*still):
    """Runs in which all axes move but these."""
    return [SimpleNamespace(axes=~np.isin(np.arange(6), still))]


def test_terms_turn_with_the_mirror():
    """Port and starboard exchanged: sway, roll and yaw change sign, and so does the push."""
    turned = np.where(np.isin(np.arange(6), LATERAL_AXES), -1.0, 1.0)
    terms, thrust = list_thrust_terms(runs(), model()), FORCE @ model().body.B.T
    one, other = (evaluate_thrust_at(terms, NU * sign, thrust * sign) for sign in (1.0, turned))
    np.testing.assert_allclose(other, one * turned, atol=1e-12)
    assert not any(t.on == t.thrust and t == ThrustTerm(t.on, t.thrust) for t in terms)  # a gain
    assert set(TERMS) <= set(terms)


def test_what_does_not_move_has_no_terms_and_other_thrusters_neither():
    fewer = list_thrust_terms(runs(3, 4), model())
    assert not any(t.on in (3, 4) or t.factor in (3, 4, 9, 10) for t in fewer)
    own = model()
    body = replace(own.body, B=np.zeros((6, MAX_THRUSTERS + 1)))
    assert list_thrust_terms(runs(), SimpleNamespace(body=body, vehicle=own.vehicle)) == []


@pytest.mark.parametrize(
    ("term", "unit"),
    [
        (ThrustTerm(4, 0), "m"),
        (ThrustTerm(2, 0, True), "1"),
        (ThrustTerm(0, 2, True, 0), "s/m"),
        (ThrustTerm(5, 0, True, 1), "s"),
        (ThrustTerm(1, 1, False, 9), "s/rad"),
        (ThrustTerm(4, 0, False, SECOND_THRUST, 2), "m/N"),
        (ThrustTerm(1, 5, False, 5), "s/(m rad)"),
    ],
)
def test_units_make_newtons(term, unit):
    assert WithThrust(term).unit == unit
