"""A special effect that only makes up for a common scale which a vehicle file has wrong."""

import numpy as np
import pytest
import yaml

from flown import observed
from rovsim.core.axes import AXES
from rovsim.diagnosis.selection.search_result import Rival, keep_likeliest
from rovsim.diagnosis.selection.vehicle_file.special_effects import judge_beside_file
from rovsim.diagnosis.selection.vehicle_file.steps import prefer_file
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.diagnosis.settings import SearchSettings
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effect_entry import EffectEntry
from rovsim.dynamics.effects.rigid_body import Payload
from rovsim.dynamics.effects.thrusters import ThrusterGain
from rovsim.dynamics.vehicle import default_vehicle
from rovsim.dynamics.vehicle.load import vehicle_file
from rovsim.estimation.candidates import list_candidates
from rovsim.estimation.file_effects import FILE_EFFECT_IDS, free_terms
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.noise import FIRST_NOISE
from rovsim.estimation.sensitivities import linearise_candidates
from rovsim.estimation.white_columns import WhiteColumns

OFF, GAIN = 0.2, 1.3
NUMBERS = ("linear_damping", "quadratic_damping", "added_mass")
BALLAST = 0.05  # m below CO: couples surge with pitch by a mass that no number of the file is


@pytest.fixture(scope="module")
def workspace(tmp_path_factory):
    """A vehicle with thrusters that are stronger than its file says, and all else 20 % off."""
    folder = tmp_path_factory.mktemp("heavy")
    stated = yaml.safe_load(vehicle_file(default_vehicle()).read_text())
    stated["rigid_body"]["center_of_gravity"] = [0.0, 0.0, BALLAST]
    path = folder / "heavy.yaml"
    path.write_text(yaml.safe_dump(stated))
    water = stated["hydrodynamics"]
    off = {n: dict(zip(AXES, OFF * np.array(water[n]), strict=True)) for n in NUMBERS}
    off["thruster_gain"] = {"all": GAIN}
    hidden = tuple(EffectEntry(effect=name, parameters=own) for name, own in off.items())
    base, runs = observed(folder, duration=30.0, vehicle=str(path), effects=hidden)
    bank = FilterBank.design(runs, base, FIRST_NOISE)
    listed = list_candidates(runs, built_in(), base.vehicle)
    some = [c for c in listed if c.effect.id in (*FILE_EFFECT_IDS, Payload.id)]
    known = linearise_candidates(bank, Hypothesis(base), some)
    return SearchWorkspace.begin(WhiteColumns(bank, known, FIRST_NOISE), SearchSettings())


def test_a_payload_does_not_stand_for_a_scale(workspace):
    """To first order the file does not explain it: such a factor is too large a step."""
    base = workspace.bank.model
    stated = (*NUMBERS, "net_buoyancy", "buoyancy_center")
    file = free_terms(base, AXES, [built_in()[name] for name in stated])
    payload = Term(Payload(mass=0.3, z=-0.3), ("mass", "z"))
    found = prefer_file(workspace, workspace.fit(Hypothesis(base, (*file, payload))))
    assert Payload.id in {term.id for term in found.hypothesis.terms}
    judged = judge_beside_file(workspace, found).fit.hypothesis
    assert {term.id for term in judged.terms} <= {*FILE_EFFECT_IDS}
    (gain,) = (t.effect["all"] for t in judged.terms if t.id == ThrusterGain.id)
    assert gain == pytest.approx(GAIN, abs=0.1)


def test_where_a_file_is_not_off_everywhere_nothing_is_judged(workspace):
    base = workspace.bank.model
    two = free_terms(base, AXES, [built_in()[name] for name in NUMBERS[:2]])
    payload = Term(Payload(mass=0.3, z=-0.3), ("mass", "z"))
    found = workspace.fit(Hypothesis(base, (*two, payload)))
    assert judge_beside_file(workspace, found) == (found, ())


def test_of_rivals_for_the_same_the_likeliest_is_kept():
    far, near = (Rival("lift", "payload", worse) for worse in (9.0, 2.0))
    other = Rival("lift", "current", 5.0)
    assert keep_likeliest([far, other, near]) == (near, other)
