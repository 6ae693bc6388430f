"""The shape of an effect is found where the runs show it, and stays as usual where they do not."""

import pytest

from flown import observed
from rovsim.diagnosis.procedure import diagnose_train_runs
from rovsim.diagnosis.settings import SearchSettings
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effect_entry import EffectEntry


@pytest.mark.parametrize(("gain", "length", "shown"), [(4.0, 0.25, True), (3.0, 0.4, False)])
def test_how_far_from_the_surface_drag_grows(tmp_path, gain, length, shown):
    """With its usual length quadratic drag made up for the rest, at a probability of one."""
    values = {"gain": gain, "length_scale": length}
    hidden = EffectEntry(effect="surface_proximity", parameters=values)
    base, runs = observed(tmp_path, duration=60.0, effects=(hidden,))
    found = diagnose_train_runs(base, runs, SearchSettings(), catalogue=built_in())
    assert found.verdict == "missing_effects"
    (near,) = found.selected
    assert near.term.id == "surface_proximity"
    assert ("length_scale" in near.term.free) is shown
    for name in near.term.free:
        assert abs(near.term.effect[name] - values[name]) < 4.0 * near.std[name]
