"""Every file that is written for another simulator moves as the engine does, or says why not."""

import json
import re
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
import yaml

from exported import READERS
from rovsim.application.export.equation import Equation
from rovsim.application.export.holding import leave_out
from rovsim.application.export.sizes import size_all, typical_flight
from rovsim.application.export.targets import target, targets
from rovsim.application.export.write import represent
from rovsim.apps.cli.main import main
from rovsim.core.errors import BadInput
from rovsim.core.run import Commands, Site
from rovsim.core.shipped import conf_names
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.engine.types import NO_MEMORY
from rovsim.dynamics.model import nominal
from rovsim.dynamics.model_file import write_model
from rovsim.dynamics.vehicle import load_vehicle
from rovsim.simulation.batch import Batch
from rovsim.simulation.drive import Drive
from said import unfolded
from worlds import beside_others, model, some

EVERY = pytest.mark.parametrize("name", sorted(targets()))
SAME = {"rtol": 1e-6, "atol": 1e-6}  # N and N m


def draw(world, count, seed=0):
    """States (n, 13) at any attitude, and commands (n, c) of a vehicle."""
    random = np.random.default_rng(seed)
    attitude = random.normal(size=(count, 4))
    attitude /= np.linalg.norm(attitude, axis=1)[:, None]
    nu = random.normal(size=(count, 6)) * [1.0, 0.7, 0.7, 0.8, 0.8, 0.8]
    states = np.hstack([random.normal(size=(count, 3)), attitude, nu * world.body.free])
    commands = random.uniform(-1.0, 1.0, (count, world.thrust_path.columns("thruster")))
    return states, commands


def static(world, commands):
    """Thrust of commands (n, c), each for itself."""
    return world.thrust_path.at(Commands(np.zeros(len(commands)), commands, "thruster"), 0.0, 1.0)


def accelerate(world, states, commands):
    """What the engine makes of them (n, 6)."""
    drive = Drive.by(world, static(world, commands), 1.0)
    return Batch([world], Site.unknown(), learned=False).accelerations(
        drive, np.zeros(len(states)), states, NO_MEMORY
    )


def forces(world, name, count):
    """Generalized force (n, 6) of the written file, and of the engine for what it holds."""
    chosen = target(name)
    held, left = represent(world, chosen)
    states, commands = draw(world, count)
    equation = Equation(held)
    moves = READERS[name](chosen.text(equation, ["a note -- with hyphens"]))
    pulls = static(held, commands).force * equation.reach
    written = np.array([moves(*row) for row in zip(states, commands, pulls, strict=True)])
    inertia = held.body.M_RB + held.body.M_A
    expected = accelerate(held, states, commands) @ inertia.T
    for one in left:
        if one.missing is not None:
            expected = expected - one.missing(held, states)
    return written @ inertia.T, expected, left


RICH = {  # what each of them can hold, together; values of no meaning
    "payload": {"mass": 1.3, "x": 0.1, "y": -0.07, "z": 0.05},
    "net_buoyancy": {"force": 12.0},
    "buoyancy_center": {"x": 0.01, "y": 0.02, "z": -0.03},
    "added_mass": {"surge": 3.0, "sway": 5.0, "yaw": 0.2},
    "added_mass_coupling": {"sway_yaw": 0.4, "surge_pitch": -0.3, "heave_roll": 0.2},
    "coupled_damping": {"yaw_from_sway": 3.0, "heave_from_surge_quadratic": -5.0},
    "lift": {"coefficient": 40.0},
    "cubic_damping": {"surge": 9.0, "yaw": 0.3},
    "dry_friction": {"sway": 1.0},
    "constant_wrench": {"surge": 1.0, "roll": -0.2},
    "current": {"north": 0.2, "east": -0.1, "down": 0.05},
    "advance_loss": {"coefficient": 0.3},
    "propeller_torque": {"ratio": 0.03},
    "thruster_order": {"first": 2.0, "second": 5.0},
    "thruster_deadband": {"width": 0.1},
    "force_curve": {"exponent": 1.3},
    "thruster_gain": {"t3": -0.5, "all": 0.9},
    "thrust_asymmetry": {"ratio": 0.7},
}


@EVERY
def test_a_written_model_pushes_as_the_engine_does_at_1000_states(name):
    known = built_in()
    world = model(*(known[effect](**values) for effect, values in RICH.items()))
    written, expected, _ = forces(world, name, 1000)
    np.testing.assert_allclose(written, expected, **SAME)


@EVERY
@pytest.mark.parametrize("cls", built_in().values(), ids=lambda cls: cls.id)
def test_each_effect_is_held_whole_or_named(name, cls):
    effect = some(cls)
    world = beside_others(effect)
    written, expected, left = forces(world, name, 5)
    np.testing.assert_allclose(written, expected, **SAME)
    named = {one.name.split()[0] for one in left}
    assert cls.id in named or target(name).hold(effect) == (effect, "")


