"""`diagnosis.json`: which physical effects a model lacks, and how sure that is."""

from pathlib import Path
from typing import ClassVar, Literal

from pydantic import Field, JsonValue

from rovsim.core.model_names import PROPOSED
from rovsim.core.schema import Section
from rovsim.results.base import ByAxis, Result
from rovsim.results.error_conditions import ConditionShare
from rovsim.results.fitted import (
    FittedEffect,
    FittedNoise,
    FittedValue,
    Posterior,
    SelectedEffect,
)
from rovsim.results.ladder import Ladder

LAW_FILE = f"{PROPOSED}.py"  # its file, beside the diagnosis
Verdict = Literal["missing_effects", "adequate", "unexplained", "insufficient_data"]


class ProposedTerm(Section):
    """A term of a law: what it acts `on`, the quantities it varies with, its RMS in N or N m."""

    on: str
    quantities: tuple[str, ...]
    size: float | None


class RivalLaw(Section):
    """A law tried in its place; `deficit` in -2 log likelihood, with penalties."""

    equation: str
    deficit: float | None


class ProposedEquation(Section):
    """A law for what no effect of the catalogue explains: the effect in `file`, and its values.

    `axis` on which it acts most; `error_reduction` of the base's error, on top of the effects
    `beside` it, which have the values that they have with it.
    """

    axis: str
    equation: str
    file: str
    parameters: dict[str, FittedValue]
    error_reduction: float | None
    effect: str
    meaning: str
    terms: tuple[ProposedTerm, ...]
    beside: tuple[FittedEffect, ...] = ()
    rivals: tuple[RivalLaw, ...] = ()


class StrongMoment(Section):
    """A moment of a disturbance: N or N m on one body axis, at a place in MoCap coordinates, m."""

    run: str
    time_s: float
    axis: str
    force: float
    place_m: tuple[float, float, float]


class ForceOfRun(Section):
    """Force of a disturbance along one run: N, N m along the body's axes at places in MoCap m."""

    run: str
    time_s: tuple[float, ...]
    place_m: tuple[tuple[float, float, float], ...]
    force: tuple[tuple[float, float, float, float, float, float], ...]


class ForceSpectrum(Section):
    """One-sided power spectral `density` of a disturbance, N²/Hz and (N m)²/Hz by body axis.

    Mean over the train runs, at frequencies Hz. What pushes all the time is not in it.
    """

    frequency_hz: tuple[float, ...]
    density: tuple[tuple[float, float, float, float, float, float], ...]


class Disturbance(Section):
    """What pushes and follows no law: `rms` N, N m; `axes` on which it is more than noise.

    Four fifths of its power on the strongest of these lie in `band_hz`. No `spectrum` in files of
    earlier versions.
    """

    axes: tuple[str, ...]
    rms: ByAxis
    band_hz: tuple[float, float]
    strongest: tuple[StrongMoment, ...]
    runs: tuple[ForceOfRun, ...]
    spectrum: ForceSpectrum | None = None


class Unexplained(Section):
    """Structure that no effect of the catalogue explains: its share of the disturbance's power.

    `proposal`: an equation for it, where one holds; `disturbance`: the force in time, where none
    does; `stand_ins`: effects that were accepted, and that an equation which was tried does
    without, or changes by more than half. Those that a proposed one does without are not selected.
    `between_runs`: an effect that has another value in each run, by the run's id.
    """

    fraction: float | None
    significant: bool
    hint: str
    proposal: ProposedEquation | None = None
    stand_ins: tuple[str, ...] = ()
    disturbance: Disturbance | None = None
    between_runs: dict[str, FittedEffect] | None = None


# Of 154 cases of the blind benchmark whose train runs leave nothing, one is above 1.1: 1.8, a small
# cubic drag in water that wanders.
MIN_TIMES_FLOOR = 1.5


class DiagnosisErrors(Section):
    """`windows_2s` on the test runs: of the base, with the selected effects, of a perfect model."""

    nominal: float | None
    with_effects: float | None
    noise_floor: float | None


def times_above_floor(verdict: Verdict, times_floor: float | None) -> float | None:
    """How many times the noise floor the error with effects is, where test runs surely differ.

    None where it is near the floor, or where the train runs leave more than noise, too.

    Args:
        verdict: on the train runs.
        times_floor: see `Diagnosis`.
    """
    nothing_left = verdict in ("adequate", "missing_effects")
    above = nothing_left and times_floor is not None and times_floor > MIN_TIMES_FLOOR
    return times_floor if above else None


class RivalEffect(Section):
    """An effect tried `instead_of` another; `deficit` in -2 log likelihood."""

    effect: str
    instead_of: str
    deficit: float | None


