"""Results that notebooks get: those of the pipeline, with tables, figures and HTML."""

import os
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Mapping, Sequence

from matplotlib.figure import Figure
from pandas import DataFrame, Series

from rovsim.application.export.sizes import Sized
from rovsim.apps.notebook import html
from rovsim.core.axes import AXES
from rovsim.core.horizons import STANDARD_HORIZON
from rovsim.dynamics.effects.base import Effect
from rovsim.dynamics.model import Model
from rovsim.reporting.figures import find_figure
from rovsim.reporting.figures.style import save
from rovsim.reporting.report_data import ReportData, list_run_figures
from rovsim.reporting.tables import Table, tabulate_errors, tabulate_ladder
from rovsim.reporting.wording import title
from rovsim.reporting.words.verdict import explain
from rovsim.results.base import or_nan
from rovsim.results.comparison import Comparison
from rovsim.results.diagnosis import Diagnosis
from rovsim.results.fitted import FittedEffect
from rovsim.results.ladder import Ladder

FITTED_COLUMNS = ("value", "std", "unit")


class Figures:
    """Results that can be drawn; base of those below."""

    data: ReportData

    @property
    def figures(self) -> list[str]:
        """Names of the figures there are; those of one run take `run` as well."""
        of_runs = list_run_figures() if self.data.replays else []
        return [*self.data.figures, *(figure.name for figure in of_runs)]

    def figure(self, name: str, run: str = "") -> Figure:
        """A figure, in the thesis style: 150 mm wide, 9 pt.

        Args:
            name: one of `figures`.
            run: of a figure of one run; the first unless given.

        Raises:
            BadInput: there is no such figure.
        """
        if find_figure(name) in list_run_figures():
            run = run or next(iter(self.data.motions))
        return html.displayed(self.data.draw(name, run))

    def save(self, name: str, folder: str | Path, run: str = "") -> list[Path]:
        """Write a figure as PDF and PNG; the same figure, the same bytes.

        Raises:
            BadInput: there is no such figure, or the folder cannot be written into.
        """
        return save(self.figure(name, run), Path(folder), f"{name}-{run}" if run else name)

    def _picture(self, name: str) -> str:
        return html.picture(self.figure(name), find_figure(name).caption)


@dataclass(frozen=True, eq=False)
class ShownComparison(Figures):
    """Errors of models; `data` holds the motions, replays and all results."""

    data: ReportData

    @property
    def result(self) -> Comparison:
        """What `comparison.json` holds."""
        assert self.data.comparison is not None
        return self.data.comparison

    @cached_property
    def ladder(self) -> Ladder:
        """The ladder of all models: the error of each on the test runs."""
        return Ladder(steps=self.data.steps)

    @property
    def errors(self) -> Series:
        """The error by model: velocity in 2 s windows, in standard deviations, on the test runs."""
        values = {step.model: or_nan(step.windows_2s) for step in self.ladder.steps}
        return Series(values, name="error", dtype=float)

    def table(
        self, quantity: str = "velocity_rmse", horizon: str = STANDARD_HORIZON, split: str = "test"
    ) -> DataFrame:
        """Return the errors by model and axis, pooled over runs.

        Args:
            quantity: velocity_rmse, velocity_mae or acceleration_rmse.
            horizon: s of the windows ("0.5", "2", "5"), or open_loop.
            split: train or test.
        """
        printed = self.printed(quantity, horizon, split)
        heads = [f"{column.heading} [{column.unit}]" for column in printed.columns]
        return printed.frame.set_axis(heads, axis=1)

    def printed(
        self, quantity: str = "velocity_rmse", horizon: str = STANDARD_HORIZON, split: str = "test"
    ) -> Table:
        """Return the same table for paper: see its `latex()`, `csv()` and `write(folder, name)`."""
        return tabulate_errors(self.result, horizon, split, quantity)

    @property
    def sentences(self) -> dict[str, list[str]]:
        """Sentences on the conditions under which each model fails, by model."""
        where = self.data.where
        return {name: list(m.sentences) for name, m in where.models.items()} if where else {}

    def _repr_html_(self) -> str:
        parts = [html.heading("Error on the test runs"), html.table(self.errors.to_frame())]
        parts += [html.heading("Velocity RMSE of 2 s windows"), html.table(self.table())]
        for name, lines in self.sentences.items():
            parts += [html.heading(f"Where {title(name)} fails"), html.sentences(lines)]
        return "".join([*parts, self._picture("error_growth")])


