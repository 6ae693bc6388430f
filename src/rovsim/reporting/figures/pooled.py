"""One number per model and axis out of `comparison.json`: its runs pooled."""

import math
from typing import Any, Mapping

import numpy as np
from numpy import ndarray as Array

from rovsim.reporting.figures.marks import AXES, listed, vector


def pooled(
    comparison: Mapping[str, Any], quantity: str, horizon: str = "2", split: str = "test"
) -> dict[str, Array]:
    """Return {model: (6,)} of `quantity` over the runs of `split`, every run weighing the same.

    A mean absolute error is averaged, an RMSE squared first. Every model answers for the same
    runs: one without a value on a run where another has one gets NaN there, never an easier mean.
    `horizon` is "open_loop" or the window's length in seconds as in the file.
    """
    tables = {
        name: {run: vector(values(entry, horizon).get(quantity)) for run, entry in runs.items()}
        for name, runs in _runs(comparison, split).items()
    }
    names = sorted({run for table in tables.values() for run in table})
    blank = np.full(len(AXES), np.nan)
    stacks = {
        name: np.array([table.get(run, blank) for run in names]).reshape(-1, len(AXES))
        for name, table in tables.items()
    }
    if not stacks:
        return {}
    counted = np.any([np.isfinite(stack) for stack in stacks.values()], axis=0)
    power = 2 if quantity.endswith("rmse") else 1
    return {name: _mean(stack, counted, power) for name, stack in stacks.items()}


def relative(errors: Mapping[str, Array], base: str = "nominal") -> dict[str, Array]:
    """Divide every model's errors (6,) by those of `base`; NaN where there is nothing to divide."""
    reference = errors.get(base, np.full(len(AXES), np.nan))
    safe = np.where(reference > 0, reference, np.nan)
    return {name: values / safe for name, values in errors.items()}


def values(entry: Mapping[str, Any], horizon: str) -> Mapping[str, Any]:
    """Return the metrics of one run at one horizon; empty where there are none."""
    if horizon == "open_loop":
        return entry.get("open_loop") or {}
    return (entry.get("windows") or {}).get(horizon) or {}


def gaps(errors: Mapping[str, Array]) -> str:
    """Say which models lack a value on some axis."""
    lacking = [name for name, row in errors.items() if not np.isfinite(row).all()]
    return f"No value on some axis or run: {listed(lacking)}." if lacking else ""


def horizon_text(horizon: str) -> str:
    """Return a horizon as people say it."""
    return "open loop" if horizon == "open_loop" else f"{horizon} s windows"


def _runs(comparison: Mapping[str, Any], split: str) -> dict[str, dict[str, Any]]:
    return {
        name: {r: entry for r, entry in model["runs"].items() if entry.get("split") == split}
        for name, model in comparison.get("models", {}).items()
    }


def _mean(stack: Array, counted: Array, power: int) -> Array:
    total = np.where(counted, stack, 0.0) ** power
    n = counted.sum(axis=0)
    mean = total.sum(axis=0) / np.where(n > 0, n, math.nan)
    return mean ** (1 / power)
