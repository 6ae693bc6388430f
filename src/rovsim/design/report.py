"""A plan as `experiment.json` holds it."""

from hashlib import sha256

import numpy as np
from numpy import ndarray as Array

from rovsim.core.odds import odds_of
from rovsim.core.rotations import short_way
from rovsim.core.rounding import rounded
from rovsim.core.run import Site
from rovsim.design.adequacy import warn_of_wider
from rovsim.design.envelope import find_extremes
from rovsim.design.expected_information import MIN_INFORMATION_GAIN, ExpectedInformation
from rovsim.design.instructions import instruct
from rovsim.design.plan import Plan
from rovsim.design.prior_information import FittedHypothesis, PriorInformation
from rovsim.design.safe_flights import SafeFlight
from rovsim.design.settings import Question
from rovsim.dynamics.model import Model
from rovsim.results.base import or_none
from rovsim.results.experiment import (
    Expected,
    Experiment,
    Keeps,
    RivalOdds,
    Start,
    Surer,
    UsualManoeuvre,
)


def report_plan(
    plan: Plan, model: Model, question: Question, site: Site, log: str | None = None
) -> Experiment:
    """What is written of a plan.

    Args:
        plan: the flight and what it tells.
        model: what was known.
        question: what was asked.
        site: whose axes the start is given in.
        log: text of the file of commands; None where none is written.
    """
    problem, best = plan.problem, plan.best
    start = describe_start(problem.pilot.start, best.flight.heading, site)
    expects = _expect(problem.prior, best.expected)
    wider = warn_of_wider(model, {name: std.now for name, std in expects.std.items()})
    return Experiment(
        seconds=question.seconds,
        model=model.name,
        between=question.between,
        know=question.know,
        commands_sha256=None if log is None else sha256(log.encode()).hexdigest(),
        start=start,
        manoeuvre=best.flight.name,
        expects=expects,
        baselines={
            name: _compare(problem.prior, best.expected, usual)
            for name, usual in plan.baselines.items()
        },
        keeps=_keep(best.paths, site),
        instructions=tuple(instruct(best.flight, problem.axes, start, question.design.limits)),
        warnings=(*plan.warnings, *wider),
    )


def describe_start(place: Array, heading: float, site: Site) -> Start:
    """In the recordings' axes; a yaw about an axis that points up turns the other way."""
    x, y, z = (float(v) for v in np.round(place * site.axes, 4))
    yaw = heading if np.array_equal(site.axes, np.ones(3)) else -heading
    return Start(x_m=x, y_m=y, z_m=z, yaw_rad=round(float(short_way(yaw)), 6))


def _expect(prior: PriorInformation, expected: ExpectedInformation) -> Expected:
    std: dict[str, Surer] = {}
    for rival, after, std_ratio in zip(prior.rivals, expected.std, expected.std_ratio, strict=True):
        std |= _list_std(rival, after, std_ratio)
    return Expected(odds=_list_odds(prior, expected), std=std)


def _list_std(rival: FittedHypothesis, then: Array, std_ratio: Array) -> dict[str, Surer]:
    parameters = [p for term in rival.hypothesis.terms for p in term.parameters]
    return {
        rival.names[k]: Surer(
            now=or_none(rounded(parameters[k].std_of(s * ratio))),
            then=or_none(rounded(parameters[k].std_of(s))),
            unit=parameters[k].unit,
            gained=or_none(rounded(ratio**2 - 1.0)),
        )
        for k, s, ratio in zip(rival.of_interest, then, std_ratio, strict=True)
    }


def _list_odds(prior: PriorInformation, expected: ExpectedInformation) -> dict[str, RivalOdds]:
    if not len(expected.log_odds_gain):
        return {}
    odds, log_odds = {}, (0.5 * prior.deviance_difference, -0.5 * prior.deviance_difference)
    names = prior.rival_names
    for name, before, gain in zip(names, log_odds, expected.log_odds_gain, strict=True):
        after = before + gain
        odds[name] = RivalOdds(
            now=rounded(odds_of(2.0 * before)),
            then=rounded(odds_of(2.0 * after)),
            log_odds_now=rounded(before),
            log_odds_then=rounded(after),
        )
    return odds


def _compare(
    prior: PriorInformation,
    designed: ExpectedInformation,
    usual: SafeFlight | None,
) -> UsualManoeuvre:
    if usual is None:
        return UsualManoeuvre(amplitude=None, designed_is_better=None)
    expectation = _expect(prior, usual.expected)
    return UsualManoeuvre(
        odds=expectation.odds,
        std=expectation.std,
        amplitude=usual.flight.amplitude,
        designed_is_better=or_none(
            rounded(designed.utility / max(usual.expected.utility, MIN_INFORMATION_GAIN))
        ),
    )


def _keep(paths: Array, site: Site) -> Keeps:
    speed, rate, tilt = find_extremes(paths)
    tank, position = site.tank, paths[:, :, :3]
    margin = np.minimum(position - tank[:, 0], tank[:, 1] - position)
    walled = np.isfinite(margin).any() and not np.isnan(margin).all()
    return Keeps(
        nearest_wall_m=rounded(float(np.nanmin(margin))) if walled else None,
        speed_m_s=rounded(speed),
        turn_rate_rad_s=rounded(rate),
        tilt_rad=rounded(tilt),
    )
