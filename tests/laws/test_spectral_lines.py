"""Spectral lines on any clock: what a line explains, and how often chance does as well."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.signal import lombscargle
from scipy.stats import chi2, kstest

from rovsim.diagnosis.checks.spectral_lines import FINE, fit_lines


def bins(random, count=300):
    """Begins of bins 0.1 to 0.3 s long, as in the KTH tank, on steps of FINE."""
    return FINE * np.cumsum(random.integers(10, 31, count))


def clock(time):
    """Steps of FINE that hold the readings, and the frequencies of their lines, Hz."""
    count = 2 * (round(time[-1] / FINE) + 1)
    return count, np.arange(count // 2) / (count * FINE)


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32 - 1), st.booleans())
def test_a_line_explains_what_its_least_squares_fit_does(seed, growing):
    random = np.random.default_rng(seed)
    time = bins(random)
    white = random.normal(size=len(time))
    envelope = random.uniform(0.2, 2.0, len(time)) if growing else np.ones(len(time))
    count, frequency = clock(time)
    found = fit_lines(white, envelope, time, count)
    few = np.flatnonzero((frequency > 0.02) & (frequency < 2.5))[::7]
    pulse = 2.0 * np.pi * frequency[few]
    power = lombscargle(time, white / envelope, pulse, weights=envelope**2)
    np.testing.assert_allclose(found[few], 2.0 * power * np.mean(envelope**2), rtol=1e-6)
    k = int(random.choice(few))
    wave = 2.0 * np.pi * frequency[k] * time
    columns = np.stack([np.cos(wave), np.sin(wave)], axis=1) * envelope[:, None]
    left = np.linalg.lstsq(columns, white, rcond=None)[1][0]
    assert found[k] == pytest.approx(white @ white - left, rel=1e-6)


def test_noise_on_an_uneven_clock_gives_chi_square():
    """On a grid of the mean bin a tenth of the readings would overwrite others (measured)."""
    random = np.random.default_rng(1)
    time = bins(random)
    count, frequency = clock(time)
    k = int(np.argmin(np.abs(frequency - 1.7)))
    drawn = [
        fit_lines(random.normal(size=len(time)), np.ones(len(time)), time, count)[k]
        for _ in range(400)
    ]
    assert kstest(drawn, chi2(2).cdf).pvalue > 0.01


@pytest.mark.parametrize("hertz", [0.4, 1.1, 2.3])
def test_a_line_keeps_its_place_and_size_on_an_uneven_clock(hertz):
    time = bins(np.random.default_rng(2))
    count, frequency = clock(time)
    k = int(np.argmin(np.abs(frequency - hertz)))
    line = 3.0 * np.sin(2.0 * np.pi * frequency[k] * time + 0.7)
    found = fit_lines(line, np.ones(len(time)), time, count)
    assert np.argmax(found) == k
    assert found[k] / len(time) == pytest.approx(np.mean(line**2), rel=1e-9)
