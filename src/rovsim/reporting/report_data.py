"""All data that figures and reports show: measurements, predictions and results."""

from dataclasses import dataclass, field, fields
from pathlib import Path
from types import NoneType
from typing import TYPE_CHECKING, Any, Mapping, get_args, get_type_hints

import numpy as np
from numpy import ndarray as Array

from rovsim.core.horizons import OPEN_LOOP, STANDARD_HORIZON
from rovsim.measurement.signals.measured import blank
from rovsim.measurement.signals.motion import Motion
from rovsim.reporting.figures import FigureKind, find_figure, list_figures, refuse_unknown
from rovsim.reporting.wording import title
from rovsim.results.bands import Bands
from rovsim.results.base import Result
from rovsim.results.comparison import Comparison
from rovsim.results.diagnosis import Diagnosis, Disturbance
from rovsim.results.error_conditions import ErrorConditions
from rovsim.results.force_budget import BudgetTotals, ForceBudget
from rovsim.results.growth import Growth
from rovsim.results.ladder import Ladder, LadderStep
from rovsim.results.pitfalls import Pitfalls
from rovsim.results.published_errors import PublishedErrors
from rovsim.results.quality import Quality
from rovsim.results.timing import Timing
from rovsim.simulation.prediction import Band, Replay

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, eq=False)
class ReportData:
    """What is known of a campaign; what would show an unknown result (None) is left out.

    Attributes:
        motions: what was measured, by run.
        replays: by model and run.
        bands: probability bands by model and run; None for a model without one.
        budgets: forces of one model, by run.
        quality: quality reports, by run.
        comparison: see comparison.json; likewise the other results.
        band_coverage: how much of the test runs lies inside the bands.
        steps: of a ladder of the compared models, on the test runs.
        budget_totals: totals of the budgets, by run.
        drawn: runs that have figures of their own.
    """

    motions: Mapping[str, Motion] = field(default_factory=dict)
    replays: Mapping[str, Mapping[str, Replay]] = field(default_factory=dict)
    bands: Mapping[str, Mapping[str, Band | None]] = field(default_factory=dict)
    budgets: Mapping[str, ForceBudget] = field(default_factory=dict)
    quality: Mapping[str, Quality] = field(default_factory=dict)
    comparison: Comparison | None = None
    band_coverage: Bands | None = None
    growth: Growth | None = None
    steps: tuple[LadderStep, ...] = ()
    budget_totals: BudgetTotals | None = None
    drawn: tuple[str, ...] = ()
    ladder: Ladder | None = None
    timing: Timing | None = None
    where: ErrorConditions | None = None
    diagnosis: Diagnosis | None = None
    published_errors: PublishedErrors | None = None
    pitfalls: Pitfalls | None = None

    @staticmethod
    def read(results: Mapping[str, Path], quality: Mapping[str, Path]) -> "ReportData":
        """Read results from files.

        Args:
            results: files by the name of an attribute of this class, one of STUDY_RESULTS.
            quality: quality reports by run.

        Raises:
            BadInput: a file is missing or damaged.
        """

        known: dict[str, Any] = {
            name: kind.read(results[name])
            for name, kind in STUDY_RESULTS.items()
            if name in results
        }
        return ReportData(
            quality={run: Quality.read(path) for run, path in quality.items()}, **known
        )

    @property
    def disturbance(self) -> Disturbance | None:
        """The force over time that follows no law; None where there is none."""
        return self.diagnosis.unexplained.disturbance if self.diagnosis else None

    @property
    def figures(self) -> list[str]:
        """Names of the figures of all runs that can be drawn of these results."""
        return [
            figure.name
            for figure in list_study_figures()
            if all(getattr(self, name) for name in figure.needs)
        ]

    def draw(self, figure: str, run: str = "") -> "Figure":
        """Draw a figure of the results, or of one run.

        Raises:
            BadInput: there is no such figure.
        """
        return find_figure(figure).draw(**self.select(figure, run))

    def select(self, figure: str, run: str = "") -> dict[str, Any]:
        """Return the arguments of a figure's `draw` from the results, or from one run.

        Raises:
            BadInput: there is no such figure.
        """
        content = RunData(self, run) if run else self
        takes = find_figure(figure).takes
        return {name: getattr(content, name) for name in takes if hasattr(content, name)}


def _find_results() -> dict[str, type[Result]]:
    """Find the attributes of ReportData that are declared as one result or None."""
    declared = {name: get_args(hint) for name, hint in get_type_hints(ReportData).items()}
    return {
        name: kinds[0]
        for name, kinds in declared.items()
        if NoneType in kinds and issubclass(kinds[0], Result)
    }


