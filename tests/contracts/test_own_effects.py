"""A user's own effect: the page that explains it works as printed, and mistakes are explained."""

import inspect
import json
import re
import shlex
from pathlib import Path

import pytest

from pages import fenced
from rovsim.application.study.dependencies import Dependencies
from rovsim.application.study.study import Study
from rovsim.apps.cli.main import main
from rovsim.core.errors import BadInput
from rovsim.diagnosis.apply import add_effects
from rovsim.dynamics.catalogue import load_catalogue
from rovsim.dynamics.effects import base
from rovsim.dynamics.effects.base import Effect
from rovsim.dynamics.user_effects.trials import TRIALS, try_on
from rovsim.dynamics.vehicle import load_vehicle
from rovsim.results.diagnosis import Diagnosis, ProposedEquation
from said import unfolded
from small_study import ROOT
from synthetic_study import diagnosis

PAGE = (Path(__file__).parents[2] / "docs" / "your_own_effect.md").read_text(encoding="utf-8")
VEHICLES = [path.stem for path in (ROOT / "conf" / "vehicle").glob("*.yaml")]


def blocks(kind):
    """Fenced blocks of the page of one kind."""
    return fenced(PAGE, kind)


@pytest.fixture(autouse=True)
def only_here(tmp_path, monkeypatch):
    """Files are written into a folder of the test's own."""
    monkeypatch.chdir(tmp_path)


def write_files():
    """The page's files, each called as its first line says."""
    for text in [*blocks("python"), *blocks("yaml")]:
        Path(text.split("\n")[0].removeprefix("# ")).write_text(text, encoding="utf-8")


@pytest.mark.usefixtures("few_figures")
def test_the_page_works_as_printed():
    write_files()
    commands = [line for text in blocks("sh") for line in text.replace("\\\n", " ").splitlines()]
    assert len(commands) == 4
    for command in commands:
        program, *words = shlex.split(command)
        assert program == "rovsim"
        main(words)
    error = errors("with_and_without", "heave")
    assert error["with_cushion"] < 0.02 < 0.05 < error["nominal"]
    assert Path("with_and_without/report.html").exists()
    error = errors("with_fin", "roll")
    assert error["with_fin"] < 0.5 * error["nominal"]


def errors(folder, axis):
    """Velocity error of each model in windows of 2 s."""
    models = json.loads(Path(folder, "comparison.json").read_text())["models"]
    return {
        name: models[name]["runs"]["6dof-2"]["windows"]["2"]["velocity_rmse"][axis]
        for name in models
    }


def test_a_proposed_law_is_added_where_its_file_is_named():
    write_files()
    found = Diagnosis.model_validate(diagnosis({"schema": "rovsim.ladder/1", "steps": []}))
    own = {
        "strength": {"value": 3.0, "std": 0.1, "unit": "N"},
        "height": {"value": 0.7, "unit": "m"},
    }
    proposal = ProposedEquation(
        axis="heave",
        equation="",
        file="floor_cushion.py",
        parameters=own,
        error_reduction=0.5,
        effect="floor_cushion",
        meaning="",
        terms=(),
        beside=found.selected[1:],
    )
    left = found.unexplained.model_copy(update={"proposal": proposal})
    found = found.model_copy(update={"unexplained": left})
    source, named = Path("diagnosis.json"), load_catalogue([Path("floor_cushion.py")])
    plain, with_law = (
        add_effects(found, source, "nominal", None, known) for known in (load_catalogue(), named)
    )
    assert plain[1] == ["thruster_lag", "quadratic_damping"]
    assert with_law[1] == ["quadratic_damping", "floor_cushion"]
    assert with_law[0].added[-1].given() == {"strength": 3.0, "height": 0.7}


def test_a_file_counts_only_where_it_is_named():
    write_files()
    first = load_catalogue([Path("floor_cushion.py")])["floor_cushion"]
    assert first(strength=1.0).given() == {"strength": 1.0}
    again = load_catalogue([Path("floor_cushion.py")])
    assert again["floor_cushion"] is first  # so that nothing is compiled twice
    with pytest.raises(BadInput, match="effects_file"):
        load_catalogue().find("floor_cushion")


