"""Runs that differ in one effect are said to, with the value of each."""

from pathlib import Path

import pytest
import yaml

from rovsim.benchmarks.blind.asking import diagnosis
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effect_entry import EffectEntry
from rovsim.reporting.words.unexplained import unexplained_sentences
from rovsim.simulation.synthetic_tank.campaign import make_campaign
from rovsim.simulation.synthetic_tank.settings import TankRun, TankSettings

RUNS = tuple(
    TankRun(id=name, control="6dof", split=split)
    for name, split in (("a", "train"), ("b", "train"), ("c", "test"))
)


def make(folder: Path, hidden: tuple[EffectEntry, ...] = ()) -> Path:
    settings = TankSettings(name="apart", seed=5, duration=20.0, runs=RUNS, effects=hidden)
    make_campaign(settings, folder, built_in())
    return folder


def delay_second_run(raw: Path, late: float) -> None:
    """Set the clock of its log: the vehicle then seems to follow `late` seconds later."""
    content = yaml.safe_load((raw / "campaign.yaml").read_text())
    content["runs"][1]["commands_shift_s"] = -late
    (raw / "campaign.yaml").write_text(yaml.safe_dump(content))


def test_a_log_whose_clock_was_set_anew_is_not_one_delay_for_all(tmp_path):
    raw, late = make(tmp_path / "raw"), 0.1
    delay_second_run(raw, late)
    found = diagnosis(raw, tmp_path)
    assert found.verdict == "unexplained"
    delays = {run: one.parameters["delay"] for run, one in found.unexplained.between_runs.items()}
    assert {one.effect for one in found.unexplained.between_runs.values()} == {"input_delay"}
    for run, truth in {"a": 0.0, "b": late}.items():
        assert delays[run].value == pytest.approx(truth, abs=4.0 * delays[run].std)
    assert "Runs differ in input_delay" in found.unexplained.hint
    assert "commands_shift_s" in found.next_experiment
    told = " ".join(unexplained_sentences(found))
    assert "As if input_delay had another value in each run: delay" in told
    # a mean of both delays would be wrong in every test run
    assert all(s.probability is None for s in found.selected if s.effect == "input_delay")
    assert found.error.with_effects <= 1.02 * found.error.nominal


@pytest.mark.thorough
def test_runs_differ_while_a_current_wanders_as_well(tmp_path):
    """A lag that is kept takes a part of both delays: what they differ by is told."""
    hidden = EffectEntry(effect="current_drift", parameters={"rate": 0.03})
    raw, late = make(tmp_path / "raw", (hidden,)), 0.1
    delay_second_run(raw, late)
    found = diagnosis(raw, tmp_path)
    assert found.verdict == "unexplained"
    first, second = (one.parameters["delay"] for one in found.unexplained.between_runs.values())
    assert second.value - first.value == pytest.approx(late, abs=0.01)


def test_a_delay_that_all_runs_have_is_one(tmp_path):
    hidden = EffectEntry(effect="input_delay", parameters={"delay": 0.1})
    found = diagnosis(make(tmp_path / "raw", (hidden,)), tmp_path)
    assert found.verdict == "missing_effects"
    assert [one.effect for one in found.selected] == ["input_delay"]
    assert found.unexplained.between_runs is None
