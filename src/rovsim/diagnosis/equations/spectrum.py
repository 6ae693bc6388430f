"""The power spectral density of a force: the mean periodogram of overlapping segments.

Source: Welch 1967. The mean of each segment is subtracted, so a constant force is not included.
"""

from dataclasses import dataclass
from typing import Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.signal import welch

BAND_POWER_SHARES = (0.1, 0.9)  # cumulative shares of the power: four fifths of it lie between
SEGMENT_SECONDS = 20.0  # s of a spectrum: resolves 0.05 Hz, and a run of a minute has several


@dataclass(frozen=True, eq=False)
class Spectrum:
    """One-sided power spectral density of a wrench: its integral over frequency is the variance.

    Attributes:
        frequency: (k,) Hz.
        density: (k, 6) along the body axes (FRD), N²/Hz and (N m)²/Hz.
    """

    frequency: Array
    density: Array

    def find_band(self, axis: int) -> tuple[float, float]:
        """Find the band, Hz, that holds the middle four fifths of an axis' power."""
        share = np.cumsum(self.density[:, axis])
        low, high = np.searchsorted(share / max(share[-1], 1e-300), BAND_POWER_SHARES)
        return float(self.frequency[low]), float(self.frequency[min(high, len(share) - 1)])


def find_spectrum(forces: Sequence[Array], period: float) -> Spectrum:
    """Estimate the mean spectrum of runs, weighted by their lengths.

    Runs that are shorter than a segment are left out. A segment lasts
    `SEGMENT_SECONDS`, or as long as the longest run where that is shorter.

    Args:
        forces: wrench (n, 6) of each run along the body axes, N and N m.
        period: between two samples of a wrench, s.
    """
    length = min(round(SEGMENT_SECONDS / period), max(len(f) for f in forces))
    segments = [f for f in forces if len(f) >= length]
    spectra = [welch(f, 1.0 / period, nperseg=length, axis=0) for f in segments]
    density = np.average(
        [power for _, power in spectra], axis=0, weights=[len(f) for f in segments]
    )
    return Spectrum(spectra[0][0], density)
