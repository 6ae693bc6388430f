"""What figures and reports draw from: measured and predicted, by run and model, and all results."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Mapping, Sequence, TypeVar

import numpy as np
from numpy import ndarray as Array

from rovsim.evaluation.budget import Budget
from rovsim.measurement.signals.measured import blank
from rovsim.measurement.signals.motion import Motion
from rovsim.reporting.wording import title
from rovsim.results.bands import Bands
from rovsim.results.base import Result
from rovsim.results.budget import BudgetTotals
from rovsim.results.comparison import HORIZON, OPEN_LOOP, Comparison
from rovsim.results.diagnosis import Diagnosis
from rovsim.results.error_conditions import ErrorConditions
from rovsim.results.growth import Growth
from rovsim.results.ladder import Ladder, Step
from rovsim.results.pitfalls import Pitfalls
from rovsim.results.published_errors import PublishedErrors
from rovsim.results.quality import Quality
from rovsim.results.timing import Timing
from rovsim.simulation.prediction import Band, Replay

R = TypeVar("R", bound=Result)


@dataclass(frozen=True, eq=False)
class ReportData:
    """Motions by run, replays and bands by model and run, budgets of one model by run, and results.

    A result that is not known is None, and what would show it is left out. `drawn`: runs of which
    each has its figures.
    """

    motions: Mapping[str, Motion] = field(default_factory=dict)
    replays: Mapping[str, Mapping[str, Replay]] = field(default_factory=dict)
    bands: Mapping[str, Mapping[str, Band | None]] = field(default_factory=dict)
    budgets: Mapping[str, Budget] = field(default_factory=dict)
    quality: Mapping[str, Quality] = field(default_factory=dict)
    comparison: Comparison | None = None
    coverage: Bands | None = None
    growth: Growth | None = None
    steps: tuple[Step, ...] = ()
    forces: BudgetTotals | None = None
    drawn: tuple[str, ...] = ()
    ladder: Ladder | None = None
    timing: Timing | None = None
    where: ErrorConditions | None = None
    diagnosis: Diagnosis | None = None
    published_errors: PublishedErrors | None = None
    pitfalls: Pitfalls | None = None

    @staticmethod
    def read(results: Mapping[str, Path], quality: Mapping[str, Path]) -> "ReportData":
        """Results by the names they have here, and quality reports by run.

        Raises:
            BadInput: a file is missing or damaged.
        """

        def read(name: str, kind: type[R]) -> R | None:
            return kind.read(results[name]) if name in results else None

        return ReportData(
            quality={run: Quality.read(path) for run, path in quality.items()},
            comparison=read("comparison", Comparison),
            growth=read("growth", Growth),
            ladder=read("ladder", Ladder),
            timing=read("timing", Timing),
            where=read("where", ErrorConditions),
            diagnosis=read("diagnosis", Diagnosis),
            published_errors=read("published_errors", PublishedErrors),
            pitfalls=read("pitfalls", Pitfalls),
        )

    @property
    def figures(self) -> list[str]:
        """Figures of what is known, of those that are drawn once."""
        known = [name for name, result in ONCE.items() if getattr(self, result)]
        pushed = self.diagnosis is not None and self.diagnosis.unexplained.disturbance is not None
        return [name for name in known if name != "disturbance" or pushed]

    def predicted(
        self, run: str, horizon: str, name: str, models: Sequence[str]
    ) -> dict[str, Array]:
        """One predicted quantity by model."""
        return {
            model: getattr(self.replays[model][run].horizons[horizon], name)
            for model in models
            if run in self.replays.get(model, {})
        }

    def banded(self, run: str, models: Sequence[str]) -> dict[str, Array]:
        """Bands (2, n, 6) of the velocity by model, of those that have one."""
        each = {model: self.bands[model][run] for model in models if model in self.bands}
        return {model: band.nu for model, band in each.items() if band is not None}


# Figures drawn once, from the results of those names; and those drawn for every run.
ONCE = {
    "ranking": "diagnosis",
    "disturbance": "diagnosis",
    "error_by_axis": "comparison",
    "error_growth": "growth",
    "ladder": "ladder",
    "inference_time": "timing",
    "excitation": "quality",
    "where": "where",
    "where_map": "where",
    "against_published": "published_errors",
}
PER_RUN = ("budget", "velocities", "residual_series", "path_3d")


def select_arguments(
    figure: str, data: ReportData, run: str = "", models: Sequence[str] = ()
) -> dict[str, object]:
    """Keyword arguments of a figure's `draw`."""
    if figure in ONCE:
        return {ONCE[figure]: getattr(data, ONCE[figure])}
    if figure == "budget":
        budget = data.budgets[run]
        return {"time": budget.time, "parts": budget.parts, "missing": budget.missing}
    motion = data.motions[run]
    common = {"time": motion.time, "usable": motion.usable}
    if figure == "velocities":
        nu = data.predicted(run, HORIZON, "nu", models)
        measured = blank(motion.measured, motion.nu, np.nan)
        return {**common, "nu": measured, "predicted_nu": nu, "bands": data.banded(run, models)}
    if figure == "residual_series":
        nu_dot = data.predicted(run, HORIZON, "nu_dot", models)
        measured = blank(motion.measured, motion.nu_dot, np.nan)
        return {**common, "nu_dot": measured, "predicted_nu_dot": nu_dot}
    eta = data.predicted(run, OPEN_LOOP, "eta", models)
    tank = motion.site.tank if np.isfinite(motion.site.tank).all() else None
    place = motion.eta[:, :3]
    if motion.measured is not None and not motion.measured.coordinates.all():
        place = np.full_like(place, np.nan)
    return {**common, "eta": place, "predicted_eta": eta, "tank": tank}


def describe(figure: str, run: str, data: ReportData | None = None) -> str:
    """What a figure of one run shows, in a few words."""
    if not run:
        return ""
    if figure == "budget":
        model = data.budgets[run].model if data and run in data.budgets else ""
        return f"run {run}, model {title(model)}" if model else f"run {run}"
    return f"run {run}, {'open loop' if figure == 'path_3d' else f'{HORIZON} s windows'}"
