"""The path from a logged command to a force, each stage against a hand formula."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rovsim.benchmarks.blind.outside import Backlash
from rovsim.core.errors import BadInput
from rovsim.core.run import Commands
from rovsim.dynamics.effects.clocks import ClockDrift, InputDelay
from rovsim.dynamics.effects.force_curve import CurveExponent
from rovsim.dynamics.effects.thrusters import (
    AdvanceLoss,
    PropellerTorque,
    ThrustAsymmetry,
    ThrusterDeadband,
    ThrusterGain,
    ThrusterLag,
    VoltageSag,
)
from rovsim.dynamics.laws.propeller_lag import PropellerLag
from rovsim.dynamics.laws.thruster_play import ThrusterPlay
from rovsim.dynamics.laws.thruster_rate import PropellerRate, ThrustRate
from rovsim.dynamics.model import nominal
from rovsim.dynamics.vehicle import Vehicle
from worlds import model, sticks

EDGES = np.linspace(0.0, 2.0, 201)


def log(value=None, seconds=2.0):
    value = sticks() if value is None else value
    return Commands(np.linspace(0, seconds, len(value), endpoint=False), value, "thruster")


def force(*effects, commands=None, edges=EDGES):
    return model(*effects).thrust_path.over_steps(commands or log(), edges).force


@settings(max_examples=30, deadline=None)
@given(offset=st.floats(0.0, 0.05), h=st.floats(0.004, 0.05))
def test_step_means_are_exact_wherever_lines_fall(offset, h):
    edges = offset + h * np.arange(30)
    fine = offset + h * (np.arange(30 * 400 - 400) + 0.5) / 400
    commands = log()
    held = commands.value[np.searchsorted(commands.time, fine, "right") - 1]
    brute = model().thrust_path.thrusters.static_force(held).reshape(29, 400, 8).mean(axis=1)
    largest_jump = 30.0  # N
    assert np.abs(force(commands=commands, edges=edges) - brute).max() <= largest_jump / 400


def test_the_force_curve_is_odd_and_the_published_one():
    curve = model().thrust_path.thrusters.static_force
    c = np.linspace(-0.9, 0.9, 19)
    np.testing.assert_allclose(curve(c), -curve(-c), atol=1e-12)
    # vehicle file: 8.9 c + 176 c^3 - 404.1 c^5 + 389.9 c^7 - 140.3 c^9
    by_hand = 8.9 * c + 176 * c**3 - 404.1 * c**5 + 389.9 * c**7 - 140.3 * c**9
    np.testing.assert_allclose(curve(c), by_hand, atol=1e-9)


def test_commands_can_be_interpolated_between_lines():
    """A ramp of commands: the mean over a short step is the curve at the step's middle."""
    ramp = Commands(np.array([0.0, 2.0]), np.array([[0.0] * 8, [0.5] * 8]), "thruster")
    path = model().thrust_path
    middle = 0.5 * (EDGES[1:] + EDGES[:-1])
    expected = path.thrusters.static_force(np.repeat(0.25 * middle[:, None], 8, axis=1))
    np.testing.assert_allclose(path.over_steps(ramp, EDGES, "linear").force, expected, atol=1e-9)
    assert np.all(path.over_steps(ramp, EDGES, "held").force == 0)


def test_a_delay_shifts_and_a_fast_clock_compresses():
    late = force(InputDelay(delay=0.1))
    np.testing.assert_allclose(late[10:], force()[:-10], atol=1e-9)
    fast = model(ClockDrift(rate=0.01)).thrust_path.effective_time(np.array([1.01]))
    assert fast == pytest.approx([1.0])


@pytest.mark.parametrize("T", [0.02, 0.2, 1.0])
def test_lag_is_the_exact_first_order_response(T):
    step = Commands(np.array([0.0, 0.5]), np.array([[0.0] * 8, [0.4] * 8]), "thruster")
    final = model().thrust_path.thrusters.static_force(np.array([0.4]))[0]
    found = force(ThrusterLag(time_constant=T), commands=step)[:, 0]
    a, b = EDGES[:-1] - 0.5, EDGES[1:] - 0.5
    mean = final * (1 + T / (b - a) * (np.exp(-b / T) - np.exp(-a / T)))  # of 1 - exp(-t/T)
    np.testing.assert_allclose(found, np.where(a >= -1e-9, mean, 0.0), atol=1e-9)


