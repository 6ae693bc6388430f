"""A small made-up study: the inputs of every figure, table and report, by argument name."""

from copy import deepcopy
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
from scipy.signal import lfilter

from rovsim.core.axes import AXES
from rovsim.diagnosis.equations.spectrum import find_spectrum
from rovsim.evaluation.error_conditions.conditions import SPEED_NAMES, Blocks, Condition
from rovsim.evaluation.error_conditions.entries import list_conditions
from rovsim.evaluation.error_conditions.findings import explain_errors
from rovsim.evaluation.error_conditions.search import SearchedModel
from rovsim.evaluation.held_out.published_errors import METRICS, Published, compare_published
from rovsim.results.comparison import Comparison
from rovsim.results.diagnosis import Diagnosis
from rovsim.results.error_conditions import BLOCK_S, THROUGHOUT, ErrorConditions
from rovsim.results.force_budget import ForceBudget
from rovsim.results.growth import Growth
from rovsim.results.ladder import Ladder
from rovsim.results.quality import Quality
from rovsim.results.timing import Timing

MODELS = (
    "nominal", "knn_3dof", "knn_6dof", "gp_3dof", "gp_6dof", "svgp_3dof", "svgp_6dof",
    "zero_acceleration",
)  # fmt: skip
RUNS = {"3dof-1": "train", "6dof-1": "train", "3dof-2": "test", "6dof-2": "test"}


def study(
    models: tuple[str, ...] = MODELS,
    runs: dict[str, str] = RUNS,
    duration: float = 40.0,
    seed: int = 0,
) -> dict[str, Any]:
    """Everything a figure may ask for by argument name; the caller's own to change."""
    return deepcopy(_study(models, tuple(runs.items()), duration, seed))


@cache
def _study(
    models: tuple[str, ...], splits: tuple[tuple[str, str], ...], duration: float, seed: int
) -> dict[str, Any]:
    """The search for conditions takes a second, and a hundred tests ask for the same study."""
    runs = dict(splits)
    rng = np.random.default_rng(seed)
    motion = _motion(duration, rng)
    ladder = _ladder(models, rng)
    found_missing = Diagnosis.model_validate(diagnosis(ladder))
    found = {
        **motion,
        "predicted_nu": {m: motion["nu"] + _drift(m, motion, rng) for m in models},
        "predicted_nu_dot": {m: motion["nu_dot"] + 2 * _drift(m, motion, rng) for m in models},
        "predicted_position": {m: _path(m, motion, rng) for m in models[:3]},
        "tank": np.array([[0.0, 10.0], [-5.0, 0.0], [-3.0, 0.0]]),
        "comparison": Comparison.model_validate(_comparison(models, runs, rng)),
        "growth": Growth.model_validate(_growth(models, rng)),
        "timing": Timing.model_validate(_timing(models, rng)),
        "ladder": Ladder.model_validate(ladder),
        "diagnosis": found_missing,
        "disturbance": found_missing.unexplained.disturbance,
        "quality": {
            run: Quality.model_validate(_quality(run, split, rng)) for run, split in runs.items()
        },
        "where": where(models, duration, seed),
        "budget": _budget(motion, rng),
    }
    tests = [run for run, split in runs.items() if split == "test"]
    return found | {"published_errors": published_errors(found["comparison"], tests, seed)}


def published_errors(comparison: dict[str, Any], runs: list[str], seed: int) -> dict[str, Any]:
    """Errors against those made up for three models; nobody demanded roll."""
    rng = np.random.default_rng(seed)

    def errors() -> dict[str, float]:
        return {metric: float(rng.uniform(0.05, 0.3)) for metric in METRICS}

    theirs = [
        Published(run, "12 features", model, axis, errors())
        for run in runs
        for model in ("zero_shot", "knn", "svgp")
        for axis in AXES
    ]
    moved = {run: dict.fromkeys(AXES, True) | {"roll": False} for run in runs}
    return compare_published(theirs, dict.fromkeys(runs, comparison), moved)


