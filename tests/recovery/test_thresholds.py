"""A dead band is found wherever it ends, also where the force curve is flat."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import yaml

from flown import observed
from rovsim.core.run import Commands
from rovsim.diagnosis.settings import DiagnosisSettings
from rovsim.diagnosis.train_diagnosis import diagnose_train_runs
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effect_entry import EffectEntry
from rovsim.dynamics.effects.thrusters import ThrusterDeadband
from rovsim.estimation.candidates import find_log_step, list_candidates
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
    found = diagnose_train_runs(base, runs, DiagnosisSettings(), built_in())
    assert [one.term.id for one in found.selected] == ["thruster_deadband"]
    (band,) = found.selected
    assert abs(band.term.effect["width"] - width) < 3.0 * band.std["width"]


@pytest.mark.parametrize(("kind", "step"), [("thruster", 0.0125), ("demand", 0.0)])
def test_a_log_tells_no_thresholds_apart_between_its_steps(kind, step):
    """Pulses in steps of 5 us, of 400 us from rest to full thrust."""
    value = 0.0125 * np.random.default_rng(0).integers(-80, 80, (500, 8))
    commands = Commands(0.05 * np.arange(500), value, kind)
    run = SimpleNamespace(motion=SimpleNamespace(commands=commands))
    assert find_log_step([run, run]) == pytest.approx(step)


def test_a_dead_band_is_as_fine_as_the_log(tmp_path):
    base, (run,) = observed(tmp_path, duration=4.0)

    def find_resolution(commands):
        coarse = replace(run, motion=replace(run.motion, commands=commands))
        (band, *_) = [
            candidate.term().parameters[0]
            for candidate in list_candidates([coarse], built_in(), base.vehicle)
            if candidate.effect is ThrusterDeadband
        ]
        return band.resolution

    log = run.motion.commands
    assert find_resolution(log) == pytest.approx(0.005)  # pulses in whole microseconds
    percent = replace(log, value=np.round(log.value, 2))
    assert find_resolution(percent) == pytest.approx(0.02)
