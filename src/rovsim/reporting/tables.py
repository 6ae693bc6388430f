"""Tables of the study, as CSV for machines and LaTeX (booktabs, siunitx) for a thesis."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Sequence

import numpy as np
from pandas import DataFrame, MultiIndex, Series

from rovsim.core.axes import ACCELERATION_UNITS, AXES, VELOCITY_UNITS
from rovsim.core.files import write_text
from rovsim.core.horizons import STANDARD_HORIZON
from rovsim.core.model_names import NOISE_FLOOR
from rovsim.evaluation.held_out.published_errors import METRICS
from rovsim.reporting.figures.pooled import name_horizon, pool
from rovsim.reporting.wording import (
    ERROR_MEANING,
    ERROR_NAME,
    LADDER_NOTE,
    LADDER_STEP,
    fit,
    significant,
    title,
)
from rovsim.results.base import or_nan
from rovsim.results.comparison import Comparison
from rovsim.results.ladder import Ladder
from rovsim.results.published_errors import PublishedErrors

PREAMBLE_NOTE = "% In the preamble: \\usepackage{booktabs,siunitx}\n"
# Of siunitx 3 (2021). Eight columns fit `article` on A4; bold stays bold, 0.00467 in one piece.
SISETUP = (
    "\\footnotesize\\setlength{\\tabcolsep}{2.5pt}\n"
    "\\sisetup{detect-weight=true,group-digits=none}\n"
)
QUANTITIES = {
    "velocity_rmse": ("velocity RMSE", VELOCITY_UNITS),
    "velocity_mae": ("velocity MAE", VELOCITY_UNITS),
    "acceleration_rmse": ("acceleration RMSE", ACCELERATION_UNITS),
}


@dataclass(frozen=True)
class Column:
    """A column of a table.

    Attributes:
        name: in the CSV.
        heading: on paper.
        unit: of the numbers.
        printed: whether it is shown on paper.
        high_is_good: whether its largest number is the best.
    """

    name: str
    heading: str
    unit: str
    printed: bool = True
    high_is_good: bool = False


@dataclass(frozen=True, eq=False)
class Table:
    """A table of numbers.

    Attributes:
        caption: on paper.
        label: of the LaTeX table.
        columns: from left to right.
        frame: a row for each model, a column for each name; NaN where there is no value.
    """

    caption: str
    label: str
    columns: Sequence[Column]
    frame: DataFrame

    @property
    def printed(self) -> list[Column]:
        """The columns that are shown on paper."""
        return [column for column in self.columns if column.printed]

    def best(self) -> DataFrame:
        """Find the best numbers of each column as printed; the noise floor is never one of them.

        Returns:
            Like `frame`, True or False.
        """
        rounded = self.frame.map(lambda value: float(f"{value:.2e}")).drop(
            NOISE_FLOOR, errors="ignore"
        )
        best = rounded.min()
        for column in self.columns:
            if column.high_is_good:
                best[column.name] = rounded[column.name].max()
        return rounded.eq(best).reindex(self.frame.index, fill_value=False)

    def csv(self) -> str:
        """Return all columns as CSV at full precision; a cell is empty where there is no value."""
        heads = [f"{c.name} [{c.unit}]" for c in self.columns]
        return self.frame.set_axis(heads, axis=1).to_csv(index_label="model", lineterminator="\n")

    def latex(self) -> str:
        """Return a complete LaTeX `table`, with the best number of each column in bold."""
        names = [column.name for column in self.printed]
        heads = [(column.heading, f"({column.unit})") for column in self.printed]
        levels = MultiIndex.from_tuples(heads, names=["model", None])
        bold = np.where(self.best()[names], "bfseries:", "")
        frame = self.frame[names].set_axis(levels, axis=1).set_axis(map(title, self.frame.index))
        style = frame.style.format(_number).apply(lambda _: bold, axis=None)
        text = (
            style.format_index(escape="latex")
            .format_index(escape="latex", axis=1)
            .to_latex(
                column_format="l" + "".join(_aligned(self.frame[name]) for name in names),
                caption=self.caption,
                label=self.label,
                position_float="centering",
                hrules=True,
                sparse_columns=False,
                siunitx=True,
            )
        )
        return PREAMBLE_NOTE + text.replace("\\begin{tabular}", SISETUP + "\\begin{tabular}")

    def write(self, folder: Path, name: str) -> list[Path]:
        """Write `name`.csv and `name`.tex into `folder`."""
        paths = [folder / f"{name}.csv", folder / f"{name}.tex"]
        write_text(paths[0], self.csv())
        write_text(paths[1], self.latex())
        return paths


def _number(value: float) -> str:
    """Return a number for siunitx; in braces, so not aligned, with a power of ten or as a dash."""
    text = significant(value).replace("−", "-")
    if "e" in text:
        return rf"{{\num{{{text}}}}}"
    return text if math.isfinite(value) else f"{{{text}}}"


def _aligned(column: Series) -> str:
    """Return the column type of siunitx that fits the digits before and after the decimal point."""
    numbers = [_number(value) for value in column]
    parts = [number.partition(".") for number in numbers if not number.startswith("{")]
    before = max((len(whole) for whole, _, _ in parts), default=1)
    after = max((len(rest) for _, _, rest in parts), default=0)
    return f"S[table-format={before}.{after}]"


def tabulate_errors(
    comparison: Comparison,
    horizon: str = STANDARD_HORIZON,
    split: str = "test",
    quantity: str = "velocity_rmse",
) -> Table:
    """Return the table of a comparison: a row for each model, a column for each axis.

    The errors are pooled over the runs of a split, see `pool`.
    """
    heading, units = QUANTITIES[quantity]
    columns = [
        Column(f"{axis}_{quantity}", axis, unit) for axis, unit in zip(AXES, units, strict=True)
    ]
    errors = pool(comparison, quantity, horizon, split)
    return Table(
        caption=f"{heading[0].upper()}{heading[1:]} per axis on the {split} runs, "
        f"{name_horizon(horizon)}. Lowest of each column in bold, ties too.",
        label=f"tab:{quantity.replace('_', '-')}-{horizon.replace('_', '-')}-{split}",
        columns=columns,
        frame=errors.set_axis([column.name for column in columns], axis=1),
    )


def tabulate_ladder(ladder: Ladder) -> Table:
    """Return the table of a ladder, a row for each step; velocity MAE is only in the CSV."""
    columns = [
        Column("windows_2s", ERROR_NAME, "–"),
        Column("fit", "fit", "%", high_is_good=True),
    ]
    for quantity, printed in (("acceleration_rmse", True), ("velocity_mae", False)):
        _, units = QUANTITIES[quantity]
        columns += [
            Column(f"{axis}_{quantity}", axis, unit, printed)
            for axis, unit in zip(AXES, units, strict=True)
        ]
    rows = {
        step.model: [
            or_nan(step.windows_2s),
            fit(or_nan(step.windows_2s)),
            *step.acceleration_rmse.array(),
            *step.velocity_mae.array(),
        ]
        for step in ladder.steps
    }
    built_up = (
        f" {LADDER_NOTE}" if any(LADDER_STEP.fullmatch(step.model) for step in ladder.steps) else ""
    )
    remark = "; the noise floor is a bound, not a model" if ladder.noise_floor is not None else ""
    return Table(
        caption=f"Models on the test runs, all samples alike.{built_up} {ERROR_MEANING}. Fit: 1 "
        f"minus this. Per axis: acceleration RMSE. Best of each column in bold, ties too{remark}.",
        label="tab:ladder",
        columns=columns,
        frame=_frame(rows, columns),
    )


def tabulate_published_errors(published_errors: PublishedErrors) -> Table:
    """Return the table of errors against published ones, a row for each model.

    The ratios of the single metrics are only in the CSV.
    """
    columns = [Column("not_below", "not below", "%"), Column("ratio", "all", "–")]
    columns += [Column(f"{axis}_ratio", axis, "–") for axis in AXES]
    columns += [Column(f"{metric}_ratio", metric, "–", printed=False) for metric in METRICS]
    rows = {
        name: [
            100 * (1 - or_nan(model.share_below)),
            or_nan(model.geometric_mean),
            *model.by_axis.array(),
            *(or_nan(model.by_metric[k].geometric_mean) for k in METRICS),
        ]
        for name, model in published_errors.models.items()
    }
    return Table(
        caption="Held-out runs against the published numbers: cells (run, axis, metric) in which a "
        "model is not below the smallest published error, and the geometric mean of its error "
        "divided by that, over all cells and per axis. Lowest of each column in bold, ties too.",
        label="tab:published_errors",
        columns=columns,
        frame=_frame(rows, columns),
    )


def _frame(rows: dict[str, list[float]], columns: Sequence[Column]) -> DataFrame:
    names = [column.name for column in columns]
    return DataFrame.from_dict(rows, orient="index", columns=names, dtype=float)
