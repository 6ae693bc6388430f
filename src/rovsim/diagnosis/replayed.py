"""Values with which a model replays best, for a model that cannot be complete.

The likelihood of the innovations takes all that is left for noise. Where it is physics that no name
explains, the disturbance it allows for swallows slow errors, and the values that foresee the next
reading best drift off in a replay. So they are fitted once more to what users see: the velocity in
windows. How sure they are then comes from how the windows disagree, not from the noise (the
sandwich estimate: White 1980; windows are the clusters: Liang & Zeger 1986).
"""

from dataclasses import dataclass, replace
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.evidence import Observatory, linearised
from rovsim.diagnosis.fit import Fit, descend, judged
from rovsim.diagnosis.gram import inner_products, solved
from rovsim.diagnosis.hypothesis import Hypothesis
from rovsim.diagnosis.noise import Noise
from rovsim.diagnosis.watch import Watch
from rovsim.diagnosis.windows import differences
from rovsim.model import Model
from rovsim.replay import windows
from rovsim.thrust import Between

SECONDS = 5.0  # the longest horizon of the contract: slow errors must show
SMALLEST = 1e-3  # m/s or rad/s: an axis that hardly moves does not count


@dataclass(frozen=True, eq=False)
class Replays:
    """Velocity errors in windows, each axis in units of how much it moves."""

    watches: tuple[Watch, ...]
    between: Between

    @property
    def spread(self) -> Array:
        """Standard deviation (6,) of the measured velocity."""
        nu = np.concatenate([w.motion.nu[w.motion.usable] for w in self.watches])
        return np.asarray(np.maximum(np.std(nu, axis=0), SMALLEST))

    def innovations(self, models: Sequence[Model]) -> list[Array]:
        """Scaled errors (m, 6, n) of each run; NaN where a model cannot move at all."""
        able = [m.possible for m in models]
        found = []
        for watch in self.watches:
            own = differences(
                [m for m in models if m.possible], watch, self.between, None, None, SECONDS
            )
            e = np.full((len(models), *own.shape[:0:-1]), np.nan)
            e[able] = own.swapaxes(1, 2) / self.spread[:, None]
            found.append(e)
        return found

    def linearised(self, at: Hypothesis) -> tuple[list[Array], list[Array]]:
        """Errors (6, n), and their derivatives (k, 6, n) to the k scaled parameters."""
        return linearised(at, self.innovations)

    def white(self, e: Sequence[Array], noise: Noise) -> Array:
        """Errors (..., 6, n) of all runs."""
        return np.concatenate(e, axis=-1)

    def window(self) -> Array:
        """Number (n,) of the window that each error lies in."""
        spans = [s for w in self.watches for s in windows(w.motion, SECONDS)]
        return np.repeat(np.arange(len(spans)), [b - a for a, b in spans])


def replayed(found: Fit, observatory: Observatory) -> Fit:
    """The same terms at the values that make windows smallest, and how sure these are."""
    evidence = Replays(observatory.watches, observatory.between)
    here, e, J = descend(found.hypothesis, evidence, found.noise)
    covariance = _sandwich(
        evidence.white(e, found.noise), evidence.white(J, found.noise), evidence.window()
    )
    fresh = observatory.suiting(here.model, found.noise)
    again = judged(here, *fresh.linearised(here), fresh, found.noise)
    return replace(again, covariance=covariance)


def _sandwich(e: Array, J: Array, window: Array) -> Array:
    """Covariance (k, k) from the scores of each window."""
    bread = solved(inner_products(J.reshape(len(J), -1)), np.eye(len(J)))
    scores = np.einsum("kin,in->kn", J, e)
    each = np.array([np.bincount(window, row) for row in scores])
    return bread @ (each @ each.T) @ bread
