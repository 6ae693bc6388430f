"""What a replay returns: for each horizon, arrays that are aligned with the measurement."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy import ndarray as Array

from rovsim.core.array_files import read_arrays, write_arrays
from rovsim.core.horizons import OPEN_LOOP
from rovsim.core.run import RunInfo

BAND_LEVEL = 0.9  # share of the measurement that a band should contain


@dataclass(frozen=True, eq=False)
class Prediction:
    """What a model predicts at the n times of a motion, after the filter of the measurement.

    NaN at times without a prediction, infinite from where the replay diverged.

    Attributes:
        eta: pose (n, 7): position m NED, quaternion body to world.
        nu: body velocity (n, 6), m/s and rad/s.
        nu_dot: body acceleration (n, 6), m/s2 and rad/s2.
    """

    eta: Array
    nu: Array
    nu_dot: Array

    @staticmethod
    def empty(count: int) -> "Prediction":
        """A prediction that is NaN at `count` times."""
        return Prediction(*(np.full((count, columns), np.nan) for columns in (7, 6, 6)))

    def mark_diverged(self, at: slice) -> None:
        """Replace what is not finite by infinity: scores skip NaN, but not infinity."""
        diverged = ~np.isfinite(self.nu[at]).all(axis=1)
        for values in (self.eta, self.nu, self.nu_dot):
            values[at][diverged] = np.inf


@dataclass(frozen=True, eq=False)
class Replay:
    """Predictions of one model for one run.

    Attributes:
        model: name of the model.
        run: the run.
        time: (n,) of the measurement, s.
        horizons: predictions at these times by name of their horizon: `open_loop`, `0.5`, `2`, `5`.
    """

    model: str
    run: RunInfo
    time: Array
    horizons: dict[str, Prediction]

    @property
    def longest(self) -> float:
        """Length of the longest windows, s; 0 if there are none."""
        return max((float(name) for name in self.horizons if name != OPEN_LOOP), default=0.0)

    def write(self, path: Path) -> None:
        """Write to `.npz`."""
        arrays = {
            f"{horizon}/{name}": getattr(prediction, name)
            for horizon, prediction in self.horizons.items()
            for name in ("eta", "nu", "nu_dot")
        }
        label = np.array([self.model, self.run.id, self.run.control, self.run.split])
        write_arrays(path, label=label, time=self.time, **arrays)

    @staticmethod
    def read(path: Path) -> "Replay":
        """Read what `write` wrote."""
        a = read_arrays(path)
        model, *run = (str(s) for s in a["label"])
        names = dict.fromkeys(key.split("/")[0] for key in a if "/" in key)
        horizons = {h: Prediction(a[f"{h}/eta"], a[f"{h}/nu"], a[f"{h}/nu_dot"]) for h in names}
        return Replay(model, RunInfo(*run), a["time"], horizons)


@dataclass(frozen=True, eq=False)
class Band:
    """Lower and upper end of a band at the n times of a motion; NaN at times without a prediction.

    Attributes:
        nu: of the body velocity (2, n, 6), m/s and rad/s.
        place: of the position m NED, then of roll, pitch and yaw in rad (2, n, 6). The angles are
            continued from the measured ones where each window begins, without jumps of 2 pi.
    """

    nu: Array
    place: Array

    @staticmethod
    def empty(count: int) -> "Band":
        """A band that is NaN at `count` times."""
        return Band(np.full((2, count, 6), np.nan), np.full((2, count, 6), np.nan))
