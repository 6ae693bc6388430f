"""Turn the findings into the content of `where.json`."""

from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.axes import AXES
from rovsim.core.rounding import rounded
from rovsim.evaluation.error_conditions.bins import BinnedErrors
from rovsim.evaluation.error_conditions.findings import ErrorExplanation, Finding
from rovsim.evaluation.error_conditions.search import SearchedModel
from rovsim.evaluation.error_conditions.sentences import ERROR_UNITS, say_finding, say_findings
from rovsim.results.error_conditions import (
    ConditionFinding,
    ConditionTable,
    ErrorConditions,
    ErrorSize,
    ModelConditions,
)


def list_conditions(models: Sequence[SearchedModel]) -> ErrorConditions:
    """Put together `where.json` of several models, in the order given."""
    return ErrorConditions(models={m.model: _list_model(m) for m in models})


def _list_model(one: SearchedModel) -> ModelConditions:
    """Report the error of one model by axis and condition, and its findings."""
    explanation = one.explanation
    return ModelConditions(
        split=one.split,
        runs=one.runs,
        enough=explanation.enough,
        error={axis: _size(explanation, k) for k, axis in enumerate(AXES)},
        sentences=tuple(say_findings(explanation)),
        findings=tuple(map(_report_finding, explanation.findings)),
        axes={
            axis: {name: tabulate(t) for name, t in tables.items()}
            for axis, tables in explanation.tables.items()
        },
    )


def _size(explanation: ErrorExplanation, k: int) -> ErrorSize:
    """RMS of the error and of the measured acceleration of axis k; None where it is unmeasured."""
    if explanation.blocks is None or not explanation.blocks.axes[k]:
        return ErrorSize(rms=None, measured_rms=None)

    def rms(x: Array) -> float:
        return float(np.sqrt(np.mean(x[:, k] ** 2)))

    blocks = explanation.blocks
    return ErrorSize(rms=rms(blocks.error), measured_rms=rms(blocks.measured))


def _report_finding(finding: Finding) -> ConditionFinding:
    """Report a finding with its sentence."""
    return ConditionFinding(
        **finding.share().model_dump(),
        unit=ERROR_UNITS[finding.axis],
        chance=finding.chance,
        alike=tuple(c.name for c in finding.alike),
        sentence=say_finding(finding),
    )


def tabulate(one: BinnedErrors) -> ConditionTable:
    """Report the errors of one axis in the bins of one condition, rounded."""
    at = one.binning
    return ConditionTable(
        unit=at.condition.unit,
        share_of_error=round(one.share, 4),
        edges=_rounded(at.edges),
        center=_rounded(at.center),
        blocks=tuple(at.count.tolist()),
        effective=_rounded(one.effective, 3),
        judged=tuple(at.judged.tolist()),
        mean=_rounded(one.mean),
        std_error=_rounded(one.error),
        rms=_rounded(one.rms),
    )


def _rounded(values: Array, digits: int = 5) -> tuple[float, ...]:
    """Round values (n,) to significant digits."""
    return tuple(rounded(v, digits) for v in values)
