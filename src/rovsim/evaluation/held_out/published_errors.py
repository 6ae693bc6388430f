"""Compare errors on held-out runs with those that others published for the same runs.

A cell is one run, axis and metric. Its mark is the error to beat: the smallest published one of any
model and variant. On an axis whose demand never changed, the mark is the larger of that and the
error of a model that keeps its velocity, as it is no merit of a model to stay still there.
"""

import csv
import io
from dataclasses import dataclass
from pathlib import Path
from typing import Mapping, Sequence

import numpy as np

from rovsim.core.axes import AXES
from rovsim.core.errors import BadInput
from rovsim.core.files import read_text
from rovsim.core.model_names import ZERO_ACCELERATION
from rovsim.core.run import Commands
from rovsim.results.base import ByAxis, or_nan, or_none
from rovsim.results.comparison import Comparison
from rovsim.results.published_errors import (
    MissedCell,
    ModelStanding,
    PublishedCell,
    PublishedErrors,
    Source,
    Standing,
)

JUDGED_METRICS = ("acceleration_rmse", "velocity_mae")  # metrics by which a model is judged
METRICS = (*JUDGED_METRICS, "velocity_rmse")
PUBLISHED_PREFIX = "published "  # in front of the names of others' models
COLUMNS = ("run", "variant", "model", "axis", *METRICS)


@dataclass(frozen=True)
class Published:
    """Published errors of a model on one axis of one run.

    Attributes:
        run: id of the run.
        variant: of the model, as its authors call it.
        model: its name.
        axis: surge to yaw.
        errors: by metric, m/s2 or rad/s2 for accelerations and m/s or rad/s for velocities.
    """

    run: str
    variant: str
    model: str
    axis: str
    errors: Mapping[str, float]


def read_published(path: Path) -> list[Published]:
    """Read published errors from a csv with the columns `COLUMNS`; other columns are ignored.

    Raises:
        BadInput: the file, a column or a number is missing or makes no sense.
    """
    reader = csv.DictReader(io.StringIO(read_text(path)))
    lacking = [name for name in COLUMNS if name not in (reader.fieldnames or ())]
    if lacking:
        raise BadInput(
            f"no column {', '.join(lacking)}",
            where=path,
            expected=f"the columns {', '.join(COLUMNS)}",
            remedy="Name the columns in the first line.",
        )
    return [_entry(row, f"{path}, line {reader.line_num}") for row in reader]


def _entry(row: Mapping[str, str], where: str) -> Published:
    """Read one row; `where` names its line, for a message.

    Raises:
        BadInput: the axis or a number makes no sense.
    """
    try:
        errors = {metric: float(row[metric]) for metric in METRICS}
    except (TypeError, ValueError):
        errors = {}
    if errors and row["axis"] in AXES and all(0 < e < np.inf for e in errors.values()):
        return Published(row["run"], row["variant"], row["model"], row["axis"], errors)
    raise BadInput(
        f"{', '.join(str(row[name]) for name in ('axis', *METRICS))}",
        where=where,
        expected=f"an axis ({', '.join(AXES)}) and {len(METRICS)} errors above zero",
        remedy="Correct or delete that line.",
    )


def find_demanded(commands: Commands) -> dict[str, bool]:
    """Tell of each axis whether its demand changed in a run.

    Thruster commands do not tell axes apart. All axes then count as demanded, which makes no mark
    easier to beat.
    """
    if commands.kind == "thruster":
        return dict.fromkeys(AXES, True)
    return {axis: bool(np.any(v != v[:1])) for axis, v in zip(AXES, commands.value.T, strict=True)}


def compare_published(
    published: Sequence[Published],
    comparisons: Mapping[str, Comparison],
    moved: Mapping[str, Mapping[str, bool]],
) -> PublishedErrors:
    """Compare our errors with published ones, as `published_errors.json`.

    Args:
        published: errors of others.
        comparisons: by id of the held-out run, the errors of our models on it.
        moved: by id of the run, whether the demand of each axis changed.

    Raises:
        BadInput: nobody published anything for any of the runs.
    """
    published_runs = [run for run in comparisons if any(p.run == run for p in published)]
    if not published_runs:
        raise BadInput(
            f"nothing is published for the runs {', '.join(comparisons)}",
            where="published numbers",
            expected=f"one of the runs {', '.join(dict.fromkeys(p.run for p in published))}",
            remedy="Name the runs of the campaign as in the published file.",
        )
    candidates = [
        _cell(
            _select_published(published, run, axis),
            _errors(comparisons[run], run, axis, metric),
            moved[run],
            run,
            axis,
            metric,
        )
        for run in published_runs
        for axis in AXES
        for metric in METRICS
    ]
    cells = tuple(cell for cell in candidates if cell)
    names = dict.fromkeys(name for cell in cells for name in cell.ratios)
    return PublishedErrors(
        runs=tuple(published_runs),
        without_published=tuple(run for run in comparisons if run not in published_runs),
        models={name: _stand(name, cells) for name in names},
        cells=cells,
    )