def driven(seconds: float, error: np.ndarray, seed: int = 0) -> Blocks:
    """Blocks (n,) of two made-up runs with these errors (n, 6), speeds and thrusts that wander."""
    rng, count = np.random.default_rng(seed), int(seconds / BLOCK_S)
    slow = lfilter([1.0], [1.0, -0.8], rng.standard_normal((2 * count, 12)), axis=0)
    kinds = [Condition(THROUGHOUT, "", THROUGHOUT)]
    kinds += [Condition(n, "m/s", "speed", a) for n, a in zip(SPEED_NAMES, AXES, strict=True)]
    kinds += [Condition(f"{a} thrust", "N", "thrust", a) for a in AXES]
    columns = np.column_stack([np.zeros(2 * count), 0.2 * slow[:, :6], 10 * slow[:, 6:]])
    values = dict(zip(kinds, columns.T, strict=True))
    time = np.tile(BLOCK_S * (np.arange(count) + 0.5), 2)
    run = np.repeat([0, 1], count)
    return Blocks(error, rng.standard_normal((2 * count, 6)), values, time, run, np.ones(6, bool))


def where(models: tuple[str, ...], seconds: float, seed: int) -> ErrorConditions:
    """Conditions of models whose surge error grows with the speed."""
    found = []
    for k, name in enumerate(models):
        empty = driven(seconds, np.zeros((2 * int(seconds / BLOCK_S), 6)), seed)
        speed = next(x for c, x in empty.values.items() if c.name == "surge speed")
        noise = np.random.default_rng(k).standard_normal(empty.error.shape)
        error = _level(name) * (0.1 * noise + np.outer(speed * np.abs(speed), [1, 0, 0, 0, 0, 0]))
        found.append(
            SearchedModel(name, "train", ("3dof-1",), explain_errors(replace(empty, error=error)))
        )
    return list_conditions(found)


def _budget(motion: dict[str, Any], rng: np.random.Generator) -> ForceBudget:
    names = ("weight and buoyancy", "Coriolis", "quadratic damping", "thrusters", "+lift")
    parts = {n: motion["nu"] * rng.uniform(-20, 20, 6) for n in names}
    parts["+current"] = 1e-3 * motion["nu"]
    missing = np.where(motion["usable"][:, None], 3 * motion["nu_dot"], np.nan)
    return ForceBudget("nominal", "3dof-2", motion["time"], parts, missing)


def _level(model: str) -> float:
    return {"nominal": 1.0, "zero_acceleration": 1.6}.get(model, 0.2 + 0.06 * len(model))


def _motion(duration: float, rng: np.random.Generator) -> dict[str, Any]:
    time = np.arange(0.0, duration, 0.02)
    phase = rng.uniform(0, 6, 6)
    scale = np.array([0.4, 0.3, 0.2, 0.3, 0.2, 0.6])
    rate = np.array([0.5, 0.7, 0.4, 1.1, 0.9, 0.6])
    nu = scale * np.sin(rate * time[:, None] + phase)
    nu_dot = scale * rate * np.cos(rate * time[:, None] + phase)
    nu_dot = nu_dot + 0.03 * rng.standard_normal(nu.shape)
    usable = (time < 0.4 * duration) | (time > 0.47 * duration)
    position = np.stack(
        [5 + 3 * np.sin(0.2 * time), -2.5 - 1.6 * np.cos(0.31 * time), -1.5 + np.sin(0.1 * time)], 1
    )
    return {"time": time, "nu": nu, "nu_dot": nu_dot, "usable": usable, "position": position}


def _drift(model: str, motion: dict[str, Any], rng: np.random.Generator) -> np.ndarray:
    time = motion["time"]
    shape = np.sin(0.8 * time[:, None] + rng.uniform(0, 6, 6))
    return 0.1 * _level(model) * shape * np.array([1, 1, 0.6, 1.5, 1, 2])


def _path(model: str, motion: dict[str, Any], rng: np.random.Generator) -> np.ndarray:
    away = np.linspace(0, 1.2 * _level(model), len(motion["time"]))[:, None]
    return motion["position"] + away * rng.uniform(-1, 1, 3)


def metrics(level: float, rng: np.random.Generator) -> dict[str, Any]:
    """Errors of one replay."""

    def axes(scale: float) -> dict[str, float]:
        return {a: float(scale * level * rng.uniform(0.7, 1.3)) for a in AXES}

    return {
        "acceleration_rmse": axes(0.12),
        "velocity_mae": axes(0.04),
        "velocity_rmse": axes(0.06),
        "position_rmse_m": 0.1 * level,
        "attitude_rmse_rad": 0.05 * level,
    }


def _comparison(models: tuple[str, ...], runs: dict[str, str], rng: Any) -> dict[str, Any]:
    return {
        "schema": "rovsim.comparison/1",
        "models": {
            m: {
                "runs": {
                    run: {
                        "split": split,
                        "control": run[:4],
                        "open_loop": metrics(3 * _level(m), rng),
                        "windows": {h: metrics(_level(m), rng) for h in ("0.5", "2", "5")},
                    }
                    for run, split in runs.items()
                }
            }
            for m in models
        },
    }


