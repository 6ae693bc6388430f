"""What no candidate explains, where candidates are nearly as many as the readings."""

from types import SimpleNamespace

import numpy as np
import pytest

from rovsim.estimation.observer.noise import FIRST_NOISE
from rovsim.estimation.remaining_noise import draw_remainder


def flatten(rows, noise):
    """As a filter bank whose innovations are white already."""
    return np.concatenate(rows, axis=-1).reshape(len(rows[0]), -1)


@pytest.mark.parametrize("share", [0.1, 0.5, 0.8])
def test_columns_take_no_noise_away_however_many_they_are(share):
    random = np.random.default_rng(4)
    readings = 150
    e = [random.normal(size=(6, readings))]
    columns = [random.normal(size=(round(share * 6 * readings), 6, readings)).astype(np.float32)]
    left = draw_remainder(SimpleNamespace(flatten=flatten), e, columns, FIRST_NOISE)
    assert np.mean(np.square(left)) == pytest.approx(1.0, abs=0.2)


def test_what_columns_explain_is_taken_away():
    random = np.random.default_rng(5)
    noise, columns = random.normal(size=(6, 400)), random.normal(size=(3, 6, 400))
    e = noise - np.tensordot([50.0, -20.0, 30.0], columns, axes=1)
    left = draw_remainder(SimpleNamespace(flatten=flatten), [e], [columns], FIRST_NOISE)
    assert np.mean(np.square(left)) == pytest.approx(1.0, abs=0.1)
