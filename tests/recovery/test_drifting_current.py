"""A current that wanders is told from still water, from a steady one, and from other pushes."""

from dataclasses import replace

import numpy as np
import pytest

from flown import observed
from rovsim.diagnosis.observer.drifting_current import MovingWater
from rovsim.diagnosis.observer.filter_bank import FilterBank
from rovsim.diagnosis.observer.noise import FIRST_NOISE, Path
from rovsim.diagnosis.observer.random_walk import list_terms
from rovsim.diagnosis.procedure import diagnose
from rovsim.diagnosis.settings import SearchSettings
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effects.current import Current
from rovsim.dynamics.model_file import EffectEntry


def rms(values):
    """Root mean square."""
    return float(np.sqrt(np.mean(np.square(values))))


def hide(name, **values):
    """An effect with these values."""
    return EffectEntry(effect=name, parameters=values)


@pytest.mark.parametrize("rate", [0.004, 0.015])
def test_a_diagnosis_names_it_and_finds_its_rate(tmp_path, rate):
    hidden = (hide("current_drift", rate=rate), hide("net_buoyancy", force=4.0))
    base, runs = observed(tmp_path, duration=60.0, effects=hidden)
    found = diagnose(base, runs, SearchSettings(), catalogue=built_in())
    assert found.verdict == "missing_effects"
    named = {one.term.id: one for one in found.selected}
    assert set(named) == {"net_buoyancy", "current_drift"}
    drift = named["current_drift"]
    assert abs(drift.term.effect["rate"] - rate) < 4.0 * drift.std["rate"]
    assert drift.std["rate"] < 0.3 * rate
    assert drift.probability > 0.99


@pytest.mark.parametrize(
    "hidden",
    [
        (),
        (hide("current", north=0.1),),
        (hide("constant_wrench", surge=4.0),),
        (hide("tether_tension", stiffness=6.0, slack_length=0.5, anchor_x=5.0, anchor_y=2.0,
              anchor_z=3.0),),
    ],
    ids=["nothing", "current", "wrench", "tether"],
)  # fmt: skip
def test_nothing_else_is_taken_for_it(tmp_path, hidden):
    base, runs = observed(tmp_path, duration=60.0, effects=hidden)
    found = diagnose(base, runs, SearchSettings(), catalogue=built_in())
    assert {one.term.id for one in found.selected} == {one.effect for one in hidden}
    assert found.fit.noise.drift is None


def test_water_that_moves_shows_as_a_current_does(tmp_path):
    base, runs = observed(tmp_path, duration=20.0)
    steady = np.array([0.08, -0.05])
    bank = FilterBank.design(runs, base, FIRST_NOISE)
    (settled,) = (run.settled for run in bank.runs)
    (expected,) = bank.innovations(base + Current(north=steady[0], east=steady[1]))
    (still,) = bank.innovations(base)

    def err(paths):
        about = replace(bank, paths=paths)
        walk = MovingWater(base, bank.runs, bank.tunings, paths).walk
        begins = list_terms(runs[0])[0, 0]  # the first term of a walk is a steady current
        linear = np.tensordot(steady / begins, walk.columns[0][:2], axes=1)
        return rms((about.innovations(base)[0] - linear - expected)[:, settled])

    path = Path(runs[0].time, np.tile(steady, (len(runs[0].time), 1)))
    assert err((path,)) < 0.15 * rms((expected - still)[:, settled])
    assert err((path,)) < err(())
