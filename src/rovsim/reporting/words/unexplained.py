"""Say what no effect explains: a law for it, or the force in time."""

from rovsim.core.axes import AXES, FORCE_UNITS
from rovsim.reporting.wording import ERROR_NAME, listed, percent, significant
from rovsim.reporting.words.intervals import interval
from rovsim.results.base import or_nan
from rovsim.results.diagnosis import Diagnosis, Unexplained

MAX_TOLD_PUSHES = 3  # moments of a disturbance that are told
MAX_TOLD_RUNS = 6  # whose values of an effect are told


def leaves_unexplained(diagnosis: Diagnosis) -> bool:
    """Whether significant physics without a law is left, which was then fitted as noise."""
    return diagnosis.unexplained.significant and diagnosis.unexplained.proposal is None


def unexplained_sentences(diagnosis: Diagnosis) -> list[str]:
    """Say what no effect of the catalogue explains; empty if that is not significant."""
    unexplained = diagnosis.unexplained
    return (
        [f"Unexplained: {unexplained.hint}", *_tell_runs(unexplained), *_law_sentences(diagnosis)]
        if unexplained.significant
        else []
    )


def _tell_runs(unexplained: Unexplained) -> list[str]:
    """Say which value of an effect each run would have; of many runs, of the first of them."""
    by_run = unexplained.between_runs or {}
    told = [
        f"{', '.join(f'{name} {interval(v)}' for name, v in one.parameters.items())} in {run}"
        for run, one in by_run.items()
    ]
    if not told:
        return []
    effect = next(iter(by_run.values())).effect
    more = len(told) - MAX_TOLD_RUNS
    others = f" (and {more} more in diagnosis.json)" if more > 0 else ""
    return [
        f"As if {effect} had another value in each run: {'; '.join(told[:MAX_TOLD_RUNS])}{others}."
    ]


def _law_sentences(diagnosis: Diagnosis) -> list[str]:
    """Say which law is proposed for what is unexplained, how good it is, and how to use it."""
    law = diagnosis.unexplained.proposal
    if law is None:
        return _disturbance_sentences(diagnosis)
    values = ", ".join(f"{name} {interval(v)}" for name, v in law.parameters.items())
    sentence = f"It removes {percent(law.error_reduction)} of the error on the train runs"
    step = next((s for s in diagnosis.ladder.models if s.model == f"+{law.effect}"), None)
    if step is not None and step.windows_2s is not None:
        sentence += f"; with it the {ERROR_NAME} on the test runs is {significant(step.windows_2s)}"
    if replaced := {*diagnosis.unexplained.stand_ins} - {f.effect for f in diagnosis.selected}:
        sentence += f". It does without {listed(sorted(replaced))}, which explained part of it"
    return [
        f"A law for it: {law.meaning} {law.equation} with {values}. {sentence}.",
        f"It is in the file {law.file}. Read it, change it if you like, and add it with "
        f"`rovsim add diagnosis=… effects_file={law.file} model=NEW.yaml`.",
    ]


def _disturbance_sentences(diagnosis: Diagnosis) -> list[str]:
    """Say how large the force without a law is, how fast it changes, and when it is strongest."""
    force = diagnosis.unexplained.disturbance
    if force is None:
        return []
    low, high = force.band_hz
    sizes = [
        f"{a} {significant(or_nan(force.rms[a]), 2)} {FORCE_UNITS[AXES.index(a)]}"
        for a in force.axes
    ]
    text = f"No law was found for it: a disturbance of {listed(sizes)} (RMS)."
    text += f" Most of its power lies between {low:.2g} and {high:.2g} Hz."
    times = [
        f"{p.time_s:.1f} s of run {p.run} ({p.axis})" for p in force.strongest[:MAX_TOLD_PUSHES]
    ]
    return [text + (f" It was strongest at {listed(times)}." if times else "")]
