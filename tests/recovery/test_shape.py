"""The shape of an effect is found where the runs determine it, as its usual value too."""

import pytest

from flown import observed
from rovsim.diagnosis.settings import DiagnosisSettings
from rovsim.diagnosis.train_diagnosis import diagnose_train_runs
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effect_entry import EffectEntry


@pytest.mark.parametrize(("gain", "length"), [(4.0, 0.25), (3.0, 0.4), (0.5, 0.45)])
def test_how_far_from_the_surface_drag_grows(tmp_path, gain, length):
    """With its usual length quadratic drag made up for the rest, at a probability of one.

    Where it was off by too little for that, the gain was 15 of its standard deviations away.
    """
    values = {"gain": gain, "length_scale": length}
    hidden = EffectEntry(effect="surface_proximity", parameters=values)
    base, runs = observed(tmp_path, duration=60.0, effects=(hidden,))
    found = diagnose_train_runs(base, runs, DiagnosisSettings(), built_in())
    assert found.verdict == "missing_effects"
    (near,) = found.selected
    assert near.term.id == "surface_proximity"
    assert near.term.free == ("gain", "length_scale")
    for name in near.term.free:
        assert abs(near.term.effect[name] - values[name]) < 4.0 * near.std[name]