def test_the_study_takes_it_and_sees_edits():
    write_files()
    study = Study({"effects_file": "floor_cushion.py"})
    assert study.catalogue.files == (Path("floor_cushion.py"),)
    assert "floor_cushion" in study.catalogue
    depends = Dependencies(study)
    replay, smooth = (ROOT / "workflow" / "scripts" / f"{name}.py" for name in ("replay", "filter"))
    before = {script: depends.code(script) for script in (replay, smooth)}
    text = Path("floor_cushion.py").read_text()
    Path("floor_cushion.py").write_text(f"# a comment changes nothing\n{text}")
    assert depends.code(replay) == before[replay]
    Path("floor_cushion.py").write_text(text.replace("scale=3.0", "scale=2.0"))
    assert depends.code(replay) != before[replay]
    assert depends.code(smooth) == before[smooth]
    assert Study({}).catalogue.files == ()


COMPLETE = """
from rovsim.dynamics.effects.base import Coefficients, Parameter, Wrench

class Hose(Wrench):
    "A hose drags behind."
    id = "hose"
    equation, neglects, source = "X = -c", "all else", "a test"
    parameters = (Parameter("force", "N", "c", scale=1.0),)

    @staticmethod
    def wrench(at, p):
        return -p.force, 0.0, 0.0, 0.0, 0.0, 0.0
"""
BAD = {  # what is replaced, by what: what the message says
    ("class Hose(Wrench):", "class Hose(Wrench"): r"hose.py, line 4: .*never closed",
    ("Wrench\n\nclass Hose(Wrench)", "Effect\n\nclass Hose(Effect)"): "acts nowhere.*another kind",
    ("from rovsim", "from rovsinn"): r"line 2: ModuleNotFoundError",
    ("class Hose(Wrench)", "class Hose"): "declares no effect",
    ('    "A hose drags behind."\n', ""): "has no 'docstring'",
    ("equation, neglects, source =", "equation, neglects, other ="): "has no 'source'",
    ("def wrench", "def wrnch"): "has no 'wrench'",
    ("    @staticmethod\n", ""): "no @staticmethod",
    ('id = "hose"', 'id = "lift"'): "id 'lift' is taken",
    ('id = "hose"', 'id = "Hose 2"'): "lower-case",
    ('(Parameter("force", "N", "c", scale=1.0),)', "()"): "has no 'parameters'",
    ('(Parameter("force", "N", "c", scale=1.0),)', '("force",)'): "tuple of Parameter",
    (", scale=1.0", ""): r"line 8: TypeError: .*scale",
    ("scale=1.0", "scale=-1.0"): "scale above 0",
    ('"force", "N"', '"my force", "N"'): "parameter 'my force'",
    ("p.force", "p.farce"): "does not compile: Unknown attribute 'farce'.*Did you mean 'force'",
    ("-p.force", "-unknown"): "does not compile: NameError: name 'unknown'",
    ("-p.force", "'much'"): "returns",
    ("-p.force, 0.0,", "-p.force,"): "six numbers",
    ("Hose(Wrench)", "Hose(Coefficients)"): "has no 'enter'",
    ("scale=1.0),)", "scale=1.0))"): "tuple of Parameter",  # the comma that makes a tuple
    ("scale=1.0", "scale='10'"): "and numbers",
    ("scale=1.0", "scale=1.0, low=0.0, tried=(-1.0,)"): "tries .*in its range",
    ("scale=1.0", "scale=1.0, tried=('0.1',)"): "tries .*in its range",
    ('"N", "c"', 'None, "c"'): "texts for name, unit",
    ('"N", "c"', '"", "c"'): "'1' for none",
    ("scale=1.0", "scale=1.0, fitted=False"): "no parameter is fitted",
    ('id = "hose"', 'id = "hose"; requires = "thruster"'): "'requires' is 'thruster'.*thrusters",
    ('id = "hose"', 'id = "hose"; starts = ()'): r"'starts' is \(\)",
    ('id = "hose"', 'id = "hose"; starts = ({"force": 1.0})'): "'starts' is .*tuple of mappings",
    ('id = "hose"', 'id = "hose"; starts = ({"farce": 1.0},)'): "'starts' names farce",
    ('id = "hose"', 'id = "hose"; symbols = ("Y", "force")'): "'symbols' is .*tuple of pairs",
    ('id = "hose"', 'id = "hose"; telling = ("farce",)'): "'telling' is .*: force",
    ('id = "hose"', 'id = "hose"; channels = ("voltage")'): "'channels' is 'voltage'",
    ("        return -p.force", "        import math\n        return -p.force"): "does not compile",
    (
        'equation, neglects, source = "X = -c"',
        'equation, neglects, source = " "',
    ): "'equation' is empty",
    ('id = "hose"', 'id = "hose"; starts = ({"force": "1"},)'): "'starts' has force at '1'",
    ('id = "hose"', 'id = "hose"; cause = 3'): "'cause' is 3.*a sentence",
    ('id = "hose"', 'id = "hose"; rank = "1"'): "'rank' is '1'.*a number",
    ("scale=1.0", "scale=float('inf')"): "finite scale",
    ("class Hose", "raise SystemExit(3)\nclass Hose"): "line 4: SystemExit: 3",
    ("        return", "        assert at.nu[0] < 9.0\n        return"): r"asserts \(line 12\)",
    ("        return", "        print(at.nu[0])\n        return"): "'wrench' prints",
    ("-p.force", "1j * p.force"): "'wrench' returns .*six numbers",
    ("-p.force", "at.channels.volts"): r"Unknown attribute 'channels' \(line.*Declare 'chann",
    ("-p.force", "at.nu_rel[0]"): "Unknown attribute 'nu_rel'.*Did you mean 'nu_r'",
    ("-p.force", "at.actuators.farce[0]"): "Unknown attribute 'farce'.*Did you mean 'force'",
    ("-p.force", "1.0 - p.force"): "hose.py, effect hose: 'wrench' returns 1.0.*default values",
    ("-p.force", "p.force * at.nu[6 + int(at.t > 9.0)]"): "out of",
}


