"""A run is used up to where the model runs away from it, and what follows once it is back."""

import numpy as np
import pytest

from flown import observed
from rovsim.diagnosis import validated_search
from rovsim.diagnosis.settings import DiagnosisSettings
from rovsim.diagnosis.train_diagnosis import diagnose_train_runs
from rovsim.dynamics.catalogue import Catalogue, built_in
from rovsim.estimation.observer.divergence import ModelDiverged, require_finite


@pytest.fixture(scope="module")
def flight(tmp_path_factory):
    return observed(tmp_path_factory.mktemp("lost"), duration=30.0)


def lost_between(run, begin, end):
    """Innovations that are infinite between two times."""
    e = np.zeros((6, len(run.time)))
    e[3, (run.time > begin) & (run.time < end)] = np.inf
    return e


def test_what_is_finite_is_held(flight):
    require_finite([lost_between(run, 0.0, 0.0) for run in flight[1]])


def test_readings_are_left_out_from_before_the_model_is_lost_until_it_is_back(flight):
    _, (run,) = flight
    with pytest.raises(ModelDiverged) as caught:
        require_finite([lost_between(run, 12.0, 15.0)])
    (kept,), lost = caught.value.leave_out([run])
    gone = run.motion.time[run.motion.usable & ~kept.motion.usable]
    assert gone.min() == pytest.approx(9.0, abs=0.1)
    assert gone.max() == pytest.approx(15.0, abs=0.1)
    assert lost == {"a": pytest.approx(9.0, abs=0.1)}


def test_a_diagnosis_goes_on_without_what_was_lost(flight, monkeypatch):
    base, (run,) = flight
    lost = iter([[lost_between(run, 24.0, 99.0)]])

    def lose_once(e):
        require_finite(next(lost, e))

    monkeypatch.setattr(validated_search, "require_finite", lose_once)
    few = Catalogue({"net_buoyancy": built_in()["net_buoyancy"]})
    found = diagnose_train_runs(base, [run], DiagnosisSettings(), few)
    assert found.fit is not None
    assert found.usable.diverged_from == {"a": pytest.approx(21.0, abs=0.1)}
    assert found.usable.seconds < 21.0
