"""The information expected of a flight, beside the train runs: smaller intervals, longer odds.

Let H be the information of the train runs about the parameters of a hypothesis, and J the
derivatives of the flight's white innovations to these. Then H + J J^T is the information of both.
If the first rival is true, the second one predicts the flight worse by what none of its parameters
can compensate:

    min over x of |e + J^T x|^2 + x^T H x,

where e are the innovations of the second rival, and x is how far its parameters move from their
values after the train runs. All parameters of its effect may move, since a diagnosis that includes
the flight may free other parameters than before. A diagnosis would take what is then left for
noise, as far as it can: in each axis and octave, power P beside n readings' worth of noise does not
count as P but as n log(1 + P / n). Half of the sum is the expected gain of the log odds.
"""

from dataclasses import dataclass

import numpy as np
from numpy import ndarray as Array

from rovsim.core.run import Commands
from rovsim.design.prior_information import FittedHypothesis, PriorInformation
from rovsim.design.record import record
from rovsim.design.recording_setup import RecordingSetup
from rovsim.estimation.fit import PRIOR_STD
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.innovations import estimate_errors
from rovsim.estimation.observer.kalman import AxisErrorDynamics
from rovsim.estimation.observer.least_squares import gram, solve
from rovsim.estimation.observer.noise import design_filters
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.estimation.observer.residual_source import Linearised

MIN_INFORMATION_GAIN = 1e-3  # of what the train runs hold: less is not worth a comparison
THINNING = 4  # the error dynamics are averaged over every fourth reading: 0.2 s apart


@dataclass(frozen=True, eq=False)
class ExpectedInformation:
    """The information that is expected of one flight.

    Attributes:
        std_ratio: (j,) for each rival: the standard deviation of each parameter that is asked about
            without the flight, over that with it.
        std: (j,) for each rival: the standard deviation with the flight, scaled.
        log_odds_gain: (r,) expected gain of the log odds of each rival, if it is the true one;
            empty where there is one hypothesis. Infinite for a rival whose gain was not computed.
        likely: (r,) which rivals the train runs have not ruled out; only these count.
    """

    std_ratio: tuple[Array, ...]
    std: tuple[Array, ...]
    log_odds_gain: Array
    likely: Array

    @property
    def utility(self) -> float:
        """What a design maximises.

        Between rivals, the least expected gain of the log odds. Else the information gained over
        that of the train runs, as the geometric mean over the parameters that are asked about.
        """
        if len(self.log_odds_gain):
            return float(np.min(self.log_odds_gain[self.likely]))
        gain = np.maximum(self.std_ratio[0] ** 2 - 1.0, MIN_INFORMATION_GAIN)
        return float(np.exp(np.mean(np.log(gain))))

    @property
    def informative(self) -> bool:
        """Whether the flight tells more than a negligible amount about what is asked."""
        if len(self.log_odds_gain):
            return self.utility > MIN_INFORMATION_GAIN
        return bool((self.std_ratio[0] ** 2 - 1.0 > MIN_INFORMATION_GAIN).any())


def expect_information(
    paths: Array,
    commands: Commands,
    prior: PriorInformation,
    setup: RecordingSetup,
    exact: bool = False,
) -> ExpectedInformation:
    """The information that is expected of a flight.

    Args:
        paths: states (r, k+1, 13) of the flight under each rival.
        commands: its command log.
        prior: what the train runs tell.
        setup: how the flight would be recorded.
        exact: observe the train runs anew, with filters that suit them and the flight together, as
            a diagnosis of all runs would. If not, a faster approximation is made: the train runs
            keep the information that they have by themselves, thrust is constant over each step of
            the observer, and between rivals the information about their parameters is left out, as
            is everything about a rival that is ruled out.
    """
    if not exact:
        setup = setup.coarser
    information, gains, error_dynamics, single = [], [], None, len(prior.rivals) == 1
    for k, (path, rival) in enumerate(zip(paths, prior.rivals, strict=True)):
        if not (exact or prior.likely[k]):
            information.append(np.zeros_like(rival.information))
            gains.append(np.inf)
            continue
        run = record(path, commands, rival.hypothesis.model, setup)
        if exact or error_dynamics is None:
            error_dynamics = _mix_error_dynamics(run, rival, prior)
        bank = _observe(run, rival, prior, error_dynamics, exact)
        linearised = bank.linearise(rival.hypothesis if exact or single else rival.fixed)
        information.append(measure_information(bank, linearised, rival, prior))
        if not single:
            gains.append(_expect_log_odds(bank, linearised, prior.rivals[1 - k], prior, exact))
    std_after = [r.std(info) for r, info in zip(prior.rivals, information, strict=True)]
    std_before = [r.std() for r in prior.rivals]
    std_ratio = tuple(a / b for a, b in zip(std_before, std_after, strict=True))
    return ExpectedInformation(std_ratio, tuple(std_after), np.array(gains), prior.likely)


