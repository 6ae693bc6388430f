"""What every effect promises; a new effect is found here by itself."""

import numpy as np
import pytest

from rovsim.core.errors import BadInput
from rovsim.core.run import Site
from rovsim.core.yaml_files import write_yaml
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effects.base import (
    Autopilot,
    Coefficients,
    DemandTransform,
    Parameter,
    StochasticCurrent,
    Wrench,
)
from rovsim.dynamics.model_file import read_model, write_model
from rovsim.dynamics.vehicle import load_vehicle
from rovsim.simulation.replay import simulate
from rovsim.simulation.settings import ReplaySettings
from worlds import at_rest, beside_others, model, motion, some, sticks, tank

EVERY = pytest.mark.parametrize("cls", built_in().values(), ids=list(built_in()))


def driven(world):
    """What the motion capture reports of two flights that begin with opposite velocities.

    An effect may act in one direction alone.
    """
    nu = np.array([0.3, -0.2, 0.1, 0.2, -0.1, 0.3])
    starts = [np.concatenate([at_rest()[:7], sign * nu]) for sign in (1.0, -1.0)]
    demands = any(isinstance(effect, Autopilot | DemandTransform) for effect in world.effects)
    columns = world.thrust_path.columns("demand" if demands else "thruster")
    value, kind = sticks(1)[:, :columns], "demand" if demands else "thruster"
    run = motion(value, kind, seconds=1.0, start=starts[0], site=tank())
    spans = [(0, len(run.time) - 1, start) for start in starts]
    paths = simulate(world, run, spans, ReplaySettings())
    return np.concatenate([world.mocap_view.report(path, 0.01) for path in paths])


@EVERY
def test_it_says_what_it_is(cls):
    assert all([cls.__doc__, cls.equation, cls.neglects, cls.source, cls.parameters])
    assert all(p.unit and p.symbol for p in cls.parameters)
    assert all(p.low <= p.default <= p.high or np.isnan(p.default) for p in cls.parameters)
    assert all(0 < p.scale <= p.high - p.low for p in cls.parameters)


@EVERY
def test_it_says_what_causes_it_and_what_reveals_it(cls):
    for sentence in (cls.cause, cls.revealed_by):
        assert sentence[0].isupper()
        assert sentence.endswith(".")
        assert 30 < len(sentence) < 260


@EVERY
def test_a_fit_can_begin(cls):
    """Every start is valid; some parameter is fitted without being asked for, or all are tried."""
    assert any(p.fitted for p in cls.parameters) or {} not in cls.starts
    for site in (tank(), Site.unknown()):
        starts = cls.starts_at(site)
        assert len(starts) == len({tuple(sorted(start.items())) for start in starts}) > 0
        for start in starts:
            assert cls(**start).given() == {k: v for k, v in start.items() if v}


@EVERY
def test_defaults_change_nothing_and_values_do(cls):
    plain = driven(beside_others(None, cls))
    if not issubclass(cls, Autopilot | DemandTransform):  # which need another log
        np.testing.assert_allclose(driven(beside_others(cls())), plain, atol=1e-12)
    changed = np.abs(driven(beside_others(some(cls))) - plain).max() > 1e-6
    assert changed != issubclass(cls, StochasticCurrent)  # of which a model has the mean


class Astern(Wrench):
    """Drag that acts astern alone."""

    id = "astern"
    parameters = (Parameter("drag", "N s2/m2", "d", scale=10.0),)

    @staticmethod
    def wrench(at, p):
        """Against a motion astern."""
        u = min(at.nu_r[0], 0.0)
        return p.drag * u * u, 0.0, 0.0, 0.0, 0.0, 0.0


def test_what_acts_in_one_direction_alone_is_seen():
    np.testing.assert_allclose(driven(model(Astern())), driven(model()), atol=1e-12)
    assert np.abs(driven(model(Astern(drag=20.0))) - driven(model())).max() > 1e-6


