"""The same as plain content: `where.json`."""

from typing import Any, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim import AXES
from rovsim.evaluation.error_conditions.bins import Table
from rovsim.evaluation.error_conditions.conditions import BLOCK
from rovsim.evaluation.error_conditions.findings import Finding, Where
from rovsim.evaluation.error_conditions.search import Judged
from rovsim.evaluation.error_conditions.sentences import UNITS, sentence, summary

SCHEMA = "rovsim.where/1"


def content(models: Sequence[Judged]) -> dict[str, Any]:
    """`where.json` of several models, in the order given."""
    return {"schema": SCHEMA, "block_s": BLOCK, "models": {m.model: _model(m) for m in models}}


def merged(parts: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """One `where.json` of several, their models in the order given."""
    models = {name: model for part in parts for name, model in part["models"].items()}
    return {"schema": SCHEMA, "block_s": BLOCK, "models": models}


def _model(one: Judged) -> dict[str, Any]:
    where = one.where
    return {
        "split": one.split,
        "runs": list(one.runs),
        "enough": where.enough,
        "error": {axis: _size(where, k) for k, axis in enumerate(AXES)},
        "sentences": summary(where),
        "findings": [_finding(found) for found in where.findings],
        "axes": {
            axis: {name: _table(t) for name, t in tables.items()}
            for axis, tables in where.tables.items()
        },
    }


def _size(where: Where, k: int) -> dict[str, Any]:
    """RMS of the error and of the measured acceleration of axis k."""
    if where.blocks is None:
        return {"rms": None, "measured_rms": None}

    def rms(x: Array) -> float:
        return float(np.sqrt(np.mean(x[:, k] ** 2)))

    return {"rms": rms(where.blocks.error), "measured_rms": rms(where.blocks.measured)}


def _finding(found: Finding) -> dict[str, Any]:
    return {
        **found.entry(),
        "unit": UNITS.get(found.axis, "rad/s²"),
        "chance": found.chance,
        "alike": [c.name for c in found.alike],
        "sentence": sentence(found),
    }


def _table(one: Table) -> dict[str, Any]:
    """One axis by one condition; lists run over the bins."""
    at = one.binning
    return {
        "unit": at.condition.unit,
        "share_of_error": round(one.share, 4),
        "edges": _rounded(at.edges),
        "center": _rounded(at.center),
        "blocks": at.count.tolist(),
        "effective": _rounded(one.effective, 3),
        "judged": at.judged.tolist(),
        "mean": _rounded(one.mean),
        "std_error": _rounded(one.error),
        "rms": _rounded(one.rms),
    }


def _rounded(values: Array, digits: int = 5) -> list[float]:
    return [float(f"{v:.{digits}g}") for v in values]