@pytest.mark.parametrize("change", BAD)
def test_a_mistake_is_one_message(change, tmp_path, capsys):
    path = tmp_path / "hose.py"
    assert change[0] in COMPLETE
    path.write_text(COMPLETE.replace(*change))
    with pytest.raises(SystemExit) as ended:
        main(["tank", f"effects_file={path}", f"out={tmp_path / 'out'}"])
    text = unfolded(capsys.readouterr().err)
    assert ended.value.code == 2
    assert re.search(BAD[change], text), text
    assert "Traceback" not in text
    assert text.startswith("rovsim: ")
    assert text.count("rovsim: ") == 1
    assert not (tmp_path / "out").exists()


def test_a_function_that_math_lacks_is_named_with_the_one_meant():
    Path("hose.py").write_text(
        "import math\n" + COMPLETE.replace("-p.force", "-math.sine(p.force)")
    )
    with pytest.raises(BadInput, match=r"no attribute 'sine'.*Did you mean 'sin'"):
        load_catalogue([Path("hose.py")])


OTHER_KINDS = {  # kind, its method: what the message says
    ("Coefficients", "def enter(self, body): body.lineer[0] += 1"): "line 12: 'enter' fails",
    ("Coefficients", "def enter(self, body): body.linear = 1"): "'body.linear'.*as they are",
    ("Coefficients", "def enter(self, body): body.M_A[0] = math.nan"): "'body.M_A'.*finite",
    ("Coefficients", "def enter(self, body): body.M_A[0, 0] = -99"): "inertia is positive",
    ("StochasticCurrent", "def draw(self, ticks, dt, random): return 1"): "'draw' returns 1",
    ("CommandTiming", "def effective_time(self, time): return -time"): "increasing",
    ("DemandTransform", "def mixer_demand(self, demand): return demand[0]"): r"array \(6,\)",
    ("CommandTransform", "def thruster_command(self, command): pass"): "returns None",
    ("ThrustScaling", "def scaled_force(self, force, t): return force"): "TypeError",
    ("CommandTransform", "def thruster_command(self, command): command *= 2"): "line 12.*read-only",
    ("ThrustCurveShape", "def reshaped_force(self, force, full): return force / 0"): "NaN or inf",
    ("ThrusterDynamics", "def respond(self, force, h, state): return force"): "state to go on",
    ("FrameMisalignment", "def transforms(self): return 0.1"): "two Rigid",
    ("MeasurementFilter", "def time_constants(self): return 0.1"): "tuple of seconds",
    ("MeasurementFilter", "def time_constants(self): return (0.0,)"): "seconds above 0",
    (
        "Wrench",
        "@staticmethod\n    def wrench(at, p): return six(at.actuators.force[8])",
    ): "8 forces",
    (
        "Wrench",
        "@staticmethod\n    def wrench(at, p): return six(at.actuators.command[-9])",
    ): "8 com",
    (
        "Wrench",
        "@staticmethod\n    def wrench(at, p): return six(at.actuators.inflow[8][0])",
    ): "8 pl",
    (
        "Wrench",
        "@staticmethod\n    def wrench(at, p): return six(at.actuators.inflow[0][3])",
    ): "three numbers",
    (
        "Wrench",
        "@staticmethod\n    def wrench(at, p): return six(at.actuators.force[900])",
    ): "8 forces",
    (
        "Wrench",
        "@staticmethod\n    def wrench(at, p): return six(helped(at, 9))",
    ): "no such actuator.*8 forces",
    (
        "Wrench",
        "@staticmethod\n    def wrench(at, p): return six(at.t > 9.0 and at.actuators.force[9])",
    ): "out of bounds.*8 forces",
    (
        "Wrench",
        "@staticmethod\n    def wrench(at, p): return six(p.force * written(at))",
    ): "writes into at.actuators",
}
OTHER_KIND = """
import math
from rovsim.dynamics.effects import base
from rovsim.dynamics.compilation.compiled import inlined

class Hose(base.KIND):
    "A hose drags behind."
    id = "hose"
    equation, neglects, source = "X = -c", "all else", "a test"
    parameters = (base.Parameter("force", "N", "c", scale=1.0),)

    METHOD

@inlined
def six(x):
    return x, 0.0, 0.0, 0.0, 0.0, 0.0

@inlined
def helped(at, k):
    return at.actuators.force[k] if at.nu[0] > 0.1 else 0.0

@inlined
def written(at):
    at.actuators.force[0] = 9.0
    return 0.0
"""


