"""Write the report's summary; a sentence says only what its numbers show."""

import math
from typing import Mapping, Sequence

import numpy as np
from pandas import DataFrame, Series

from rovsim.core.axes import AXES, VELOCITY_UNITS
from rovsim.core.horizons import STANDARD_HORIZON
from rovsim.core.model_names import EFFECTS, NOISE_FLOOR, NOMINAL, PROPOSED, ZERO_ACCELERATION
from rovsim.reporting.figures.palette import family, is_learned
from rovsim.reporting.figures.pooled import pool, relate
from rovsim.reporting.report_data import ReportData
from rovsim.reporting.wording import (
    ERROR_NAME,
    FLOOR_COUNTS_ALL,
    LADDER_STEP,
    listed,
    several,
    significant,
    title,
)
from rovsim.reporting.words.speed import timing_sentences
from rovsim.reporting.words.unexplained import leaves_unexplained
from rovsim.results.bands import Bands, ModelBands
from rovsim.results.ladder import Ladder
from rovsim.results.quality import Quality

CHANGE_TOLERANCE = 0.01  # share: a smaller change is called none
FLOOR_TOLERANCE = 0.05  # the noise floor is an estimate itself


def summarize(data: ReportData) -> list[str]:
    """Return the summary, one string per paragraph; nothing without a comparison."""
    if data.comparison is None:
        return []
    errors = pool(data.comparison, "velocity_rmse", STANDARD_HORIZON, "test")
    steps = scores(data.ladder) if data.ladder else {}
    paragraphs = [
        runs_sentences(data.quality),
        nominal_sentences(errors) + quiet_sentences(data.quality),
        residual_sentences(errors, steps),
        ladder_sentences(steps, bool(data.diagnosis and leaves_unexplained(data.diagnosis))),
        timing_sentences(data.timing) if data.timing else [],
        band_sentences(data.band_coverage) if data.band_coverage else [],
    ]
    return [" ".join(sentences) for sentences in paragraphs if sentences]


def band_sentences(coverage: Bands) -> list[str]:
    """Say how much of the test runs lies inside the bands of each model."""
    return [
        f"Inside the {coverage.level:.0%} bands of {title(name)} lie {listed(_say_shares(model))}."
        for name, model in coverage.models.items()
    ]


def _say_shares(model: ModelBands) -> list[str]:
    """Say which share of the velocities at the ends of windows is inside, by length of the window.

    All test runs and axes are pooled.
    """
    by_duration: dict[str, list[tuple[float, int]]] = {}
    for run in model.runs.values():
        for seconds, windows in run.windows.items():
            share = float(np.nanmean(windows.at_end.array())) if windows.windows else 0.0
            by_duration.setdefault(seconds, []).append((share, windows.windows))
    phrases = []
    for seconds, parts in by_duration.items():
        shares, counts = np.array(parts).T
        if counts.sum():
            mean = float(shares @ counts / counts.sum())
            phrases.append(f"{mean:.0%} of the measured velocities after {seconds} s")
    return phrases


def scores(ladder: Ladder) -> dict[str, float]:
    """Return {step: windows_2s}, steps without a number left out."""
    return {step.model: step.windows_2s for step in ladder.steps if step.windows_2s is not None}


def runs_sentences(quality: Mapping[str, Quality]) -> list[str]:
    """Say how many runs there are, and how many of them are held out."""
    if not quality:
        return []
    test_runs = [run for run, report in quality.items() if report.split == "test"]
    count = _count(len(quality), "run")
    return [f"The campaign has {count}, {len(test_runs)} of them held out for tests."]


def doubt_sentences(quality: Mapping[str, Quality]) -> list[str]:
    """Say what can make results wrong: each doubt once, with the runs that it concerns."""
    runs: dict[str, list[str]] = {}
    for run, report in quality.items():
        for doubt in report.doubts:
            runs.setdefault(doubt, []).append(run)
    return [f"{several(names)}: {doubt}" for doubt, names in runs.items()]


