"""A dead band is found wherever it ends, also where the force curve is flat."""

import pytest
import yaml

from flown import observed
from rovsim.diagnosis.settings import SearchSettings
from rovsim.diagnosis.train_diagnosis import diagnose_train_runs
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effect_entry import EffectEntry
from small_study import ROOT

QUADRATIC = {"quadratic": {"forward": 50.0, "reverse": 40.0}}


@pytest.mark.parametrize("width", [0.16, 0.235])
def test_a_wide_dead_band(tmp_path, width):
    """It was `adequate`, and a curve, a gain and two more at a probability of one."""
    vehicle = yaml.safe_load((ROOT / "conf" / "vehicle" / "bluerov2_heavy.yaml").read_text())
    vehicle["thrusters"]["force_curve"] = QUADRATIC
    path = tmp_path / "vehicle.yaml"
    path.write_text(yaml.safe_dump(vehicle))
    hidden = EffectEntry(effect="thruster_deadband", parameters={"width": width})
    base, runs = observed(tmp_path, duration=60.0, vehicle=str(path), effects=(hidden,))
    found = diagnose_train_runs(base, runs, SearchSettings(), catalogue=built_in())
    assert [one.term.id for one in found.selected] == ["thruster_deadband"]
    (band,) = found.selected
    assert abs(band.term.effect["width"] - width) < 3.0 * band.std["width"]