@pytest.mark.parametrize("wrong", OTHER_KINDS, ids=lambda wrong: f"{wrong[0]}-{wrong[1][-9:]}")
@pytest.mark.filterwarnings("ignore:divide by zero", "ignore:invalid value")
def test_every_kind_is_tried_before_it_is_used(wrong):
    kind, method = wrong
    Path("hose.py").write_text(OTHER_KIND.replace("KIND", kind).replace("METHOD", method))
    known, vehicle = load_catalogue([Path("hose.py")]), load_vehicle("bluerov2_heavy")
    with pytest.raises(BadInput, match=OTHER_KINDS[wrong]):
        known.on(vehicle)


def test_what_rounding_leaves_is_no_push():
    water = COMPLETE.replace("-p.force,", "(at.nu[0] + 0.1 * (1.0 - p.force)) - at.nu[0] - 0.1,")
    Path("hose.py").write_text(water)
    assert "hose" in load_catalogue([Path("hose.py")]).on(load_vehicle("otter"))


def test_there_are_trials_of_every_kind():
    kinds = {cls for cls in vars(base).values() if inspect.isclass(cls) and issubclass(cls, Effect)}
    assert set(TRIALS) == kinds - {Effect}
    assert all(issubclass(cls, tuple(TRIALS)) for cls in load_catalogue().values())


@pytest.mark.parametrize("vehicle", VEHICLES)
def test_the_catalogue_passes_them_on_every_vehicle(vehicle):
    there = load_vehicle(vehicle)
    for cls in load_catalogue().on(there).values():
        try_on(cls, there)


def test_missing_files_and_twins_are_refused(tmp_path):
    with pytest.raises(BadInput, match="no such file"):
        load_catalogue([tmp_path / "none.py"])
    for name in ("a b.py", "b,c.py"):
        (tmp_path / name).write_text(COMPLETE)
    with pytest.raises(BadInput, match="'hose' is taken"):
        load_catalogue([tmp_path / "a b.py", tmp_path / "b,c.py"])
    assert "hose" in load_catalogue([tmp_path / "b,c.py"])


def test_a_misspelt_key_of_the_study_is_refused():
    with pytest.raises(BadInput, match=r"unknown key 'campain'.*Did you mean 'campaign'"):
        Study({"campain": "somewhere"}).check()