def _select_published(published: Sequence[Published], run: str, axis: str) -> list[Published]:
    """Published errors on one axis of one run."""
    return [p for p in published if (p.run, p.axis) == (run, axis)]


def _errors(comparison: Comparison, run: str, axis: str, metric: str) -> dict[str, float | None]:
    """Open-loop errors of our models, by name; None where a model diverged."""
    return {
        name: model.runs[run].open_loop.by_axis(metric)[axis]
        for name, model in comparison.models.items()
        if run in model.runs
    }


def _cell(
    theirs: Sequence[Published],
    ours: Mapping[str, float | None],
    moved: Mapping[str, bool],
    run: str,
    axis: str,
    metric: str,
) -> PublishedCell | None:
    """Compare errors in one cell.

    Args:
        theirs: published errors on this axis of this run.
        ours: errors of our models, by name.
        moved: whether the demand of each axis changed.
        run: id of the run.
        axis: surge to yaw.
        metric: one of `METRICS`.

    Returns:
        The cell; None without a published error, or where nothing was measured.
    """
    at_rest = ours.get(ZERO_ACCELERATION)
    if not theirs or at_rest is None:
        return None
    best = min(theirs, key=lambda p: p.errors[metric])
    mark = best.errors[metric] if moved[axis] else max(best.errors[metric], at_rest)
    smallest = {
        f"{PUBLISHED_PREFIX}{model}": min(p.errors[metric] for p in theirs if p.model == model)
        for model in dict.fromkeys(p.model for p in theirs)
    }
    errors = {**ours, **smallest}
    return PublishedCell(
        run=run,
        axis=axis,
        metric=metric,
        demanded=moved[axis],
        mark=mark,
        best=Source(model=best.model, variant=best.variant),
        errors=errors,
        ratios={name: None if e is None else e / mark for name, e in errors.items()},
    )


def stand(ratios: Sequence[float | None]) -> Standing:
    """Count the cells in which a model beats the mark, and average its ratios.

    A model without a value in a cell does not beat it, and has no mean.

    Args:
        ratios: error over mark, of each cell; None where the model has no value.
    """
    values = np.array([np.inf if ratio is None else ratio for ratio in ratios])
    with np.errstate(divide="ignore"):
        mean = np.exp(np.mean(np.log(values))) if len(values) else np.nan
    below = int(np.sum(values < 1.0))
    return Standing(
        cells=len(values),
        below=below,
        share_below=or_none(below / len(values) if len(values) else np.nan),
        geometric_mean=or_none(mean),
    )


def _stand(name: str, cells: Sequence[PublishedCell]) -> ModelStanding:
    """Tell how one model stands: in the counted metrics together, by metric, and by axis."""
    model_cells = [cell for cell in cells if name in cell.ratios]
    counted = [cell for cell in model_cells if cell.metric in JUDGED_METRICS]

    def among(cells: Sequence[PublishedCell]) -> Standing:
        return stand([cell.ratios[name] for cell in cells])

    axes = {axis: among([c for c in counted if c.axis == axis]) for axis in AXES}
    total = among(counted)
    return ModelStanding(
        cells=total.cells,
        below=total.below,
        share_below=total.share_below,
        geometric_mean=total.geometric_mean,
        by_metric={
            metric: among([c for c in model_cells if c.metric == metric]) for metric in METRICS
        },
        by_axis=ByAxis(**{axis: s.geometric_mean for axis, s in axes.items()}),
        not_below=tuple(
            MissedCell(run=c.run, axis=c.axis, metric=c.metric, ratio=c.ratios[name])
            for c in counted
            if not or_nan(c.ratios[name]) < 1.0
        ),
    )