def test_a_short_lag_is_no_lag():
    largest_jump, share = 30.0, 1e-6 / 0.01  # N; part of a step in which the force still differs
    found = force(ThrusterLag(time_constant=1e-6))
    np.testing.assert_allclose(found, force(), atol=largest_jump * share)


def test_the_response_can_be_computed_in_pieces():
    path = model(ThrusterLag(time_constant=0.15)).thrust_path
    static = path.thrusters.static_force(sticks(rows=90))
    whole, _ = path.respond(static, 0.01, None)
    states, parts = None, []
    for piece in np.split(static, [7, 40, 41]):
        mean, states = path.respond(piece, 0.01, states)
        parts.append(mean)
    np.testing.assert_allclose(np.concatenate(parts), whole, atol=1e-12)


@pytest.mark.parametrize("steps", [1, 2, 3, 7, 100, 1201])
def test_play_found_by_doubling_is_play_step_by_step(steps):
    """Of the benchmark's own backlash, which is stated step by step."""
    asked = np.cumsum(np.random.default_rng(steps).normal(size=(steps, 8)), axis=0)
    for state in (None, np.linspace(-3.0, 3.0, 8)):
        found, after = ThrusterPlay(band=0.7).respond(asked, 0.05, state)
        told, then = Backlash(width=0.7).respond(asked, 0.05, state)
        np.testing.assert_array_equal(found, told)
        np.testing.assert_array_equal(after, then)


def test_play_may_grow_and_be_computed_in_pieces():
    asked = np.cumsum(np.random.default_rng(0).normal(size=(300, 8)), axis=0)
    play = ThrusterPlay(band=0.2, share=0.3)
    whole, _ = play.respond(asked, 0.05, None)
    band = 0.2 + 0.3 * np.abs(asked)
    F, told = asked[0], []
    for wanted, w in zip(asked, band, strict=True):
        F = np.clip(F, wanted - w, wanted + w)
        told.append(F)
    np.testing.assert_array_equal(whole, told)
    state, parts = None, []
    for piece in np.split(asked, [1, 50, 51]):
        force, state = play.respond(piece, 0.05, state)
        parts.append(force)
    np.testing.assert_array_equal(np.concatenate(parts), whole)


def ramped(asked, rate, h, start, parts=1000):
    """Means over steps, and the last value, of what follows at a limited rate: small steps."""
    F, means = np.array(start, dtype=float), []
    for wanted in asked:
        passed = np.empty((parts, len(F)))
        for k in range(parts):
            before = F
            F = F + np.clip(wanted - F, -rate * h / parts, rate * h / parts)
            passed[k] = 0.5 * (before + F)
        means.append(passed.mean(axis=0))
    return np.array(means), F


@pytest.mark.parametrize("law", [ThrustRate(ramp=0.05), PropellerRate(ramp=0.05)])
@pytest.mark.parametrize("start", [None, (-3.0, 0.0, 4.0)])
def test_what_changes_at_a_limited_rate_gets_there_as_a_ramp_does(law, start):
    random, h, rate = np.random.default_rng(4), 0.05, 1.0 / 0.05
    asked = np.repeat(random.normal(scale=5.0, size=(8, 3)), 6, axis=0)
    root = isinstance(law, PropellerRate)
    static = asked * np.abs(asked) if root else asked
    found, after = law.respond(static, h, None if start is None else np.array(start))
    mean, last = ramped(asked, rate, h, asked[0] if start is None else start)
    largest = rate * h / 1000  # what a small step changes
    np.testing.assert_allclose(after, last, atol=2.0 * largest)
    np.testing.assert_allclose(found, mean * np.abs(mean) if root else mean, atol=50.0 * largest)
    assert np.abs(found - static).max() > 1.0


@pytest.mark.parametrize("start", [None, (-3.0, 0.0, 4.0)])
@pytest.mark.parametrize("lag", [0.3, 0.05, 0.01])
def test_a_propeller_spins_up_as_its_equation_says(lag, start):
    random, h, parts = np.random.default_rng(4), 0.05, 2000
    asked = np.repeat(random.normal(scale=3.0, size=(8, 3)), 6, axis=0)
    n, means = asked[0] if start is None else np.array(start), []
    gone = np.exp(-(np.arange(parts) + 0.5) / parts * h / lag)[:, None]
    for wanted in asked:
        passed = wanted + (n - wanted) * gone
        means.append((passed * np.abs(passed)).mean(axis=0))
        n = wanted + (n - wanted) * np.exp(-h / lag)
    law = PropellerLag(time_constant=lag)
    first = None if start is None else np.array(start)
    found, after = law.respond(asked * np.abs(asked), h, first)
    np.testing.assert_allclose(after, n, atol=1e-12)
    np.testing.assert_allclose(found, means, atol=1e-5)  # of up to 40: midpoints of small parts