class ScaleOfForces(Section):
    """A factor of all forces and inertia that the runs leave open, and what goes along with it.

    `std` relative; `parameters` as `effect.parameter`.
    """

    std: float | None
    parameters: tuple[str, ...]


class LookedAt(Section):
    """How many s of the train runs were looked at, of how many there are.

    With all of them standard deviations would be up to `wider` times smaller.
    """

    seconds: float
    of: float
    wider: float


class Standstill(Section):
    """A run stands still although the model would gain speed: held by hand, or on the floor?

    From when to when, s; what the model would have `gained` (m/s, rad/s) on the `axis` on which
    that is most; `use`: what is left of the run, as campaign.yaml takes it.
    """

    run: str
    from_s: float
    to_s: float
    axis: str
    gained: float
    use: tuple[tuple[float, float], ...]


class Answer(Section):
    """What any method says is missing, the part of a diagnosis that can be judged by the truth."""

    verdict: Verdict
    selected: tuple[FittedEffect, ...]
    ranking: tuple[FittedEffect, ...] = ()
    indistinguishable: tuple[tuple[str, ...], ...] = ()
    not_observable: tuple[str, ...] = ()


class DisturbedEnd(Section):
    """The beginning or the end of a run leaves far more than the rest: moved by hand, lifted?

    From when to when, s; how many `times` as much (of variance).
    """

    run: str
    from_s: float
    to_s: float
    times: float


class Diagnosis(Result):
    """The verdict and all that led to it; `base` is the diagnosed model's file.

    `not_excited` axes that nobody moved, `not_measured` those that nobody measured;
    `not_commanded` thrusters and surfaces by name, or axes, that stayed at rest;
    `not_observable` effects that the runs could not show, were they there; `not_followed_from_s` s
    from which on the model runs away from a train run, by its id; `runs_away_in`: test runs in
    which it does so within 2 s, and has no error; `standstills` of train runs, and their
    `disturbed_ends` where these hold most of what is unexplained; `unlogged_s` of train runs that
    were not used, by run, as nobody knows what was commanded; `thrusters` their names in the
    vehicle file: the parameter `t1` of an effect is of the first. `recordings` that it is of: the
    start of each file's SHA-256, by its path from the campaign; empty in files of earlier versions.
    `times_floor`: how many times that of a perfect model the error with effects is in windows that
    begin 1 s after the log of commands or later: of what thrusters were told before, nobody knows.
    """

    noun: ClassVar[str] = "diagnosis"
    command: ClassVar[str] = "`rovsim diagnose`"

    schema_: Literal["rovsim.diagnosis/1"] = Field(default="rovsim.diagnosis/1", alias="schema")
    verdict: Verdict
    selected: tuple[SelectedEffect, ...]
    ranking: tuple[FittedEffect, ...]
    indistinguishable: tuple[tuple[str, ...], ...]
    known_together: tuple[tuple[str, ...], ...] = ()
    common_scale: ScaleOfForces | None = None
    where: tuple[ConditionShare, ...]
    unexplained: Unexplained
    next_experiment: str
    error: DiagnosisErrors
    times_floor: float | None = None
    not_excited: tuple[str, ...] = ()
    not_measured: tuple[str, ...] = ()
    not_commanded: tuple[str, ...] = ()
    not_observable: tuple[str, ...] = ()
    rivals: tuple[RivalEffect, ...] = ()
    noise: FittedNoise = FittedNoise()
    posterior: Posterior | None = None
    looked_at: LookedAt | None = None
    not_followed_from_s: dict[str, float] = Field(default_factory=dict)
    runs_away_in: tuple[str, ...] = ()
    standstills: tuple[Standstill, ...] = ()
    disturbed_ends: tuple[DisturbedEnd, ...] = ()
    unlogged_s: dict[str, float] = Field(default_factory=dict)
    thrusters: tuple[str, ...] = ()
    recordings: dict[str, str] = Field(default_factory=dict)
    base: dict[str, JsonValue]
    ladder: Ladder

    @property
    def above_at_start(self) -> bool:
        """Whether only windows that begin with the log have an error far above the noise floor."""
        reached, floor = self.error.with_effects, self.error.noise_floor
        if not (reached and floor and self.times_floor):
            return False
        return self.times_floor <= MIN_TIMES_FLOOR < reached / floor

    @property
    def fitted(self) -> dict[str, FittedEffect]:
        """All that has values, by id: the selected effects first, with those of the final model."""
        selected = {s.effect: s for s in self.selected}
        return selected | {r.effect: r for r in self.ranking if r.effect not in selected}


def law_beside(diagnosis: Path) -> Path:
    """Where the file of the effect lies that a diagnosis proposes."""
    return diagnosis.with_name(
        LAW_FILE if diagnosis.stem == "diagnosis" else f"{diagnosis.stem}_{LAW_FILE}"
    )
