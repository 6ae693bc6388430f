"""What figures and reports draw from: measured and predicted, by run and model."""

from dataclasses import dataclass, field
from typing import Any, Mapping, Sequence

import numpy as np

from rovsim.evaluation.budget import Budget
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.prediction import OPEN_LOOP, Replay

SHOWN = "2"  # horizon of the time series: long enough to drift, short enough to be fair


@dataclass(frozen=True, eq=False)
class Evidence:
    """Motions by run, replays by model and run, the JSON contents made from them, and budgets.

    A budget is that of one model, by run.
    """

    motions: Mapping[str, Motion]
    replays: Mapping[str, Mapping[str, Replay]]
    comparison: Mapping[str, Any] = field(default_factory=dict)
    growth: Mapping[str, Any] = field(default_factory=dict)
    ladder: Mapping[str, Any] = field(default_factory=dict)
    timing: Mapping[str, Any] = field(default_factory=dict)
    quality: Mapping[str, Any] = field(default_factory=dict)
    where: Mapping[str, Any] = field(default_factory=dict)
    diagnosis: Mapping[str, Any] = field(default_factory=dict)
    published_errors: Mapping[str, Any] = field(default_factory=dict)
    budgets: Mapping[str, Budget] = field(default_factory=dict)

    def predicted(self, run: str, horizon: str, name: str, models: Sequence[str]) -> dict:
        """One predicted quantity by model."""
        return {
            model: getattr(self.replays[model][run].horizons[horizon], name)
            for model in models
            if run in self.replays.get(model, {})
        }


# Figures drawn once, from the JSON contents of those names; and those drawn for every run.
ONCE = {
    "ranking": "diagnosis",
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


def arguments(figure: str, evidence: Evidence, run: str = "", models: Sequence[str] = ()) -> dict:
    """Keyword arguments of a figure's `draw`."""
    if figure in ONCE:
        return {ONCE[figure]: getattr(evidence, ONCE[figure])}
    if figure == "budget":
        found = evidence.budgets[run]
        return {"time": found.time, "parts": found.parts, "missing": found.missing}
    motion = evidence.motions[run]
    common = {"time": motion.time, "usable": motion.usable}
    if figure == "velocities":
        nu = evidence.predicted(run, SHOWN, "nu", models)
        return {**common, "nu": motion.nu, "predicted_nu": nu}
    if figure == "residual_series":
        nu_dot = evidence.predicted(run, SHOWN, "nu_dot", models)
        return {**common, "nu_dot": motion.nu_dot, "predicted_nu_dot": nu_dot}
    eta = evidence.predicted(run, OPEN_LOOP, "eta", models)
    tank = motion.site.tank if np.isfinite(motion.site.tank).all() else None
    return {**common, "eta": motion.eta, "predicted_eta": eta, "tank": tank}


def about(figure: str, run: str, evidence: Evidence | None = None) -> str:
    """What a figure of one run shows, in a few words."""
    if not run:
        return ""
    if figure == "budget":
        model = evidence.budgets[run].model if evidence and run in evidence.budgets else ""
        return f"run {run}, model {model}" if model else f"run {run}"
    return f"run {run}, {'open loop' if figure == 'path_3d' else f'{SHOWN} s windows'}"