@pytest.mark.parametrize(
    ("law", "given"),
    [
        (ThrustRate, {"ramp": 0.1}),
        (PropellerRate, {"ramp": 0.1}),
        (PropellerLag, {"time_constant": 0.1}),
    ],
)
def test_what_answers_slowly_can_be_computed_in_pieces_and_may_be_none(law, given):
    asked = np.random.default_rng(1).normal(scale=5.0, size=(60, 8))
    whole, last = law(**given).respond(asked, 0.05, None)
    state, parts = None, []
    for piece in np.split(asked, [1, 20, 21]):
        force, state = law(**given).respond(piece, 0.05, state)
        parts.append(force)
    np.testing.assert_array_equal(np.concatenate(parts), whole)
    np.testing.assert_array_equal(state, last)
    np.testing.assert_array_equal(law().respond(asked, 0.05, None)[0], asked)


@pytest.mark.parametrize("count", [0, 1, 2, 8, 12])
def test_each_thruster_of_a_vehicle_has_a_gain(count):
    names = tuple(f"t{i + 1}" for i in range(count))
    gain = ThrusterGain.on(SimpleNamespace(thruster_names=names))
    assert [p.name for p in gain.parameters] == [*names, "all"]
    own = 1.0 + np.arange(count)
    force = gain(**dict(zip(names, own, strict=True)), all=0.5).scaled_force(
        np.ones((3, count)), EDGES[:3], 2.0
    )
    np.testing.assert_array_equal(force, np.tile(0.5 * own, (3, 1)))
    with pytest.raises(BadInput, match=f"unknown parameter 't{count + 1}'"):
        gain(**{f"t{count + 1}": 0.5})


def test_a_thruster_has_its_number_and_not_its_name():
    gain = ThrusterGain.on(SimpleNamespace(thruster_names=("port", "all", "t1")))
    with pytest.raises(BadInput, match=r"'port' is no parameter.*Write t1"):
        gain(port=0.5)
    assert gain(t1=0.5, all=0.8).given() == {"t1": 0.5, "all": 0.8}


def test_gain_asymmetry_sag_and_deadband():
    plain = force()
    np.testing.assert_allclose(force(ThrusterGain(t2=-1.0, all=0.5))[:, 1], -0.5 * plain[:, 1])
    held = Commands(np.array([0.0]), np.tile([0.3, -0.3], (1, 4)), "thruster")
    uneven = force(ThrustAsymmetry(ratio=0.7), commands=held)
    np.testing.assert_allclose(uneven[:, 1] / uneven[:, 0], -0.7)
    fading = force(VoltageSag(fraction=0.2), commands=held)[:, 0]
    middle = 0.5 * (EDGES[1:] + EDGES[:-1])
    np.testing.assert_allclose(fading / force(commands=held)[:, 0], 1 - 0.2 * middle / 2.0)
    emptied = force(VoltageSag(fraction=0.5, rate=0.4), commands=held)[:, 0]
    left = np.maximum(0.0, 1 - 0.5 * middle / 2.0 - 0.4 * middle)
    np.testing.assert_allclose(emptied / force(commands=held)[:, 0], left, atol=1e-12)
    assert left[-1] == 0.0
    small = Commands(np.array([0.0]), np.tile([0.05, 0.051], (1, 4)), "thruster")
    dead = force(ThrusterDeadband(width=0.05), commands=small)
    assert np.all(dead[:, 0] == 0)
    np.testing.assert_allclose(dead[:, 1], force(commands=small)[:, 1])


@given(exponent=st.floats(0.2, 4.0))
def test_a_bent_curve_keeps_its_ends_and_its_sign(exponent):
    path = model(CurveExponent(exponent=exponent)).thrust_path
    command = np.repeat(np.linspace(-1.0, 1.0, 21)[:, None], 8, axis=1)
    nominal = path.thrusters.static_force(command)
    found, full = path.static(command, np.zeros(21), 1.0), nominal[-1]
    np.testing.assert_allclose(found[[0, 10, -1]], [-full, 0.0 * full, full], atol=1e-12)
    # the equation of docs/catalogue.md, written out
    by_hand = np.sign(nominal) * full * (np.abs(nominal) / full) ** exponent
    np.testing.assert_allclose(found, by_hand, atol=1e-9)


