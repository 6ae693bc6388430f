"""Who pushes how much, when: every effect's share of the generalized force, and what is missing.

The force of a part is what the right-hand side of the equation of motion gains when the part is put
in, one part after the other; so a new effect shows up by itself, and the parts add up to M nu_dot:

    M nu_dot = Coriolis + weight and buoyancy + added-mass Coriolis + damping + thrusters + effects

Inertia stands on the left, so of an effect that changes it only Coriolis and weight are seen here.
Where two effects multiply (a current and a damping), the later one is charged with the product.
"""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Iterator, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.files import read_arrays, write_arrays
from rovsim.dynamics.effects.base import Effect
from rovsim.dynamics.model import Model
from rovsim.learning.pairs import Samples
from rovsim.measurement.signals.motion import Motion
from rovsim.results.base import ByAxis
from rovsim.results.budget import BudgetTotals, RunBudget
from rovsim.simulation.drive import Drive
from rovsim.simulation.measured_states import (
    accelerate_as_measured,
    as_true,
    drive_as_measured,
)
from rovsim.simulation.settings import ReplaySettings

CORIOLIS, RESTORING, THRUSTERS = "Coriolis", "weight and buoyancy", "thrusters"
RESIDUAL, MISSING = "learned residual", "missing"
NOMINAL = {  # parts of the vehicle's own effects, in the order in which they are put in
    "net_buoyancy": RESTORING,
    "buoyancy_center": RESTORING,
    "added_mass": "added-mass Coriolis",
    "linear_damping": "linear damping",
    "quadratic_damping": "quadratic damping",
}


@dataclass(frozen=True, eq=False)
class Budget:
    """Forces of one model at the measured states of one run, FRD at CO, N and N m.

    `time` (n,) s; `parts` (n, 6) by name, which add up to M nu_dot of the model; `missing` (n, 6)
    is M a_res: what would have to push for the model to move as measured (NaN where not usable).
    """

    model: str
    run: str
    time: Array
    parts: dict[str, Array]
    missing: Array

    def rms(self) -> dict[str, ByAxis]:
        """Root mean square of every part and of what is missing, by axis, at usable instants."""
        known = np.isfinite(self.missing).all(axis=1)
        forces = {**self.parts, MISSING: self.missing}
        if not known.any():
            return {name: ByAxis() for name in forces}
        return {
            name: ByAxis.of(np.sqrt(np.mean(force[known] ** 2, axis=0)))
            for name, force in forces.items()
        }

    def write(self, path: Path) -> None:
        """Write to `.npz`."""
        parts = {f"part/{name}": force for name, force in self.parts.items()}
        label = np.array([self.model, self.run])
        write_arrays(path, label=label, time=self.time, missing=self.missing, **parts)

    @staticmethod
    def read(path: Path) -> "Budget":
        """Read what `write` wrote."""
        a = read_arrays(path)
        parts = {key.removeprefix("part/"): a[key] for key in a if key.startswith("part/")}
        return Budget(str(a["label"][0]), str(a["label"][1]), a["time"], parts, a["missing"])


def balance_forces(
    model: Model, motion: Motion, found: Samples, settings: ReplaySettings
) -> Budget:
    """Budget of one model over one run, of which `found` are the samples."""
    parts: dict[str, Array] = {}
    before = np.zeros((len(motion.time), 6))
    for name, force in _cumulative(model, as_true(model, motion), settings):
        parts[name] = parts.get(name, 0.0) + force - before
        before = force
    missing = np.full((len(motion.time), 6), np.nan)
    missing[found.index] = found.a_res @ model.body.M.T
    return Budget(model.name, motion.run.id, motion.time, parts, missing)


def total(budgets: Sequence[Budget]) -> BudgetTotals:
    """`budget.json`: RMS by run, part and axis."""
    return BudgetTotals(runs={b.run: RunBudget(model=b.model, rms=b.rms()) for b in budgets})


def _cumulative(
    model: Model, motion: Motion, settings: ReplaySettings
) -> Iterator[tuple[str, Array]]:
    """Generalized force (n, 6) as parts are put in one by one, each under its part's name."""
    neutral = [_neutral(effect) for effect in model.effects]
    bare = _with(model, neutral)
    none = drive_as_measured(bare, motion, settings).idle()
    still = replace(motion, state_nu=0 * motion.state_nu)
    yield RESTORING, _force(bare, still, none)
    yield CORIOLIS, _force(bare, motion, none)
    own = len(model.effects) - len(model.added)
    for k in sorted(range(own), key=lambda k: _place(model.effects[k])):
        if model.effects[k].id in NOMINAL:
            neutral[k] = model.effects[k]
            yield NOMINAL[neutral[k].id], _force(_with(model, neutral), motion, none)
    yield THRUSTERS, _at(_with(model, neutral), motion, settings)
    for k in range(own, len(neutral)):
        neutral[k] = model.effects[k]
        yield f"+{neutral[k].id}", _at(_with(model, neutral), motion, settings)
    if model.residual is not None:
        yield RESIDUAL, _at(model, motion, settings)


def _place(effect: Effect) -> int:
    """Where an effect of the vehicle stands in the order of parts."""
    return list(NOMINAL).index(effect.id) if effect.id in NOMINAL else len(NOMINAL)


def _neutral(effect: Effect) -> Effect:
    """The effect at its defaults, which change nothing; what every vehicle has stays."""
    return type(effect)() if effect.listed else effect


def _with(model: Model, effects: Sequence[Effect]) -> Model:
    """The model of these effects alone, without a learned residual."""
    return replace(model, effects=tuple(effects), residual=None)


def _at(model: Model, motion: Motion, settings: ReplaySettings) -> Array:
    return _force(model, motion, drive_as_measured(model, motion, settings))


def _force(model: Model, motion: Motion, drive: Drive) -> Array:
    """M nu_dot (n, 6) of a model at the measured states."""
    return accelerate_as_measured(model, motion, drive) @ model.body.M.T