# The results that files of a study hold, by the name that ReportData and the workflow give them.
STUDY_RESULTS: Mapping[str, type[Result]] = _find_results()


@dataclass(frozen=True, eq=False)
class RunData:
    """What is known of one run: the arguments of figures that are drawn for each run."""

    study: ReportData
    run: str

    @property
    def time(self) -> Array:
        """Time of the samples (n,), s."""
        return self._motion.time

    @property
    def usable(self) -> Array:
        """Which samples (n,) may be used."""
        return self._motion.usable

    @property
    def nu(self) -> Array:
        """Measured velocity (n, 6), body axes; NaN on axes that were not measured."""
        return blank(self._motion.measured, self._motion.nu, np.nan)

    @property
    def nu_dot(self) -> Array:
        """Measured acceleration (n, 6), body axes; NaN on axes that were not measured."""
        return blank(self._motion.measured, self._motion.nu_dot, np.nan)

    @property
    def position(self) -> Array:
        """Measured position (n, 3), NED, m; NaN unless all coordinates were measured."""
        motion, place = self._motion, self._motion.eta[:, :3]
        if motion.measured is not None and not motion.measured.coordinates.all():
            return np.full_like(place, np.nan)
        return place

    @property
    def tank(self) -> Array | None:
        """Lower and upper limits (3, 2) of the tank, NED, m; None unless all are known."""
        walls = self._motion.site.tank
        return walls if np.isfinite(walls).all() else None

    @property
    def predicted_nu(self) -> dict[str, Array]:
        """Predicted velocity (n, 6) by model, in 2 s windows."""
        return self._predicted(STANDARD_HORIZON, "nu")

    @property
    def predicted_nu_dot(self) -> dict[str, Array]:
        """Predicted acceleration (n, 6) by model, in 2 s windows."""
        return self._predicted(STANDARD_HORIZON, "nu_dot")

    @property
    def predicted_position(self) -> dict[str, Array]:
        """Predicted position (n, 3) by model, in open loop, NED, m."""
        return {model: eta[:, :3] for model, eta in self._predicted(OPEN_LOOP, "eta").items()}

    @property
    def bands(self) -> dict[str, Array]:
        """Lower and upper end (2, n, 6) of the velocity's band, by model that has one."""
        candidates = {model: by_run.get(self.run) for model, by_run in self.study.bands.items()}
        return {model: band.nu for model, band in candidates.items() if band is not None}

    @property
    def budget(self) -> ForceBudget | None:
        """Forces of one model on the run; None if unknown."""
        return self.study.budgets.get(self.run)

    @property
    def _motion(self) -> Motion:
        return self.study.motions[self.run]

    def _predicted(self, horizon: str, name: str) -> dict[str, Array]:
        return {
            model: getattr(by_run[self.run].horizons[horizon], name)
            for model, by_run in self.study.replays.items()
            if self.run in by_run
        }


# How models were replayed for the predictions that a figure shows.
REPLAY_KINDS = {
    "predicted_nu": f"{STANDARD_HORIZON} s windows",
    "predicted_nu_dot": f"{STANDARD_HORIZON} s windows",
    "predicted_position": "open loop",
}


# Attributes of ReportData that are a part of another one.
PART_OF = {"disturbance": "diagnosis"}


def read_by(figure: FigureKind) -> list[str]:
    """List the attributes of ReportData that a figure of the study is drawn of."""
    return [PART_OF.get(name, name) for name in figure.takes]


def list_study_figures() -> list[FigureKind]:
    """List the figures that are drawn once."""
    return [figure for figure in list_figures().values() if not _is_of_run(figure)]


def list_run_figures() -> list[FigureKind]:
    """List the figures that are drawn for each run."""
    return [figure for figure in list_figures().values() if _is_of_run(figure)]


def _is_of_run(figure: FigureKind) -> bool:
    if set(figure.needs) <= vars(RunData).keys():
        return True
    attributes = (*(result.name for result in fields(ReportData)), *vars(ReportData))
    refuse_unknown(figure, (name for name in attributes if not name.startswith("_")))
    return False


def describe_figure(figure: str, run: str, data: ReportData | None = None) -> str:
    """Say in a few words what a figure of one run shows; empty for a figure of all runs."""
    if not run:
        return ""
    needs = find_figure(figure).needs
    words = [
        f"run {run}",
        *dict.fromkeys(REPLAY_KINDS[name] for name in needs if name in REPLAY_KINDS),
    ]
    if "budget" in needs and data and (budget := data.budgets.get(run)):
        words.append(f"model {title(budget.model)}")
    return ", ".join(words)