def _growth(models: tuple[str, ...], rng: Any) -> dict[str, Any]:
    horizon = np.arange(0.25, 5.01, 0.25)
    curve = {m: {a: _level(m) * rng.uniform(0.02, 0.05) for a in AXES} for m in models}
    return {
        "models": {
            m: {
                "horizon_s": horizon.tolist(),
                "velocity_rmse": {a: (c * np.sqrt(horizon)).tolist() for a, c in axes.items()},
            }
            for m, axes in curve.items()
        }
    }


def stats(median: float) -> dict[str, Any]:
    """STATS of one predictor."""
    worst = 9 * median
    return {
        "points": 2000,
        "features": 14,
        "outputs": 6,
        "calls": 99,
        "median_us": median,
        "p99_us": 2 * median,
        "p999_us": 4 * median,
        "max_us": worst,
        "misses": {str(r): int(4 * median > 1e6 / r) * 12 for r in (50, 100, 250, 1000)},
    }


def _timing(models: tuple[str, ...], rng: Any) -> dict[str, Any]:
    timed = [m for m in models if "dof" in m]
    return {
        "inference": {
            m: {"library": stats(150.0 * (k + 1)), "exported": stats(4.0 * (k + 1))}
            for k, m in enumerate(timed)
        }
    }


def _ladder(models: tuple[str, ...], rng: Any) -> dict[str, Any]:
    names = [*sorted(models, key=_level, reverse=True), "noise_floor"]
    steps = []
    for name in names:
        m = metrics(0.1 if name == "noise_floor" else _level(name), rng)
        step = {"model": name, "split": "test", "acceleration_rmse": m["acceleration_rmse"]}
        level = 0.1 if name == "noise_floor" else _level(name)
        steps.append({**step, "velocity_mae": m["velocity_mae"], "windows_2s": 0.31 * level})
    return {"schema": "rovsim.ladder/1", "steps": steps}


def diagnosis(ladder: dict[str, Any]) -> dict[str, Any]:
    """`diagnosis.json` that selects two effects, one of which shows only beside the other."""
    drag = {"surge": {"value": 79.4909, "std": 0.755757, "unit": "N s2/m2"}}
    lag = {"time_constant": {"value": 0.15, "std": 0.004, "unit": "s"}}
    alone = {"quadratic_damping": 0.38, "linear_damping": 0.36, "lift": 0.18, "clock_drift": 0.0}
    return {
        "schema": "rovsim.diagnosis/1",
        "verdict": "unexplained",
        "selected": [
            {
                "effect": "thruster_lag",
                "parameters": lag,
                "error_reduction": 0.42,
                "probability": 0.97,
            },
            {
                "effect": "quadratic_damping",
                "parameters": drag,
                "error_reduction": 0.36,
                "probability": 1.0,
            },
        ],
        "ranking": [
            {"effect": name, "error_reduction": share, "probability": 0.1, "parameters": {}}
            for name, share in alone.items()
        ],
        "indistinguishable": [["input_delay", "thruster_lag"]],
        "where": [{"axis": "surge", "condition": "surge speed", "share_of_error": 0.9}],
        "unexplained": {
            "fraction": 0.2,
            "significant": True,
            "hint": "Sway: a push at 24 s.",
            "disturbance": disturbance(),
        },
        "next_experiment": "Drive steps.",
        "error": {"nominal": 0.19, "with_effects": 0.044, "noise_floor": 0.0435},
        "not_excited": ["roll", "pitch"],
        "rivals": [
            {"effect": "input_delay", "instead_of": "thruster_lag", "deficit": 2.0},
            {"effect": "linear_damping", "instead_of": "quadratic_damping", "deficit": 9.0},
        ],
        "noise": {},
        "base": {"schema": "rovsim.model/1", "vehicle": "bluerov2_heavy", "effects": []},
        "ladder": ladder,
    }


