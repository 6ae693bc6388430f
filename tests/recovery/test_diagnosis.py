"""Hidden physics is named, with its values; nothing is named where nothing is hidden."""

import numba
import numpy as np
import pytest

from rovsim.benchmarks.blind.asking import bands, diagnosis
from rovsim.benchmarks.blind.flight import fly
from rovsim.benchmarks.blind.suites import combination, nothing, outside
from rovsim.core.yaml_files import read_yaml
from rovsim.results.diagnosis import Diagnosis
from worlds import SHARED, needed

PRACTICE = (
    "current", "mix-buoy-quad", "null-2", "quadratic_damping", "tether_tension", "thruster_lag",
    "unknown-pulse",
)  # fmt: skip


def named(found):
    return {one.effect: one.parameters for one in found.selected}


@pytest.mark.thorough
@pytest.mark.parametrize("name", PRACTICE)
def test_independent_exports_give_up_what_they_hide(name):
    folder = needed(SHARED / "practice" / name)
    answer = read_yaml(folder / "answer.yaml")
    found = diagnosis(folder, folder)
    assert found.verdict == answer["verdict"]
    if answer["verdict"] == "unexplained":
        assert found.unexplained.significant
        return
    truth = {e["effect"]: e["parameters"] for e in answer.get("effects", [])}
    assert set(named(found)) == set(truth)
    for effect, values in truth.items():
        for parameter, value in values.items():
            assert named(found)[effect][parameter].value == pytest.approx(value, rel=0.05)
    assert found.error.with_effects <= found.error.nominal
    assert found.error.with_effects == pytest.approx(found.error.noise_floor, rel=0.15)


def check_law(found, law):
    """A hull that sucks itself down: Z = c (u² + v²), all of it, and nothing else."""
    assert law.axis == "heave"
    assert {term.on for term in law.terms} == {"heave"}
    assert {q for term in law.terms for q in term.quantities} == {"u", "v"}
    assert not law.beside
    before, after = found.error.with_effects, found.ladder.models[-1].windows_2s
    assert after - found.error.noise_floor < 0.1 * (before - found.error.noise_floor)


def check_bands(found):
    """They hold 90 % of test runs, which took no part in it, as far as so few windows can tell."""
    (model,) = found.models.values()
    for seconds in ("2", "5"):
        windows = [run.windows[seconds] for run in model.runs.values()]
        inside = np.concatenate([one.at_end.array() for one in windows])
        points = 6 * sum(one.windows for one in windows)
        assert np.mean(inside) == pytest.approx(0.9, abs=4.0 * np.sqrt(0.09 / points))


@pytest.mark.parametrize(
    "case",
    [
        combination(2, 41, "development"),
        pytest.param(outside("squat", 0, "development"), marks=pytest.mark.thorough),
    ],
    ids=lambda case: case.id,
)
def test_the_tank_gives_up_what_it_hides(case, tmp_path):
    """The same as the test above asks of independent exports, in a clone alone."""
    flown = fly(case, tmp_path / "raw")
    found = diagnosis(tmp_path / "raw", tmp_path)
    assert found.verdict in flown.verdicts
    assert set(named(found)) == set(flown.names)
    for hidden in flown.hidden:
        for parameter, value in hidden.parameters.items():
            answer = named(found)[hidden.effect][parameter]
            near = max(0.05 * abs(value.value), 3.0 * answer.std)
            assert answer.value == pytest.approx(value.value, abs=near)
    law = found.unexplained.proposal
    assert (law is not None) == bool(flown.outside)
    if law is not None:
        check_law(found, law)
    if not flown.outside:
        check_bands(bands(tmp_path / "raw", found))
    found.write(tmp_path / "diagnosis.json")
    assert Diagnosis.read(tmp_path / "diagnosis.json") == found


def test_the_same_runs_give_the_same_diagnosis_on_any_number_of_cores(tmp_path, monkeypatch):
    short = {"duration": 20.0}
    fly(nothing(42, "development", "none, 20 s", short), tmp_path / "raw")
    monkeypatch.setattr(numba.config, "NUMBA_NUM_THREADS", 3)
    first = diagnosis(tmp_path / "raw", tmp_path)
    monkeypatch.setattr(numba.config, "NUMBA_NUM_THREADS", 1)
    assert diagnosis(tmp_path / "raw", tmp_path) == first
    assert first.verdict == "adequate"