@dataclass(frozen=True, eq=False)
class ShownDiagnosis(Figures):
    """What a model lacks: the result, its file, and the catalogue that explains it."""

    result: Diagnosis
    path: Path
    catalogue: Mapping[str, type[Effect]]

    @property
    def data(self) -> ReportData:  # type: ignore[override]
        """The results that can be drawn."""
        return ReportData(diagnosis=self.result, ladder=self.result.ladder)

    @property
    def verdict(self) -> str:
        """missing_effects, adequate, unexplained or insufficient_data."""
        return self.result.verdict

    @property
    def selected(self) -> DataFrame:
        """The missing effects, a row for each parameter; `std` is one standard deviation."""
        return _effects(self.result.selected)

    @property
    def ranking(self) -> DataFrame:
        """The likeliest effects alone, the best first, and the selected ones beyond these."""
        rows = {r.effect: (or_nan(r.error_reduction), r.probability) for r in self.result.ranking}
        columns = ["error_reduction", "probability"]
        return DataFrame.from_dict(rows, orient="index", columns=columns)

    @property
    def ladder(self) -> DataFrame:
        """The error on the test runs, effect by effect, down to the noise floor."""
        return _named(tabulate_ladder(self.result.ladder))

    def _repr_html_(self) -> str:
        verdict = explain(self.result, self.catalogue)
        parts = [html.heading(verdict.sentence)]
        if self.result.selected:
            parts.append(html.table(self.selected))
        parts.append(
            html.sentences([*verdict.sentences, *([verdict.next] if verdict.next else [])])
        )
        return "".join([*parts, self._picture("ladder")])


@dataclass(frozen=True, eq=False)
class ShownModel(os.PathLike):
    """A model file, which can be given wherever a model is asked for."""

    model: Model
    path: Path

    def __fspath__(self) -> str:
        return str(self.path)

    @property
    def effects(self) -> DataFrame:
        """The effects added to the vehicle, a row a parameter; `std` is one standard deviation."""
        rows = {
            (effect.id, p.name): (effect[p.name], effect.std.get(p.name), p.unit)
            for effect in self.model.added
            for p in effect.parameters
            if p.name in effect.given() or p.name in effect.std
        }
        return _rows(rows, FITTED_COLUMNS)

    def _repr_html_(self) -> str:
        residual = self.model.residual
        learned = ["A trained residual on top."] if residual is not None else []
        parts = [html.heading(f"{self.model.name}: {self.model.vehicle.name}")]
        parts += [html.table(self.effects)] if len(self.effects) else []
        return "".join([*parts, html.sentences([*learned, f"File: {self.path}"])])


@dataclass(frozen=True, eq=False)
class ShownExport:
    """A model for another simulator: its file, and the parts that this cannot hold."""

    path: Path
    simulator: str
    left: tuple[Sized, ...]

    @property
    def left_out(self) -> DataFrame:
        """RMS force (N, N m) of each part that is left out, by axis, and the reason."""
        rows = {part.name: [*part.rms, part.why] for part in self.left}
        return DataFrame.from_dict(rows, orient="index", columns=[*AXES, "why"])

    def _repr_html_(self) -> str:
        parts = [html.heading(f"{self.path} for {self.simulator}")]
        if not self.left:
            return "".join([*parts, html.sentences(["It holds the whole model."])])
        return "".join(
            [*parts, html.sentences(["Left out, N and N m:"]), html.table(self.left_out)]
        )


def _named(table: Table) -> DataFrame:
    """Return the numbers of a table, with units in the names of the columns."""
    names = [f"{column.name} [{column.unit}]" for column in table.columns]
    return table.frame.set_axis(names, axis=1)


def _effects(effects: Sequence[FittedEffect]) -> DataFrame:
    rows = {
        (fitted.effect, name): (
            or_nan(v.value),
            v.std,
            v.unit,
            or_nan(fitted.error_reduction),
            fitted.probability,
        )
        for fitted in effects
        for name, v in fitted.parameters.items()
    }
    return _rows(rows, (*FITTED_COLUMNS, "error_reduction", "probability"))


def _rows(rows: Mapping[tuple[str, str], Sequence[object]], columns: Sequence[str]) -> DataFrame:
    frame = DataFrame(list(rows.values()), columns=list(columns))
    frame.insert(0, "effect", [effect for effect, _ in rows])
    frame.insert(1, "parameter", [name for _, name in rows])
    return frame.set_index(["effect", "parameter"])
