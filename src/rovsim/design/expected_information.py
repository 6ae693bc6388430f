"""The information expected of a flight, beside the train runs: smaller intervals, longer odds.

With H the information of the train runs about a hypothesis' parameters and J the derivatives of the
flight's white innovations, H + J J^T is that of both. Where the first rival is true, the second one
foresees the flight worse by what none of its parameters can take up:

    min over x of |e + J^T x|^2 + x^T H x,

e being its innovations there and x how far its parameters move from where the train runs left
them: all that its effect has, since with the flight a diagnosis frees others than before it. What
is left a diagnosis would take for noise, as far as it can: of each axis and octave, with power P
beside n readings' worth of noise, not P but n log(1 + P / n) counts. Half of that is what the
logarithm of the odds is expected to gain.
"""

from dataclasses import dataclass

import numpy as np
from numpy import ndarray as Array

from rovsim.core.run import Commands
from rovsim.design.prior_information import FittedHypothesis, PriorInformation
from rovsim.design.record import record
from rovsim.design.recording_setup import RecordingSetup
from rovsim.estimation.fit import REACH
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.innovations import estimate_errors
from rovsim.estimation.observer.kalman import AxisErrorDynamics
from rovsim.estimation.observer.least_squares import gram, solve
from rovsim.estimation.observer.noise import design_filters
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.estimation.observer.residual_source import Linearised

NEGLIGIBLE = 1e-3  # of what the train runs hold: less is not worth a comparison
THINNED = 4  # of so many readings one is asked how errors go on: 0.2 s apart


@dataclass(frozen=True, eq=False)
class ExpectedInformation:
    """Of one flight.

    `std_ratio` (j,) for each rival: standard deviation now over then of what is asked for; `std`
    likewise then, scaled. `log_odds_gain` (r,): what the logarithm of the odds of each rival, were
    it true, is expected to gain; empty without rivals. `likely` (r,): the rivals that count; of
    others the gain is infinite where nobody asked for it.
    """

    std_ratio: tuple[Array, ...]
    std: tuple[Array, ...]
    log_odds_gain: Array
    likely: Array

    @property
    def utility(self) -> float:
        """What is to be as large as possible: the least of the gains that count, or information.

        Information in units of what the train runs hold, the geometric mean over what is asked for.
        """
        if len(self.log_odds_gain):
            return float(np.min(self.log_odds_gain[self.likely]))
        gained = np.maximum(self.std_ratio[0] ** 2 - 1.0, NEGLIGIBLE)
        return float(np.exp(np.mean(np.log(gained))))

    @property
    def informative(self) -> bool:
        """Whether it tells anything worth a flight about what is asked for."""
        if len(self.log_odds_gain):
            return self.utility > NEGLIGIBLE
        return bool((self.std_ratio[0] ** 2 - 1.0 > NEGLIGIBLE).any())


def expect_information(
    paths: Array,
    commands: Commands,
    prior: PriorInformation,
    setup: RecordingSetup,
    exact: bool = False,
) -> ExpectedInformation:
    """Of a flight whose path under each rival is (r, k+1, 13).

    `exact`: the train runs are observed anew, with filters that suit them and the flight together,
    as a diagnosis of all would. Else as they were seen without it, thrust is steady over each step
    of the observer, and where rivals are told apart nothing is asked of their parameters, nor of
    rivals that do not count.
    """
    if not exact:
        setup = setup.coarser
    information, gains, error_dynamics, alone = [], [], None, len(prior.rivals) == 1
    for k, (path, rival) in enumerate(zip(paths, prior.rivals, strict=True)):
        if not (exact or prior.likely[k]):
            information.append(np.zeros_like(rival.information))
            gains.append(np.inf)
            continue
        run = record(path, commands, rival.hypothesis.model, setup)
        if exact or error_dynamics is None:
            error_dynamics = _mix_error_dynamics(run, rival, prior)
        bank = _observe(run, rival, prior, error_dynamics, exact)
        own = bank.linearise(rival.hypothesis if exact or alone else rival.fixed)
        information.append(measure_information(bank, own, rival, prior))
        if not alone:
            gains.append(_expect_log_odds(bank, own, prior.rivals[1 - k], prior, exact))
    then = [one.std(of) for one, of in zip(prior.rivals, information, strict=True)]
    now = [one.std() for one in prior.rivals]
    std_ratio = tuple(a / b for a, b in zip(now, then, strict=True))
    return ExpectedInformation(std_ratio, tuple(then), np.array(gains), prior.likely)


