"""The tutorial of the next flight: two rivals, one flight, one name; and what a flight promises."""

import json
import shlex
from pathlib import Path

import numpy as np
import pytest

from pages import fenced
from rovsim.application.configuration import compose
from rovsim.application.pipeline.design import design
from rovsim.application.pipeline.measured_campaign import measure, open_campaign
from rovsim.apps.cli.main import main
from rovsim.apps.workbench import tasks
from rovsim.core.files import read_json
from rovsim.core.run import Commands
from rovsim.core.yaml_files import read_yaml
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effects.damping import LinearDamping
from rovsim.dynamics.model import nominal
from rovsim.estimation.fit import fit, polish
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.least_squares import gram
from rovsim.estimation.observer.noise import FIRST_NOISE
from rovsim.estimation.observer.train_runs import prepare_train
from rovsim.measurement.campaign_file import CommandLog
from rovsim.measurement.recording.commands import as_commands, as_logged
from rovsim.results.experiment import Experiment
from rovsim.simulation.rest import PLACEMENT_STD_M
from rovsim.simulation.synthetic_tank.sent_log import read_sent_log
from said import unfolded
from sketches import draw_few

ROOT = Path(__file__).parents[2]
TUTORIAL = ROOT / "docs" / "tutorial_next_flight.md"
KNOWN = "linear_damping.sway"
SHORTER = ("seconds=20", "design.population=8", "design.rounds=1")
FEWER = {"FREQUENCY_GRID": (0.12, 0.5), "SQUARE_GRID": (0.0,), "AMPLITUDE_GRID": (0.6,),
         "IN_PLANE": (0.1, 0.3), "OUT_OF_PLANE": (0.05, 0.2)}  # fmt: skip


PLANNED = []  # questions of the command, and what it found


def keep(data, model, question, catalogue):
    """Plan, and keep the plan for a test that need not plan again."""
    PLANNED.append((question, design(data, model, question, catalogue)))
    return PLANNED[-1][1]


def commands() -> list[str]:
    """Lines of the shell blocks."""
    blocks = fenced(TUTORIAL.read_text(encoding="utf-8"), "sh")
    return [line for block in blocks for line in block.splitlines()]


@pytest.fixture(scope="module")
def designed(tmp_path_factory):
    """What the tutorial leaves behind: `before`, `found`, `plan`, `after`, `surer`."""
    out = tmp_path_factory.mktemp("a flight, (of é)")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(out)
        for name, few in FEWER.items():
            patch.setattr(f"rovsim.design.search.{name}", few)
        patch.setattr("rovsim.apps.cli.commands.design.design", keep)
        draw_few(patch)
        patch.setattr("rovsim.apps.cli.commands.diagnose.installed", lambda name: False)
        for line in commands():
            words = shlex.split(line)[1:]
            if not line.startswith("cat"):
                main([*words, "--quiet", *(SHORTER if words[0] == "design" else ())])
    return out


def test_two_rivals_become_one_name(designed):
    found, surer = (read_json(designed / x / "diagnosis.json") for x in ("found", "surer"))
    asked = read_json(designed / "plan" / "experiment.json")
    (unsure,) = found["selected"]
    assert unsure["effect"] in asked["between"]
    assert unsure["probability"] < 0.9
    assert asked["between"] == ["linear_damping", "quadratic_damping"]
    odds = asked["expects"]["odds"]["linear_damping"]
    assert 0.05 < odds["now"] < 20.0 < odds["then"]
    (own,) = surer["selected"]
    assert own["probability"] > 0.999
    (hidden,) = read_yaml(designed / "after" / "truth.yaml")["effects"]
    assert own["effect"] == hidden["effect"] == "linear_damping"
    value, true = own["parameters"]["sway"], hidden["parameters"]["sway"]
    assert value["value"] == pytest.approx(true, abs=4 * value["std"])
    promised = asked["expects"]["std"][KNOWN]
    assert value["std"] == pytest.approx(promised["then"], rel=0.5)


def test_the_workbench_writes_what_the_command_writes(designed, tmp_path, monkeypatch):
    """Its job with the plan that the command made, for the same question."""
    [(question, found)] = PLANNED

    def planned(data, model, asked, catalogue):
        assert (data.campaign.name, model.name, asked) == ("rivals", "nominal", question)
        return found

    monkeypatch.setattr("rovsim.application.pipeline.design.design", planned)
    settings = compose([f"campaign='{designed / 'before'}'", *SHORTER])
    assert tasks.design_into(settings, question, tmp_path / "out") == tmp_path / "out"
    for path in (designed / "plan").glob("*.[cjt]*"):
        assert (tmp_path / "out" / path.name).read_bytes() == path.read_bytes()


def observed(folder):
    """The vehicle's model, and the train runs as a diagnosis sees them."""
    settings = compose([])
    data = measure(open_campaign(str(folder)), settings.signals)
    base = nominal(data.vehicle)
    runs = list(prepare_train(data.runs, settings.replay, built_in(), base.body.free).runs)
    return base, {run.motion.run.id: run for run in runs}


def test_it_writes_the_contract(designed):
    plan = designed / "plan"
    found = read_json(plan / "experiment.json")
    assert found["schema"] == "rovsim.experiment/1"
    assert found["seconds"] == 20.0
    assert set(found["expects"]) == {"odds", "std"}
    assert set(found["baselines"]) == {"zigzag", "steps", "multisine", "prbs"}
    assert found["expects"]["std"][KNOWN]["then"] < found["expects"]["std"][KNOWN]["now"]
    names = {"experiment.csv", "experiment.json", "experiment.png", "experiment.pdf"}
    assert {path.name for path in plan.iterdir()} == names | {"instructions.txt"}
    assert Experiment.read(plan / "experiment.json").to_json() == json.loads(json.dumps(found))