@EVERY
def test_bad_values_are_refused_with_the_nearest_name(cls):
    name = cls.parameters[0].name
    with pytest.raises(BadInput, match=f"Did you mean '{name}'|Known"):
        cls(**{name + "x": 1.0})
    for wrong in (float("nan"), "much", True, None):
        with pytest.raises(BadInput, match=name):
            cls(**{name: wrong})


@EVERY
def test_a_model_file_keeps_it(cls, tmp_path):
    world = beside_others(some(cls))
    write_model(world, tmp_path / "m.yaml")
    again = read_model(tmp_path / "m.yaml", built_in())
    assert again.name == "m"
    assert [e.given() for e in again.effects] == [e.given() for e in world.effects]
    assert driven(again).tobytes() == driven(world).tobytes()


LACKING = {
    "bluerov2_heavy": {"surfaces", "waterplane"},
    "otter": {"surfaces"},
    "remus100": {"waterplane"},
    "hull": {"surfaces", "waterplane", "thrusters"},
}


@EVERY
@pytest.mark.parametrize("vehicle", LACKING)
def test_a_model_file_has_it_only_where_it_can_act(cls, vehicle, tmp_path):
    """Elsewhere it would do nothing, and nobody would notice."""
    hull = load_vehicle("bluerov2_heavy").model_dump(mode="json", by_alias=True)
    hull["thrusters"] |= {"units": [], "mixer": None}
    entry = {"effect": cls.id}
    vehicle_file = hull if vehicle == "hull" else vehicle
    write_yaml(tmp_path / "m.yaml", {"vehicle": vehicle_file, "effects": [entry]})
    if cls.requires not in LACKING[vehicle]:
        read_model(tmp_path / "m.yaml", built_in())
        return
    with pytest.raises(BadInput, match=f"m.yaml.*'{cls.id}' cannot act on a vehicle") as refusal:
        read_model(tmp_path / "m.yaml", built_in())
    assert f"in '{cls.requires}'" in refusal.value.remedy


def test_an_unknown_effect_names_the_nearest():
    with pytest.raises(BadInput, match="Did you mean 'thruster_lag'"):
        built_in().find("thruster_lg")


SIGNS = {  # effect, parameters: axis and sign of the first acceleration of a vehicle at rest
    ("net_buoyancy", "force"): (2, -1),
    ("payload", "mass"): (2, +1),
    ("current", "north"): (0, +1),
    ("constant_wrench", "yaw"): (5, +1),
}


@pytest.mark.parametrize(("name", "parameter"), SIGNS)
def test_it_pushes_the_right_way(name, parameter):
    axis, sign = SIGNS[name, parameter]
    run = motion(np.zeros((1, 8)), seconds=0.1)
    start = [(0, 10, at_rest())]
    with_it, without = (
        simulate(world, run, start, ReplaySettings())[0][-1, 7 + axis]
        for world in (model(built_in()[name](**{parameter: 0.5})), model())
    )
    assert sign * (with_it - without) > 0


def test_lift_and_tether_by_hand():
    from rovsim.dynamics.effects.lift import Lift
    from rovsim.dynamics.effects.tether import TetherTension
    from rovsim.dynamics.engine.types import At

    level = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    nu = (0.5, 0.2, -0.1, 0.0, 0.0, 0.0)
    at = At(0.0, 1.0, (1.0, -2.0, -1.0), level, *[nu] * 6, ((0, 1),) * 3, (1.0, -1.0, -1.0))
    assert Lift.wrench(at, Lift.named_parameters()(10.0)) == pytest.approx((0, -1, 0.5, 0, 0, 0))
    # anchor at MoCap (3, 2, 1) is NED (3, -2, -1): 2 m north of CO, 2.2 m from the attachment
    values = TetherTension(stiffness=3, slack_length=1.2, anchor_x=3, anchor_y=2, anchor_z=1).values
    pull = TetherTension.wrench(at, TetherTension.named_parameters()(*values))
    assert pull == pytest.approx((3.0, 0, 0, 0, 0, 0), abs=1e-12)


def test_kinds_are_used_as_declared():
    for cls in built_in().values():
        assert issubclass(cls, Coefficients) + issubclass(cls, Wrench) <= 1