def several_effects() -> Diagnosis:
    """A diagnosis of four effects, with a ranking as sharp as real ones, and a disturbance.

    The one effect that the ranking is sure of removes the least error by itself.
    """
    lag = {"time_constant": {"value": 0.15, "std": 0.004, "unit": "s"}}
    values = {
        "thruster_lag": lag,
        "thrust_asymmetry": {"ratio": {"value": 0.9, "std": 0.01, "unit": "1"}},
        "voltage_sag": {
            "fraction": {"value": 0.1, "std": 0.01, "unit": "1"},
            "rate": {"value": 0.002, "std": 0.0001, "unit": "1/s"},
        },
        "net_buoyancy": {"force": {"value": -3.0, "std": 0.1, "unit": "N"}},
    }
    selected = [
        {"effect": name, "parameters": given, "error_reduction": 0.2, "probability": 1.0}
        for name, given in values.items()
    ]
    values["quadratic_damping"] = {"surge": {"value": 40.0, "unit": "N s2/m2"}}
    alone = {
        "quadratic_damping": (0.4, 0.0), "linear_damping": (0.39, 1.84e-128), "lift": (0.3, 0.0),
        "thruster_lag": (0.29, 4e-7), "cubic_damping": (0.28, 0.0), "current": (0.27, 0.0),
        "thruster_gain": (0.26, 0.0), "net_buoyancy": (0.25, 0.0), "voltage_sag": (0.2, 0.03),
        "thrust_asymmetry": (0.02, 0.97), "input_delay": (0.0, 0.0),
    }  # fmt: skip
    ranking = [
        {
            "effect": name,
            "error_reduction": share,
            "probability": sure,
            "parameters": values.get(name, {}),
        }
        for name, (share, sure) in alone.items()
    ]
    found = diagnosis({"steps": []}) | {"verdict": "missing_effects", "selected": selected}
    return Diagnosis.model_validate(found | {"ranking": ranking, "indistinguishable": []})


def disturbance() -> dict[str, Any]:
    """A push in sway at 24 s, as a vehicle goes round."""
    t = np.arange(0.0, 60.0, 0.5)
    place = np.stack([5.0 + np.cos(0.2 * t), 2.5 + np.sin(0.2 * t), 0.0 * t], 1)
    force = np.outer(6.0 * np.exp(-((t - 24.0) ** 2)), [0.0, 1.0, 0.0, 0.0, 0.0, 0.0])
    found = find_spectrum([force], 0.5)
    run = {
        "run": "6dof-1",
        "time_s": t.tolist(),
        "place_m": place.tolist(),
        "force": force.tolist(),
    }
    push = {
        "run": "6dof-1",
        "time_s": 24.0,
        "axis": "sway",
        "force": 6.0,
        "place_m": [5.1, 1.5, 0.0],
    }
    return {
        "axes": ["sway"],
        "rms": {"sway": 0.9},
        "band_hz": [0.02, 0.4],
        "strongest": [push],
        "runs": [run],
        "spectrum": {
            "frequency_hz": found.frequency.tolist(),
            "density": found.density.tolist(),
        },
    }


def _quality(run: str, split: str, rng: Any) -> dict[str, Any]:
    std = 0.5 * rng.uniform(0.0, 1.0, 6)
    gaps = [{"start_s": 12.0, "duration_s": 0.31}, {"start_s": 30.0, "duration_s": 2.5}]
    return {
        "schema": "rovsim.quality/1",
        "run": run,
        "split": split,
        "control": run[:4],
        "rate_hz": {"nominal": 100.0, "median": 99.98},
        "duration_s": 59.99,
        "frames": 6000,
        "not_found": 281,
        "longest_gap_s": 2.5,
        "gaps": gaps,
        "outliers": 7,
        "repairs": {"duplicates": 3, "unsorted": 2, "command_duplicates": 1},
        "commands": {
            "kind": "thruster",
            "lines": 3000,
            "start_s": 0.0,
            "end_s": 59.98,
            "median_step_s": 0.02,
            "longest_step_s": 0.04,
            "varies": True,
        },
        "excitation": {
            a: {"std": float(s), "unit": "m/s" if k < 3 else "rad/s", "excited": bool(s > 0.1)}
            for k, (a, s) in enumerate(zip(AXES, std, strict=True))
        },
        "noise": {"position_m": 0.0012, "attitude_rad": 0.004},
        "unusable": None,
        "remarks": ["The longest gap is 2.50 s; motion across it is not rebuilt."],
    }


def a_lag():
    """A diagnosis that selects a lag with a fitted value."""
    lag = {"effect": "thruster_lag", "parameters": {"time_constant": {"value": 0.18, "std": 0.01}}}
    content = diagnosis({"steps": []}) | {"selected": [lag], "ranking": []}
    return Diagnosis.model_validate(content)