def nominal_sentences(errors: DataFrame) -> list[str]:
    """Say how far the nominal model is from the measurement, and whether it beats doing nothing."""
    row = errors.reindex([NOMINAL]).loc[NOMINAL]
    if row.isna().all():
        return ["The nominal model has no result on the test runs."]
    parts = [
        f"{significant(value, 2)} {unit} in {axis}"
        for axis, unit, value in zip(AXES, VELOCITY_UNITS, row, strict=True)
        if np.isfinite(value)
    ]
    missing = row.index[row.isna()]
    return [
        "The nominal model was replayed on the test runs, restarted from the measured state every "
        f"2 s. It misses the measured velocity by {listed(parts)} (root mean square).",
        *([f"It has no value in {listed(missing)}."] if len(missing) else []),
        *_against_nothing(errors),
    ]


def _against_nothing(errors: DataFrame) -> list[str]:
    ratio = relate(errors, ZERO_ACCELERATION).loc[NOMINAL]
    if ratio.isna().all():
        return []
    beaten = ratio.index[ratio >= 1 - CHANGE_TOLERANCE]
    if len(beaten):
        return [f"In {listed(beaten)} it is no better than a vehicle that keeps its velocity."]
    axes = "every axis with a value" if ratio.isna().any() else "every axis"
    return [f"On {axes} it is better than a vehicle that simply keeps its velocity."]


def quiet_sentences(quality: Mapping[str, Quality]) -> list[str]:
    """Name the axes that hardly moved on any test run: nothing can be judged there."""
    tests = [report for report in quality.values() if report.split == "test"]
    measured = {axis for report in tests for axis in report.excitation}
    moved = {axis for report in tests for axis in report.excited}
    quiet = [axis for axis in AXES if axis in measured - moved]
    if not quiet:
        return []
    return [f"The test runs hardly move in {listed(quiet)}: errors there say little about a model."]


def residual_sentences(errors: DataFrame, steps: Mapping[str, float]) -> list[str]:
    """Say which learned residual lowers the nominal error most, where, and where it does not."""
    if not any(is_learned(name) for name in (*errors.index, *steps)):
        return []
    ratios, measure = _overall(errors, steps)
    residuals = {name: ratio for name, ratio in ratios.items() if is_learned(name)}
    learned = {name: ratio for name, ratio in residuals.items() if math.isfinite(ratio)}
    if not learned:
        return ["No learned residual can be compared with the nominal model on the test runs."]
    best = min(learned, key=lambda name: learned[name])
    return [
        _best_sentence(title(best), learned[best], len(learned), measure),
        *_effects_alone(ratios, learned[best]),
        *_per_axis(relate(errors).reindex([best]).loc[best]),
        *_tell_others(learned, best),
        *_without_value([title(name) for name in residuals if name not in learned]),
    ]


def _without_value(names: Sequence[str]) -> list[str]:
    if not names:
        return []
    verb = "has" if len(names) == 1 else "have"
    return [f"{listed(names)} {verb} no value: a replay came to no end."]


def _overall(errors: DataFrame, steps: Mapping[str, float]) -> tuple[dict[str, float], str]:
    """Return the error of each model divided by that of nominal, and what that error measures."""
    if steps.get(NOMINAL) and any(is_learned(name) for name in steps):
        ratios = {name: value / steps[NOMINAL] for name, value in steps.items()}
        return ratios, f"the {ERROR_NAME}"
    rows = relate(errors)
    has_value = rows.reindex([NOMINAL]).loc[NOMINAL].notna()
    if not has_value.any():
        return {}, ""
    return (
        rows.loc[:, has_value].mean(axis=1, skipna=False).to_dict(),
        "the velocity RMSE in 2 s windows, relative to nominal, mean over the axes",
    )


def _best_sentence(best: str, ratio: float, count: int, measure: str) -> str:
    subject = "The learned residual" if count == 1 else f"Of {count} learned residuals,"
    if ratio < 1 - CHANGE_TOLERANCE:
        verb = "lowers" if count == 1 else "lowers the error most:"
        tail = (
            f" {measure} by {_percent(1 - ratio)}" if count == 1 else f" by {_percent(1 - ratio)}"
        )
        text = f"{subject} {best} {verb}{tail}"
        return f"{text}." if count == 1 else f"{text} ({measure})."
    change = (
        "leaves the error as it is"
        if ratio <= 1 + CHANGE_TOLERANCE
        else f"raises the error by {_percent(ratio - 1)}"
    )
    if count == 1:
        return f"The learned residual {best} does not help: it {change} ({measure})."
    return f"None of the {count} learned residuals helps; the best, {best}, {change} ({measure})."


