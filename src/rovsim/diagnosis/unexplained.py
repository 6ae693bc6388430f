"""What no effect of the catalogue explains, as `diagnosis.json` has it."""

from typing import Sequence

from rovsim.core.rounding import rounded, rounded_or_none
from rovsim.diagnosis.checks.run_differences import RunDifference
from rovsim.diagnosis.equations.describe import describe_force, describe_law
from rovsim.diagnosis.fitted_values import describe_values
from rovsim.diagnosis.structure.residual import Structure
from rovsim.diagnosis.train_diagnosis import TrainDiagnosis
from rovsim.results.diagnosis import Unexplained
from rovsim.results.fitted import FittedEffect

REFUSED_EFFECTS_HINT = (
    "What is left could only be explained by effects that make replays of held-out stretches worse."
)
TOO_LITTLE_DATA_HINT = "There is too little data to say what is left."

NOISE_HINT = "Nothing is left but noise."
TEST_RUNS_DIFFER_HINT = (
    "Nothing is left but noise in the train runs. The test runs differ from them: there the error "
    "is {:g} times the noise floor."
)


def describe_unexplained(diagnosis: TrainDiagnosis, times_above: float | None) -> Unexplained:
    """Report what no effect of the catalogue explains, and a law for it, where one was found.

    Args:
        diagnosis: of the train runs.
        times_above: how many times the noise floor the error is, where test runs surely differ.
    """
    if not diagnosis.enough:
        return Unexplained(fraction=None, significant=False, hint=TOO_LITTLE_DATA_HINT)
    if diagnosis.verdict != "unexplained":
        hint = NOISE_HINT
        if times_above:
            hint = TEST_RUNS_DIFFER_HINT.format(rounded(times_above, 2))
        return Unexplained(fraction=0.0, significant=False, hint=hint)
    share = diagnosis.structures[0].share if diagnosis.structures else None
    doubted = (s.term.id for s in diagnosis.selected if s.doubt == "stand_in")
    return Unexplained(
        fraction=rounded_or_none(share),
        significant=True,
        hint=_format_hint(diagnosis.structures, diagnosis.difference) or REFUSED_EFFECTS_HINT,
        between_runs=_describe_difference(diagnosis.difference),
        proposal=describe_law(diagnosis.proposed) if diagnosis.proposed else None,
        stand_ins=tuple(sorted({*diagnosis.replaced, *doubted})),
        disturbance=describe_force(diagnosis.disturbance) if diagnosis.disturbance else None,
    )


def _describe_difference(difference: RunDifference | None) -> dict[str, FittedEffect] | None:
    """Report an effect that has another value in each run, by the run's id."""
    if difference is None:
        return None
    return {
        run: FittedEffect(effect=one.term.id, parameters=describe_values(one.term, one.std))
        for run, one in difference.by_run.items()
    }


def _format_hint(structures: Sequence[Structure], difference: RunDifference | None) -> str:
    """Say on which axes something is left, and what it depends on; the most surprising first.

    Empty where nothing is left and runs do not differ.
    """
    if not structures:
        return f"Runs differ in {difference.effect_id}, and in nothing else." if difference else ""
    strongest = structures[0]
    # the first of each other axis
    by_axis = {s.axis: s.what for s in reversed(structures) if s.axis != strongest.axis}
    hint = f"{strongest.axis.capitalize()}: the remainder shows {strongest.what}."
    if by_axis:
        hint += f" Also {'; '.join(f'{axis}: {by_axis[axis]}' for axis in reversed(by_axis))}."
    if difference:
        how = "which explains most of it" if difference.explains else "as their commands show"
        hint += f" Runs differ in {difference.effect_id}, {how}."
    return hint