@EVERY
@pytest.mark.parametrize("vehicle", conf_names("vehicle"))
def test_every_vehicle_is_written_or_refused_in_words(name, vehicle):
    world = nominal(load_vehicle(vehicle))
    if name in ("gz", "stonefish") and vehicle == "cybership2":  # a ship in the plane
        with pytest.raises(BadInput, match="holds axes"):
            represent(world, target(name))
        return
    written, expected, left = forces(world, name, 20)
    np.testing.assert_allclose(written, expected, rtol=1e-6, atol=1e-4)  # of up to 10 kN
    assert all(one.why for one in left)


@EVERY
def test_a_battery_is_left_out_in_words(name):
    world = nominal(load_vehicle("bluerov2_heavy_t200"))
    _, left = represent(world, target(name))
    why = {one.name: one.why for one in left}
    assert why["thrusters"] == "thrust is that at 16 V, whatever the battery has"
    one = next(one for one in left if one.name == "thrusters")
    command = np.linspace(-1.0, 1.0, 21)[:, None] * np.ones(8)
    full, flat = np.full(21, 16.0), np.full(21, 12.0)
    before, after = (m.thrust_path.thrusters for m in (one.before, one.after))
    np.testing.assert_allclose(
        after.static_force(command, flat), before.static_force(command, full)
    )
    assert np.abs(before.static_force(command, flat) - after.static_force(command)).max() > 5.0


@EVERY
def test_the_page_and_the_reader_know_it(name):
    page = (Path(__file__).parents[2] / "docs" / "export.md").read_text(encoding="utf-8")
    assert f"`{name}`" in page
    assert name in READERS


HOSTILE = "a\nsystem('id')\r\u2028\x1b\x85---\udcff%{\uffff\"'<&]]>"


@EVERY
def test_a_name_cannot_leave_the_place_it_stands_in(name):
    world = model()
    units = list(world.vehicle.thrusters.units)
    units[0] = units[0].model_copy(update={"name": HOSTILE})
    layout = world.vehicle.thrusters.model_copy(update={"units": tuple(units)})
    vehicle = world.vehicle.model_copy(update={"name": HOSTILE, "thrusters": layout})
    hostile = replace(world, name=HOSTILE, vehicle=vehicle)
    chosen = target(name)
    plain = chosen.text(Equation(world), [world.name])
    text = chosen.text(Equation(hostile), [HOSTILE])
    READABLE[chosen.suffix](text, plain)


def _same_lines(text, plain):
    assert not re.search(r"^\s*system", text, re.MULTILINE)
    assert len(text.splitlines()) == len(plain.splitlines())


def _same_name(text, plain):
    _same_lines(text.partition("name: ")[0], plain.partition("name: ")[0])
    assert yaml.safe_load(text)["name"] == HOSTILE


def _is_xml(text, _):
    ElementTree.fromstring(text)


READABLE = {".m": _same_lines, ".yaml": _same_name, ".scn": _is_xml, ".sdf": _is_xml}


def test_what_is_left_out_is_as_large_as_its_force():
    known = built_in()
    world = model(known["constant_wrench"](surge=3.0, yaw=-0.5), known["marker_offset"](x=0.1))
    left = list(leave_out(world, target("gz").hold))
    sized = {one.name: one.rms for one in size_all(left, [typical_flight(world)])}
    np.testing.assert_allclose(sized["constant_wrench"], [3.0, 0, 0, 0, 0, 0.5], atol=1e-9)
    assert not any(sized["marker_offset"])


def test_the_file_and_the_terminal_list_what_is_left_out(tmp_path, capsys):
    path, out = tmp_path / "my model.yaml", tmp_path / "vehicle.sdf"
    write_model(model(built_in()["thruster_lag"](time_constant=0.2)), path)
    main(["export", f"model={path}", "to=gz", f"out={out}"])
    told = capsys.readouterr().out
    assert re.search(r"thruster_lag: [1-9][.0-9]* N \(s\w+\), 0\.\d+ N m", told)
    assert max(map(len, told.splitlines())) <= 80 or str(tmp_path) in told
    assert "thruster_lag: " in out.read_text()
    main(["export", "model=nominal", "to=fossen", f"out={out}", "--json"])
    assert json.loads(capsys.readouterr().out)["left_out"] == []
    assert "Nothing of the model is left out" in out.read_text()


def test_the_terminal_says_which_model_was_written(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    main(["export", "to=fossen"])
    assert "nominal.yaml: the nominal model of bluerov2_heavy" in unfolded(capsys.readouterr().out)
    write_model(model(built_in()["lift"](coefficient=9.0)), tmp_path / "lifted.yaml")
    main(["export", "model=lifted.yaml", "to=gz"])
    assert "lifted.sdf: the model lifted" in unfolded(capsys.readouterr().out)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["to=gazebo"], "unknown simulator 'gazebo'"),
        (["to=stonefsh"], "Did you mean 'stonefish'"),
        ([], "no simulator was named"),
        (["to=gz", "model=[a,b]"], "one model"),
        (["to=gz", "model=zero_acceleration"], "keeps its velocity"),
        (["to=mss", "model=nowhere.yaml"], "no such file"),
    ],
)
def test_mistakes_are_explained_and_leave_nothing(words, message, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit) as ended:
        main(["export", *words])
    assert ended.value.code == 2
    assert message in unfolded(capsys.readouterr().err)
    assert list(tmp_path.iterdir()) == []