def _mix_error_dynamics(
    run: ObservedRun, rival: FittedHypothesis, prior: PriorInformation
) -> tuple[AxisErrorDynamics, ...]:
    """How errors go on in the train runs and a flight, each as long as it lasts."""
    some = run.limited(np.arange(len(run.motion.time)) % THINNED == 0)
    own = np.array(estimate_errors(rival.hypothesis.model, [some]).by_axis)
    before, lasts = prior.seconds, float(run.reading_times[-1])
    both = (before * np.array(prior.error_dynamics) + lasts * own) / (before + lasts)
    return tuple(AxisErrorDynamics(float(d), float(k)) for d, k in both)


def _observe(
    run: ObservedRun,
    rival: FittedHypothesis,
    prior: PriorInformation,
    error_dynamics: tuple[AxisErrorDynamics, ...],
    exact: bool,
) -> FilterBank:
    """Filters for the flight, which is the last run, and where exact for the train runs."""
    runs = (*prior.runs, run) if exact else (run,)
    run_filters = tuple(design_filters(prior.noise.white, error_dynamics, w) for w in runs)
    return FilterBank(runs, error_dynamics, run_filters, rival.hypothesis.model)


def measure_information(
    bank: FilterBank, own: Linearised, rival: FittedHypothesis, prior: PriorInformation
) -> Array:
    """Information (k, k) of the flight, which is the last run of the bank: it takes none away.

    Filters that suit all runs together may see less of the train runs than their own did.
    """
    if not len(own.hypothesis.x):
        return np.zeros_like(rival.information)
    flight = [*(0.0 * J for J in own.J[:-1]), own.J[-1]]
    return np.asarray(gram(bank.flatten(flight, prior.noise)))


def _expect_log_odds(
    bank: FilterBank,
    true: Linearised,
    other: FittedHypothesis,
    prior: PriorInformation,
    exact: bool,
) -> float:
    """What the log odds against a rival, with all that it could free, gain where one is true.

    Its parameters stay within the reach that a fit gives them.
    """
    seen, held = bank.linearise(other.widest), other.widest_information
    if not seen.finite:
        seen, held = bank.linearise(other.hypothesis), other.information
    if not seen.finite:
        return np.inf
    beside = [a - b for a, b in zip(seen.e, true.e, strict=True)]
    beside = [*(0.0 * one for one in beside[:-1]), beside[-1]]  # what is known is judged already
    rows = [np.concatenate([e[None], J]) for e, J in zip(beside, seen.J, strict=True)]
    e, J = np.split(bank.flatten(rows, prior.noise), [1])
    e = e[0]
    near = np.eye(len(J)) / REACH**2 + (0.0 if exact else held)
    x = -solve(gram(J) + near, J @ e)
    left = (e + x @ J).reshape(6, -1)
    before = float(x @ near @ x)
    more = 0 if exact else prior.readings  # readings that it leaves as they were
    return 0.5 * (before + surprise(left, 1.0 + more / left.shape[1]))


def surprise(left: Array, lasting: float) -> float:
    """How much less likely innovations (6, n) are under the noise that suits them, twice the log.

    Noise of another spectrum takes up what is slow, or fast: in each octave the power that is left,
    P beside n of noise, costs n log(1 + P / n). `lasting` times as long the noise is to hold.
    """
    n = left.shape[1]
    numbers = np.full(n // 2 + 1, 2.0)  # a frequency has a sine and a cosine
    numbers[0] = 1.0
    if n % 2 == 0:
        numbers[-1] = 1.0  # the highest has no sine at the samples
    power = numbers * np.abs(np.fft.rfft(left, axis=1)) ** 2 / n
    octaves = np.concatenate([[0], 2 ** np.arange(int(np.log2(max(1, (n - 1) // 2))) + 1)])
    numbers = np.add.reduceat(numbers, octaves) * lasting
    return float(np.sum(numbers * np.log1p(np.add.reduceat(power, octaves, axis=1) / numbers)))
