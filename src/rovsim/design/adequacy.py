"""Whether a model is good enough to be flown without looking, and why there may be no flight."""

from typing import Mapping, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.axes import ACCELERATION_UNITS, AXES
from rovsim.core.errors import BadInput
from rovsim.core.signs import minus
from rovsim.design.envelope import Envelope
from rovsim.design.expected_information import ExpectedInformation
from rovsim.design.inputs import ticks
from rovsim.design.low_frequency_disturbance import LowFrequencyDisturbance
from rovsim.design.prior_information import PriorInformation
from rovsim.design.search import DesignProblem
from rovsim.design.settings import Question
from rovsim.dynamics.model import Model
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.simulation.replay import predict as replay
from rovsim.simulation.windows import find_windows, last_predicted

MIN_STD_RATIO = 1.5  # times: beyond what two fits of the same runs differ by
WINDOW_SECONDS = 5.0  # s, the longest window of a comparison
NARROW_LIMITS_REASON = "one told to stay where it is does, none that moves enough to show anything"
MODEL_REMEDY = (
    "Give the model that a diagnosis found: what a model lacks is a disturbance. Or give fewer "
    "seconds, or wider design.limits."
)
DIAGNOSE_FIRST = (
    "Diagnose first (`rovsim diagnose`, `rovsim add`) and design with the model that this gives"
)


def warn_of_misfit(prior: PriorInformation, question: Question) -> tuple[str, ...]:
    """What speaks against the model, a sentence each; nothing where it follows its train runs.

    Of two rivals the likelier one is judged.
    """
    rival = max(range(len(prior.rivals)), key=lambda k: prior.rivals[k].two_log_likelihood)
    disturbance, model = prior.low_frequency[rival], prior.rivals[rival].hypothesis.model
    if not disturbance.large.any():
        return ()
    error = measure_replay_error(model, prior.runs, question)
    error_text = (
        "" if error is None else f", and after {WINDOW_SECONDS:g} s it is {error:.2g} m off"
    )
    return (
        f"The model errs on the train runs: {_name(disturbance)} push the vehicle all the time, of "
        f"which it does not know{error_text}. {DIAGNOSE_FIRST}.",
    )


def warn_of_walls(paths: Array, start: Array, envelope: Envelope) -> tuple[str, ...]:
    """How far paths (s, k+1, 13) lead from a start (3,) m NED, where no wall is known."""
    open_axes = ~np.isfinite(envelope.box[:2]).all(axis=1)
    if not open_axes.any():
        return ()
    reach = float(np.linalg.norm(paths[:, :, :2] - start[:2], axis=-1).max())
    return (
        "campaign.yaml has no tank, so that no wall is known: the flight begins in the middle of "
        f"where the train runs swam, and leads up to {reach:.1f} m away. Keep that much free, or "
        "describe the tank.",
    )


def warn_of_wider(model: Model, now: Mapping[str, float | None]) -> tuple[str, ...]:
    """What a model file knows less well than the train runs alone say, by `effect.parameter`."""
    file_std = {f"{e.id}.{name}": std for e in model.added for name, std in e.std.items()}
    wider = [
        name for name, std in now.items() if std and file_std.get(name, 0.0) > MIN_STD_RATIO * std
    ]
    if not wider:
        return ()
    return (
        f"{', '.join(wider)}: the model file has larger deviations than stand here. They hold what "
        "no flight takes away, as a factor that all forces have in common.",
    )


def _name(lasting: LowFrequencyDisturbance) -> str:
    return " and ".join(
        f"{minus(f'{lasting.mean[i]:.2g}')} {ACCELERATION_UNITS[i]} in {AXES[i]}"
        for i in np.flatnonzero(lasting.large)
    )


def measure_replay_error(
    model: Model, runs: Sequence[ObservedRun], question: Question
) -> float | None:
    """How far (m, root mean square) replays of the runs are off after `WINDOW_SECONDS`.

    None where no window is that long, or no place was measured.
    """
    squares = []
    for run in runs:
        motion = run.motion
        spans = list(find_windows(motion, WINDOW_SECONDS))
        if not spans:
            continue
        prediction = replay(model, motion, spans, question)
        last = last_predicted(motion, spans)
        error = prediction.eta[last, :3] - motion.eta[last, :3]
        squares += list(np.sum(error**2, axis=1))
    finite = np.array(squares)[np.isfinite(squares)] if squares else np.empty(0)
    return float(np.sqrt(finite.mean())) if len(finite) else None


def explain_infeasible(problem: DesignProblem, question: Question) -> BadInput:
    """Why no flight stays within the limits, as the error to be raised."""
    no_inputs = np.zeros((len(ticks(question.seconds)), len(AXES)))
    heading = problem.envelope.longest
    flight = next(problem.evaluate_all([no_inputs], [heading]))
    start = problem.pilot.starts(np.array([heading]))[0]
    paths = problem.scenarios.predict(problem.setup.drives(flight.commands), start)
    excess = problem.envelope.describe_excess(paths)
    reason = (
        f"a vehicle told to stay where it is already {excess}" if excess else NARROW_LIMITS_REASON
    )
    misfit = warn_of_misfit(problem.prior, question)
    fault = f"no flight of {question.seconds:g} s stays within the limits: {reason}"
    return BadInput(
        f"{fault}. {misfit[0].removesuffix('.')}" if misfit else fault,
        where="rovsim design",
        expected="room for a flight that nobody steers",
        remedy="Or give fewer seconds, or wider design.limits." if misfit else MODEL_REMEDY,
    )


def require_information(expected: ExpectedInformation, prior: PriorInformation) -> None:
    """Refuse the best flight where it tells nothing.

    Raises:
        BadInput: it adds less than a thousandth to what the train runs hold.
    """
    if expected.informative:
        return
    names = [rival.names[k] for rival in prior.rivals for k in rival.of_interest]
    raise BadInput(
        f"no flight within the limits tells anything about {', '.join(prior.rival_names or names)}",
        where="rovsim design",
        expected="limits within which the vehicle moves so that the answer shows",
        remedy="Widen design.limits (speed, turn_rate, tilt, slew), give more seconds, or ask "
        "about something else.",
    )