def _mix_error_dynamics(
    run: ObservedRun, rival: FittedHypothesis, prior: PriorInformation
) -> tuple[AxisErrorDynamics, ...]:
    """The error dynamics of the train runs and the flight, averaged over the time of both."""
    thinned = run.limited(np.arange(len(run.motion.time)) % THINNING == 0)
    of_flight = np.array(estimate_errors(rival.hypothesis.model, [thinned]).by_axis)
    t_train, t_flight = prior.seconds, float(run.reading_times[-1])
    mixed = (t_train * np.array(prior.error_dynamics) + t_flight * of_flight) / (t_train + t_flight)
    return tuple(AxisErrorDynamics(float(d), float(k)) for d, k in mixed)


def _observe(
    run: ObservedRun,
    rival: FittedHypothesis,
    prior: PriorInformation,
    error_dynamics: tuple[AxisErrorDynamics, ...],
    exact: bool,
) -> FilterBank:
    """Filters for the flight alone; where `exact` for the train runs, followed by the flight."""
    runs = (*prior.runs, run) if exact else (run,)
    run_filters = tuple(design_filters(prior.noise.white, error_dynamics, w) for w in runs)
    return FilterBank(runs, error_dynamics, run_filters, rival.hypothesis.model)


def measure_information(
    bank: FilterBank, own: Linearised, rival: FittedHypothesis, prior: PriorInformation
) -> Array:
    """Information (k, k) of the flight about a rival's scaled parameters.

    The flight is the last run of the bank. The train runs are left out, since filters that suit all
    runs together may show less of them than their own filters: the flight would take information
    away.
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
    """The expected gain of the log odds of the true rival against the other one.

    The other rival has all its parameters free, under the prior that a fit gives them.
    """
    rival, information = bank.linearise(other.widest), other.widest_information
    if not rival.is_finite:
        rival, information = bank.linearise(other.hypothesis), other.information
    if not rival.is_finite:
        return np.inf
    errors = [a - b for a, b in zip(rival.e, true.e, strict=True)]
    errors = [*(0.0 * error for error in errors[:-1]), errors[-1]]  # the train runs count already
    rows = [np.concatenate([e[None], J]) for e, J in zip(errors, rival.J, strict=True)]
    e, J = np.split(bank.flatten(rows, prior.noise), [1])
    e = e[0]
    prior_precision = np.eye(len(J)) / PRIOR_STD**2 + (0.0 if exact else information)
    x = -solve(gram(J) + prior_precision, J @ e)
    residual = (e + x @ J).reshape(6, -1)
    prior_cost = float(x @ prior_precision @ x)
    train_readings = 0 if exact else prior.readings  # of the train runs, which are not in the bank
    return 0.5 * (prior_cost + surprise(residual, 1.0 + train_readings / residual.shape[1]))


def surprise(left: Array, lasting: float) -> float:
    """What a misfit costs in twice the log likelihood, once the noise is fitted to it.

    Noise of another spectrum can explain what is slow or fast: in each octave, power P beside n
    readings' worth of noise costs n log(1 + P / n).

    Args:
        left: the misfit, in whitened innovations (6, n) of the flight.
        lasting: the same noise has to explain runs that are so many times as long as the flight.
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
