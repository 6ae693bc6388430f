"""Test whether what a fit leaves follows a function of state, place or time."""

from dataclasses import dataclass
from itertools import combinations, permutations, product
from typing import Iterator, Mapping, Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.stats import chi2

from rovsim.core.axes import AXES
from rovsim.core.rotations import matrix
from rovsim.diagnosis.structure.residual import FALSE_ALARM_RATE, AxisResidual, Structure
from rovsim.dynamics.laws.law import SIGN_WIDTH
from rovsim.dynamics.low_pass import LowPass
from rovsim.estimation.observer.observed_run import ObservedRun, number_blocks
from rovsim.estimation.observer.sandwich import find_inflation

# The velocity measured at an instant shares noise with the readings around it, and so would be
# correlated with their innovations. A little earlier it is not, and the motion changes little.
LOOK_BACK_SECONDS = 0.2  # s
MEMORY_SECONDS = (0.5, 2.0)  # s
# Of a column's power: if less is left, the fitted parameters explain it already.
MIN_INDEPENDENT_SHARE = 1e-6


def earlier_states(run: ObservedRun) -> Array:
    """States (n, 13) measured `LOOK_BACK_SECONDS` before each of n readings; zero where none was.

    A state is the position in m NED, the quaternion body to world, and the body velocity (FRD) in
    m/s and rad/s.
    """
    past = max(1, round(LOOK_BACK_SECONDS / run.period))
    at = np.clip(run.innovation_samples - past, 0, len(run.motion.time) - 1)
    return np.nan_to_num(run.motion.state[at])


def tabulate(run: ObservedRun) -> dict[str, Array]:
    """Evaluate all functions at the n readings of a run.

    Places are relative to their mean over the run, and time runs from -1 to 1.

    Returns:
        Values (n,) by a name that a person can read.
    """
    state = earlier_states(run)
    nu, R, place = state[:, 7:], matrix(state[:, 3:7]), state[:, :3] - np.mean(state[:, :3], axis=0)
    t = 2.0 * run.time / max(run.time[-1], 1e-9) - 1.0 if len(run.time) else run.time
    table = {"nothing (a constant)": np.ones(len(t)), "time": t, "time squared": t**2}
    table |= _of_velocities(nu, run)
    for name, x in zip(("north", "east", "down"), place.T, strict=True):
        table[f"place along {name}"] = x
        table[f"place along {name}, squared"] = x**2
    for name, x in zip(("pitch", "roll", "upright"), R[:, 2].T, strict=True):
        table[f"attitude ({name})"] = x - np.mean(x)
    for name, x in zip(("north", "east", "down"), np.swapaxes(R, 1, 2)[:, :, 0].T, strict=True):
        table[f"heading ({name})"] = x
    # a flow or a force that differs from place to place, seen in the axes of a body that turns
    for heading, side in product(("north", "east"), repeat=2):
        column = table[f"place along {side}"] * table[f"heading ({heading})"]
        table[f"place along {side} times heading ({heading})"] = column
    return table


def _of_velocities(nu: Array, run: ObservedRun) -> dict[str, Array]:
    """Evaluate functions of the body velocities (n, 6) alone; values (n,) by name."""
    table = {}
    for i, axis in enumerate(AXES):
        v = nu[:, i]
        table[f"{axis} velocity"] = v
        table[f"{axis} speed"] = np.abs(v)
        table[f"{axis} velocity, squared"] = np.abs(v) * v
        table[f"{axis} velocity, cubed"] = v**3
        table[f"the direction of {axis} motion"] = np.tanh(v / SIGN_WIDTH)
        for memory in MEMORY_SECONDS:
            table[f"{axis} velocity some {memory:g} s ago"] = _lag(v, run, memory)
    for i, j in combinations(range(6), 2):
        table[f"{AXES[i]} times {AXES[j]} velocity"] = nu[:, i] * nu[:, j]
    for i, j in permutations(range(6), 2):  # drag and moments that change with a cross-flow
        table[f"{AXES[i]} velocity times {AXES[j]} speed"] = nu[:, i] * np.abs(nu[:, j])
        table[f"{AXES[i]} velocity times {AXES[j]} speed squared"] = nu[:, i] * nu[:, j] ** 2
    return table


@dataclass(frozen=True)
class Dependence:
    """How much of the remainder on an axis follows one function of state, place or time.

    Attributes:
        name: of the function.
        statistic: chi-square of what it explains.
        size: RMS of that push, m/s2 or rad/s2.
        taken: share of the function's power that the fitted parameters could have explained.
    """

    name: str
    statistic: float
    size: float
    taken: float


def find_dependence(
    residual: AxisResidual, tables: Sequence[Mapping[str, Array]]
) -> Iterator[Structure]:
    """Yield the functions that the remainder follows beyond chance.

    Each function has a single factor, common to all runs.

    Args:
        residual: what a fit leaves on one axis.
        tables: values (n_run,) of all functions, of each run.
    """
    limit = chi2.isf(FALSE_ALARM_RATE / (len(AXES) * len(tables[0])), 1)
    for d in list_dependences(residual, tables):
        yield from residual.weigh(d.name, size=d.size, statistic=d.statistic, limit=limit)


def list_dependences(
    residual: AxisResidual, tables: Sequence[Mapping[str, Array]]
) -> Iterator[Dependence]:
    """Yield how far the remainder follows each function, whether or not that may be chance.

    Functions that the fitted parameters explain already are left out. For the arguments see
    `find_dependence`.
    """
    target, derivatives = np.concatenate(residual.white), residual.fitted
    basis = np.linalg.qr(derivatives.T)[0] if len(derivatives) else np.empty((len(target), 0))
    blocks = number_blocks(residual.runs) if residual.of_channels else None
    for name in tables[0]:
        disturbances = [table[name] for table in tables]
        size = np.sqrt(np.mean(np.concatenate(disturbances) ** 2))
        column = residual.respond(disturbances)
        independent = column - basis @ (basis.T @ column)
        power, total_power = float(independent @ independent), float(column @ column)
        if power < MIN_INDEPENDENT_SHARE * total_power or size == 0.0:
            continue
        factor = float(independent @ target) / power
        # only the part counts that no fitted parameter could have explained
        independent_size = abs(factor) * size * np.sqrt(power / total_power)
        statistic = factor**2 * power
        if blocks is not None:
            # errors that last longer than the noise model says follow many functions by chance
            statistic /= find_inflation(
                independent * (target - factor * independent), power, blocks
            )
        yield Dependence(name, statistic, independent_size, 1.0 - power / total_power)


def _lag(v: Array, run: ObservedRun, memory: float) -> Array:
    """Filter a velocity (n,) by a first-order lag of `memory` s, from zero in each stretch."""
    lag, out = LowPass((memory,)), np.empty_like(v)
    for begin, end in run.innovation_segments:
        stretch = v[begin:end, None]
        out[begin:end] = lag.smooth(stretch, run.period, first=np.zeros((1, 1)))[:, 0]
    return out