def _effects_alone(ratios: Mapping[str, float], learned: float) -> list[str]:
    """Say that effects without a residual are better than `learned`, if they are.

    Args:
        ratios: error of each model, divided by that of nominal.
        learned: the lowest ratio of a model with a residual.
    """
    # in a ladder each effect is added to those above; the last step may be a proposed equation
    steps = {
        name: r for name, r in ratios.items() if name == EFFECTS or LADDER_STEP.fullmatch(name)
    }
    alone = [r for name, r in steps.items() if name != f"+{PROPOSED}"][-1:]
    if alone:
        return [
            f"But the effects alone lower it by {_percent(1 - r)}." for r in alone if r < learned
        ]
    files = {name: r for name, r in ratios.items() if family(name) == EFFECTS}  # files of users
    best = min(files, key=lambda name: files[name], default=None)
    if best is None or not files[best] < learned:
        return []
    return [f"But {title(best)}, which has no residual, lowers it by {_percent(1 - files[best])}."]


def _per_axis(row: Series) -> list[str]:
    if row.isna().all():
        return []
    lower = [f"{a} (−{_percent(1 - r)})" for a, r in row.items() if r < 1 - CHANGE_TOLERANCE]
    equal = [a for a, r in row.items() if abs(r - 1) <= CHANGE_TOLERANCE]
    worse = [f"{a} (+{_percent(r - 1)})" for a, r in row.items() if r > 1 + CHANGE_TOLERANCE]
    groups = (("lower in", lower), ("the same in", equal), ("higher in", worse))
    parts = [f"{phrase} {listed(axes)}" for phrase, axes in groups if axes]
    return [f"Axis by axis its velocity RMSE is {'; '.join(parts)}."]


def _tell_others(learned: Mapping[str, float], best: str) -> list[str]:
    failing = [
        f"{title(name)} (+{_percent(r - 1)})"
        if r > 1 + CHANGE_TOLERANCE
        else f"{title(name)} (no change)"
        for name, r in learned.items()
        if name != best and r >= 1 - CHANGE_TOLERANCE
    ]
    return [f"Not better than nominal: {listed(failing)}."] if failing else []


def ladder_sentences(steps: Mapping[str, float], unexplained: bool) -> list[str]:
    """Say which model has the lowest error, and how far the noise floor is below it.

    Args:
        steps: 2 s error of each step of the ladder.
        unexplained: whether unexplained physics counts as noise in the noise floor.
    """
    models = {name: value for name, value in steps.items() if name != NOISE_FLOOR}
    if len(models) < 2:
        return []
    best = min(models, key=lambda name: models[name])
    text = f"The lowest {ERROR_NAME} is {significant(models[best])}, that of {title(best)}"
    others = [
        f"{title(n)} has {significant(models[n])}"
        for n in (NOMINAL, ZERO_ACCELERATION)
        if n in models and n != best
    ]
    sentences = [f"{text}; {listed(others)}." if others else f"{text}."]
    floor = steps.get(NOISE_FLOOR, 0.0)
    if floor > 0 and unexplained:
        sentences.append(FLOOR_COUNTS_ALL.format(significant(floor)))
    elif floor > 0:
        sentences.append(_floor_sentence(models[best] / floor, floor))
    return sentences


def _floor_sentence(ratio: float, floor: float) -> str:
    if ratio <= 1 + FLOOR_TOLERANCE:
        return (
            f"It reaches the noise floor, {significant(floor)}. With these recordings no model can "
            "be shown to be better."
        )
    return (
        f"A perfect model would show about {significant(floor)} (noise floor); "
        f"the best is {significant(ratio, 2)} times that."
    )


def _percent(share: float) -> str:
    return f"{100 * share:.0f}\u202f%" if share >= 0.1 else f"{significant(100 * share, 2)}\u202f%"


def _count(number_of: int, what: str) -> str:
    return f"{number_of} {what}" if number_of == 1 else f"{number_of} {what}s"
