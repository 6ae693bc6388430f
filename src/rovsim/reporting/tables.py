"""Tables of the study, as CSV for machines and LaTeX (booktabs) for a thesis."""

import csv
import io
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Mapping, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.files import write_text
from rovsim.evaluation.held_out.published_errors import METRICS
from rovsim.reporting.figures.marks import (
    ACCELERATION_UNITS,
    AXES,
    VELOCITY_UNITS,
    number,
    significant,
    vector,
)
from rovsim.reporting.figures.pooled import horizon_text, pooled

QUANTITIES = {
    "velocity_rmse": ("velocity RMSE", VELOCITY_UNITS),
    "velocity_mae": ("velocity MAE", VELOCITY_UNITS),
    "acceleration_rmse": ("acceleration RMSE", ACCELERATION_UNITS),
}
UNRANKED = "noise_floor"  # a bound, not a model: never the best


@dataclass(frozen=True)
class Column:
    """A column: its name in CSV, heading on paper, unit, and whether paper shows it."""

    name: str
    heading: str
    unit: str
    printed: bool = True


@dataclass(frozen=True, eq=False)
class Table:
    """Numbers (rows, columns) with a name per row; NaN where there is no value."""

    caption: str
    label: str
    columns: Sequence[Column]
    names: Sequence[str]
    values: Array

    def best(self) -> Array:
        """Where (rows, columns) the lowest number of a column stands; equal as printed share it."""
        printed = np.array([[_rounded(v) for v in row] for row in self.values])
        ranked = np.array([name != UNRANKED for name in self.names], dtype=bool)
        counted = np.isfinite(self.values) & ranked[:, None]
        values = np.where(counted, printed.reshape(self.values.shape), np.inf)
        return counted & (values == np.min(values, axis=0, initial=np.inf))

    def csv(self) -> str:
        """All columns at full precision; an empty cell where there is no value."""
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(["model", *(f"{c.name} [{c.unit}]" for c in self.columns)])
        for name, row in zip(self.names, self.values, strict=True):
            writer.writerow([name, *(repr(float(v)) if np.isfinite(v) else "" for v in row)])
        return text.getvalue()

    def latex(self) -> str:
        """A complete `table` for the booktabs package, the best number of each column bold."""
        shown = [k for k, column in enumerate(self.columns) if column.printed]
        best = self.best()
        rows = [
            [escaped(name), *(_cell(self.values[i, k], bool(best[i, k])) for k in shown)]
            for i, name in enumerate(self.names)
        ]
        heads = ["model", *(escaped(self.columns[k].heading) for k in shown)]
        units = ["", *(f"({escaped(self.columns[k].unit)})" for k in shown)]
        lines = [
            r"\begin{table}",
            r"  \centering",
            rf"  \caption{{{escaped(self.caption)}}}",
            rf"  \label{{{self.label}}}",
            rf"  \begin{{tabular}}{{l{'r' * len(shown)}}}",
            r"    \toprule",
            *(f"    {' & '.join(cells)} \\\\" for cells in (heads, units)),
            r"    \midrule",
            *(f"    {' & '.join(cells)} \\\\" for cells in rows),
            r"    \bottomrule",
            r"  \end{tabular}",
            r"\end{table}",
        ]
        return "\n".join(lines) + "\n"

    def write(self, folder: Path, name: str) -> list[Path]:
        """Write `name`.csv and `name`.tex into `folder`."""
        paths = [folder / f"{name}.csv", folder / f"{name}.tex"]
        write_text(paths[0], self.csv())
        write_text(paths[1], self.latex())
        return paths


def errors_table(
    comparison: Mapping[str, Any],
    horizon: str = "2",
    split: str = "test",
    quantity: str = "velocity_rmse",
) -> Table:
    """One row per model of `comparison.json`, one column per axis, runs of the split pooled."""
    errors = pooled(comparison, quantity, horizon, split)
    heading, units = QUANTITIES[quantity]
    columns = [
        Column(f"{axis}_{quantity}", axis, unit) for axis, unit in zip(AXES, units, strict=True)
    ]
    return Table(
        caption=f"{heading[0].upper()}{heading[1:]} per axis on the {split} runs, "
        f"{horizon_text(horizon)}. Lowest of each column in bold.",
        label=f"tab:{quantity.replace('_', '-')}-{horizon.replace('_', '-')}-{split}",
        columns=columns,
        names=list(errors),
        values=np.array(list(errors.values())).reshape(-1, len(AXES)),
    )


def ladder_table(ladder: Mapping[str, Any]) -> Table:
    """One row per step of `ladder.json`; velocity MAE only in the CSV, to fit the page."""
    steps = ladder.get("steps", [])
    columns = [Column("windows_2s", "2 s windows", "–")]
    for quantity, printed in (("acceleration_rmse", True), ("velocity_mae", False)):
        _, units = QUANTITIES[quantity]
        columns += [
            Column(f"{axis}_{quantity}", axis, unit, printed)
            for axis, unit in zip(AXES, units, strict=True)
        ]
    values = [
        [number(s.get("windows_2s")), *vector(s.get("acceleration_rmse")),
         *vector(s.get("velocity_mae"))] for s in steps
    ]  # fmt: skip
    return Table(
        caption="The error falling step by step on the test runs: velocity RMSE of 2 s windows in "
        "units of the measured velocity's spread, and acceleration RMSE per axis. "
        "Lowest of each column in bold; the noise floor is a bound, not a model.",
        label="tab:ladder",
        columns=columns,
        names=[s["model"] for s in steps],
        values=np.array(values, dtype=float).reshape(-1, len(columns)),
    )


def published_errors_table(published_errors: Mapping[str, Any]) -> Table:
    """One row per model of `published_errors.json`, others' last; metrics apart only in the CSV."""
    models = published_errors.get("models", {})
    columns = [Column("not_below", "not below", "%"), Column("ratio", "all", "–")]
    columns += [Column(f"{axis}_ratio", axis, "–") for axis in AXES]
    columns += [Column(f"{metric}_ratio", metric, "–", printed=False) for metric in METRICS]
    values = [
        [100 * (1 - number(m["share_below"])), number(m["geometric_mean"]), *vector(m["by_axis"]),
         *(number(m["by_metric"][k]["geometric_mean"]) for k in METRICS)]
        for m in models.values()
    ]  # fmt: skip
    return Table(
        caption="Held-out runs against the published numbers: cells (run, axis, metric) in which a "
        "model is not below the smallest published error, and the geometric mean of its error "
        "divided by that, over all cells and per axis. Lowest of each column in bold.",
        label="tab:published_errors",
        columns=columns,
        names=list(models),
        values=np.array(values, dtype=float).reshape(-1, len(columns)),
    )


_SPECIAL = {
    "\\": r"\textbackslash{}", "&": r"\&", "%": r"\%", "$": r"\$", "#": r"\#", "_": r"\_",
    "{": r"\{", "}": r"\}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}",
    "²": r"\textsuperscript{2}", "–": "--", "<": r"\textless{}", ">": r"\textgreater{}",
    "|": r"\textbar{}", "\n": " ",
}  # fmt: skip


def escaped(text: str) -> str:
    """Return `text` for LaTeX, every special character taken literally."""
    return "".join(_SPECIAL.get(letter, letter) for letter in text)


def _rounded(value: float) -> float:
    return float(f"{value:.2e}")


def _cell(value: float, best: bool) -> str:
    text = escaped(significant(value))
    return rf"\textbf{{{text}}}" if best else text
