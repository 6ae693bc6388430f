"""Spectral lines on any clock: what a line explains, and how often chance does as well."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.signal import lfilter, lombscargle
from scipy.stats import chi2, kstest

from rovsim.diagnosis.structure.spectral_lines import CLOCK_STEP_S, Periodogram, fit_lines


def bins(random, count=300):
    """Begins of bins 0.1 to 0.3 s long, as in the KTH tank, on steps of CLOCK_STEP_S."""
    return CLOCK_STEP_S * np.cumsum(random.integers(10, 31, count))


def clock(time):
    """Steps of CLOCK_STEP_S that hold the readings, and the frequencies of their lines, Hz."""
    count = 2 * (round(time[-1] / CLOCK_STEP_S) + 1)
    return count, np.arange(count // 2) / (count * CLOCK_STEP_S)


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


def periodogram(rows):
    """Of rows (r, n) of readings, one a run, at 10 Hz."""
    time = 0.1 * np.arange(rows.shape[1])
    count, frequency = clock(time)
    power = np.stack([fit_lines(row, np.ones(len(time)), time, count) for row in rows])
    usable = np.flatnonzero((frequency > 1.0 / time[-1]) & (frequency < 4.0))
    return Periodogram(power, frequency, usable, float(rows.size))


def wander(random, shape, memory):
    """Noise of unit variance with a memory (readings)."""
    keep = np.exp(-1.0 / memory)
    noise = np.sqrt(1.0 - keep**2) * random.normal(size=shape)
    return lfilter([1.0], [1.0, -keep], noise)


def test_noise_that_lasts_has_no_lines():
    random = np.random.default_rng(4)
    found = periodogram(random.normal(size=(3, 900)) + wander(random, (3, 900), 30.0))
    limit = chi2.isf(0.01 / len(found.usable), 6)
    assert found.total[found.usable].max() > 2.0 * limit
    assert found.beyond_noise[found.usable].max() < limit


def test_a_line_stands_out_of_noise_that_lasts():
    random = np.random.default_rng(5)
    line = 0.5 * np.sin(2.0 * np.pi * 1.0 * 0.1 * np.arange(900))
    found = periodogram(random.normal(size=(3, 900)) + wander(random, (3, 900), 30.0) + line)
    best = found.usable[np.argmax(found.beyond_noise[found.usable])]
    assert found.frequency[best] == pytest.approx(1.0, abs=0.01)
    assert found.beyond_noise[best] > 0.5 * found.total[best]