def test_its_log_is_flown_as_it_is_and_stays_within_the_limits(designed):
    base, runs = observed(designed / "after")
    assert set(runs) == {"first", "designed"}
    motion = runs["designed"].motion
    sent = np.loadtxt(designed / "plan" / "experiment.csv", delimiter=",", skiprows=1)
    logged = np.searchsorted(sent[:, 0], motion.commands.time + 1e-6) - 1
    np.testing.assert_allclose(motion.commands.value, (sent[logged, 1:] - 1500.0) / 400.0)
    assert np.max(np.abs(motion.commands.value)) <= base.vehicle.thrusters.command_limit
    limits = compose([]).design.limits
    place, walls = motion.eta[motion.usable, :3], motion.site.tank
    assert np.all(place > walls[:, 0] + limits.clearance)
    assert np.all(place < walls[:, 1] - limits.clearance)
    assert np.max(np.abs(motion.nu[motion.usable, :3])) < limits.speed


def test_without_the_flight_the_other_runs_are_the_same(designed):
    raw, flown = designed / "before", designed / "after"
    for path in [*raw.glob("first*"), *raw.glob("proof*")]:
        assert path.read_bytes() == (flown / path.name).read_bytes()
    (own,) = [run for run in read_yaml(flown / "campaign.yaml")["runs"] if run["id"] == "designed"]
    assert own["split"] == "train"


def test_the_information_that_was_promised_is_found_in_the_flight(designed):
    """Less noise and chance: the derivatives along the path that was flown, not the one planned."""
    base, runs = observed(designed / "after")
    start = Hypothesis(base, (Term(LinearDamping(), ("sway",)),))
    train = [runs["first"]]
    bank = FilterBank.design(train, start.model, FIRST_NOISE)
    found, _ = polish(fit(start, bank, FIRST_NOISE), train)

    def held(some):
        bank = FilterBank.design(some, found.hypothesis.model, found.noise)
        rows = bank.flatten(bank.linearise(found.hypothesis).J, found.noise)
        return float(gram(rows)[0, 0])

    before = held(train)
    promised = read_json(designed / "plan" / "experiment.json")["expects"]["std"][KNOWN]
    gained = held([*train, runs["designed"]]) / before - 1.0
    assert gained == pytest.approx(promised["gained"], rel=0.3)
    scale = start.terms[0].parameters[0].scale
    assert promised["now"] == pytest.approx(scale / np.sqrt(before), rel=0.1)


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ((), "nothing is asked"),
        (("between=[thruster_lag]",), "two different effects"),
        (("know=[thruster_lag.time]",), "Known: time_constant"),
        (("know=[onboard_control.gain_yaw]",), "cannot show"),
        (("seconds=1", "know=[thruster_lag.time_constant]"), "seconds"),
    ],
)
def test_questions_that_make_no_sense_are_explained(designed, tmp_path, capsys, asked, message):
    with pytest.raises(SystemExit) as ended:
        main(["design", f"campaign={designed / 'before'}", f"out={tmp_path / 'o'}", *asked])
    assert ended.value.code == 2
    text = unfolded(capsys.readouterr().err)
    assert message in text
    assert not (tmp_path / "o").exists()


LOGS = [
    {"kind": "pwm", "columns": ["a", "-b", "c"], "angles": ["c"]},
    {"kind": "normalized", "columns": ["a", "-b"]},
    {"kind": "demand", "columns": ["yaw", "-surge"]},
    {"kind": "wrench", "columns": ["-heave", "sway"]},
]


@pytest.mark.parametrize("log", LOGS, ids=lambda log: log["kind"])
def test_what_a_log_would_hold_is_read_back(log):
    log = CommandLog(format="csv", **log)
    shape = (5, 6) if log.per_axis else (5, len(log.columns))
    value = np.round(400.0 * np.random.default_rng(0).uniform(-1, 1, shape)) / 400.0
    if log.per_axis:
        value[:, [k for k in range(6) if k not in log.axis_numbers]] = 0.0
    kind = as_commands(
        np.arange(5.0),
        as_logged(Commands(np.arange(5.0), value, "thruster"), log),
        log,
        lambda line, column: "",
    )
    np.testing.assert_allclose(kind.value, value)


def test_a_flight_without_a_file_beside_it_starts_in_the_middle(designed, tmp_path):
    log = CommandLog(format="csv", kind="pwm", columns=[f"t{k}" for k in range(1, 9)])
    plan, alone = designed / "plan" / "experiment.csv", tmp_path / "mine.csv"
    alone.write_text(plan.read_text())
    walls, draws = np.array([[0.0, 10.0], [-5.0, 0.0], [-3.0, 0.0]]), np.random.default_rng
    start = read_json(designed / "plan" / "experiment.json")["start"]
    placed = np.array([start["x_m"], -start["y_m"], -start["z_m"]])
    for path, expected in ((plan, placed), (alone, walls.mean(axis=1))):
        begin = read_sent_log(path, log, up=True).start(walls, draws(0))
        np.testing.assert_allclose(begin[:3], expected, atol=4 * PLACEMENT_STD_M)
