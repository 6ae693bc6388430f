"""A filter of the cameras and late thrust share a delay that only the noise can divide."""

from types import SimpleNamespace

import numpy as np
import pytest

from rovsim.diagnosis.uncertainty.camera_delay import share_delay
from rovsim.dynamics.catalogue import built_in
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.camera import Smoothing
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.noise import FIRST_NOISE

SMOOTHING = Smoothing(
    cutoff=5.0, std=0.1, lr_statistic=100.0, noise_cutoff=5.0, lowest=4.0, highest=8.0, frame=0.01
)
STD = (1.0 / (np.pi * 4.0) - 1.0 / (np.pi * 8.0)) / 6.0  # s, the range is three on either side


def fitted(*effect_ids):
    effects = [built_in()[effect_id] for effect_id in effect_ids]
    terms = tuple(Term(effect(), effect.free_at({})) for effect in effects)
    count = sum(len(term.free) for term in terms)
    linearised = SimpleNamespace(hypothesis=Hypothesis(None, terms))
    return Fit(linearised, FIRST_NOISE, 0.0, 1e-6 * np.eye(count))


@pytest.mark.parametrize("effect_id", ["input_delay", "thruster_lag"])
def test_late_thrust_is_no_surer_than_the_delay_of_the_filter(effect_id):
    late = fitted(effect_id)
    fit, smoothing = share_delay(late, SMOOTHING)
    scale = late.hypothesis.terms[0].parameters[0].scale
    assert fit.std[0] * scale == pytest.approx(STD, rel=0.01)
    # the same delay, as a cutoff: d (1 / pi f) = df / pi f^2
    assert smoothing.std == pytest.approx(np.pi * 5.0**2 * STD)


def test_where_thrust_is_not_late_the_motion_tells_the_cutoff():
    fit = fitted("payload")
    assert share_delay(fit, SMOOTHING) == (fit, SMOOTHING)


def test_of_a_delay_and_a_lag_the_delay_gives_way():
    late = fitted("payload", "thruster_lag", "input_delay")
    widened = share_delay(late, SMOOTHING)[0].std > late.std
    names = np.array(late.hypothesis.parameter_names)
    assert names[widened].tolist() == ["input_delay.delay"]