def test_a_curve_of_unequal_ends_is_bent_about_each_of_them():
    force, full = np.array([[-8.0, 4.0]]), np.array([[-16.0, -16.0], [40.0, 40.0]])
    expected = [-16.0 * 0.5**2, 40.0 * 0.1**2]
    np.testing.assert_allclose(CurveExponent(exponent=2.0).reshaped_force(force, full)[0], expected)
    assert CurveExponent(exponent=2.0).reshaped_force(force, 0.0 * full).tolist() == [[0.0, 0.0]]


def test_the_order_of_stages_is_fixed():
    effects = [
        CurveExponent(exponent=1.3),
        ThrusterGain(all=-0.8),
        ThrustAsymmetry(ratio=0.6),
        VoltageSag(fraction=0.1),
    ]
    np.testing.assert_allclose(force(*effects), force(*reversed(effects)))


def test_demands_go_through_the_mixer_and_are_clipped():
    path = model().thrust_path
    demand = np.array([[0.6, 0.5, 0.0, 0.0, 0.0, 0.3]])
    found = path.over_steps(Commands(np.zeros(1), demand, "demand"), EDGES)
    mixed = np.clip(path.thrusters.mixing @ demand[0], -1, 1)
    np.testing.assert_allclose(found.force[0], path.thrusters.static_force(mixed))
    np.testing.assert_allclose(found.demand[0], demand[0])


@pytest.mark.parametrize("axis", range(6))
def test_every_mixer_row_pushes_along_its_axis(axis):
    """With a positive demand: catches the published table's wrong angle of thruster 4."""
    world, demand = model(), np.zeros((1, 6))
    demand[0, axis] = 0.3
    thrust = world.thrust_path.over_steps(Commands(np.zeros(1), demand, "demand"), EDGES)
    tau = world.body.B @ thrust.force[0]
    assert tau[axis] > 0
    others = np.delete(np.abs(tau[:3] if axis < 3 else tau[3:]), axis % 3)
    assert others.max() < 0.05 * tau[axis]


def test_propeller_torque_and_advance_loss_by_hand():
    B = model().body.B
    body = model(PropellerTorque(ratio=0.02)).body
    np.testing.assert_allclose(
        body.B[3:] - B[3:], 0.02 * (body.directions * body.spin[:, None]).T, atol=1e-12
    )
    assert model(AdvanceLoss(coefficient=0.3)).body.advance == 0.3


def test_columns_that_do_not_fit_are_refused():
    with pytest.raises(BadInput, match=r"7 command columns.*8 for commands of the kind pwm"):
        force(commands=log(np.zeros((3, 7))))


def test_a_common_gain_is_common_to_any_number_of_thrusters():
    vehicle = model().vehicle.model_dump()
    vehicle["thrusters"]["units"] += (vehicle["thrusters"]["units"][0],)
    rows = vehicle["thrusters"]["mixer"]
    vehicle["thrusters"]["mixer"] = {axis: (*row, 0.0) for axis, row in rows.items()}
    world = nominal(Vehicle.model_validate(vehicle)) + ThrusterGain(all=0.5)
    commands = Commands(np.zeros(1), np.full((1, 9), 0.3), "thruster")
    thrust = world.thrust_path.over_steps(commands, EDGES).force[0]
    np.testing.assert_allclose(thrust, thrust[0])


@pytest.mark.parametrize("between", ["held", "linear"])
@pytest.mark.parametrize("kind", ["thruster", "demand", "wrench"])
def test_many_steps_are_taken_in_parts_and_say_the_same(monkeypatch, kind, between):
    value = sticks() if kind == "thruster" else 0.5 * sticks()[:, :6]
    commands = Commands(np.linspace(0.1, 1.7, len(value)), value, kind)
    path = model(InputDelay(delay=0.05), VoltageSag(fraction=0.2)).thrust_path
    whole = path.over_steps(commands, EDGES, between)
    monkeypatch.setattr("rovsim.dynamics.actuation.STEPS_PER_BATCH", 17)
    parts = path.over_steps(commands, EDGES, between)
    for name in ("force", "wrench", "demand"):
        np.testing.assert_array_equal(getattr(parts, name), getattr(whole, name))
