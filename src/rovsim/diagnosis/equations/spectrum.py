"""How the power of a force is spread over frequencies: periodograms of overlapping segments.

Source: Welch 1967. The mean of each segment is taken out, so what pushes all the time is not in it.
"""

from dataclasses import dataclass
from typing import Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.signal import welch

BAND = (0.1, 0.9)  # shares of the power: four fifths of it lie between
SEGMENT = 20.0  # s of a spectrum: resolves 0.05 Hz, and a run of a minute has several


@dataclass(frozen=True, eq=False)
class Spectrum:
    """`density` (k, 6) of power along the body's axes, N²/Hz and (N m)²/Hz, at `frequency` (k,) Hz.

    One-sided: its integral over the frequencies is the variance.
    """

    frequency: Array
    density: Array

    def find_band(self, axis: int) -> tuple[float, float]:
        """Lowest and highest frequency, Hz, of most of an axis' power."""
        share = np.cumsum(self.density[:, axis])
        low, high = np.searchsorted(share / max(share[-1], 1e-300), BAND)
        return float(self.frequency[low]), float(self.frequency[min(high, len(share) - 1)])


def find_spectrum(forces: Sequence[Array], period: float) -> Spectrum:
    """Mean over runs of forces (n, 6), a longer run counting more; shorter ones than a segment not.

    Args:
        forces: N, N m of each run; where the longest is shorter than a segment, that is one.
        period: s between two of its lines.
    """
    length = min(round(SEGMENT / period), max(len(f) for f in forces))
    long = [f for f in forces if len(f) >= length]
    found = [welch(f, 1.0 / period, nperseg=length, axis=0) for f in long]
    density = np.average([power for _, power in found], axis=0, weights=[len(f) for f in long])
    return Spectrum(found[0][0], density)
