"""A flight in the tank that hides the effect, and what it told beside the run before."""

from pathlib import Path

from rovsim.benchmarks.designs.designed_case import DesignedCase, measure_recorded
from rovsim.core.files import write_text
from rovsim.design.from_train_runs import fit_prior
from rovsim.design.prior_information import PriorInformation
from rovsim.design.report import describe_start
from rovsim.design.search import CandidateFlight
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.model import nominal
from rovsim.estimation.observer.train_runs import prepare_train
from rovsim.measurement.recording.formats.commands_csv import format_commands
from rovsim.results.design_benchmark import Outcome, ReachedOdds, ReachedStd, ThroughWall
from rovsim.simulation.synthetic_tank.campaign import make_campaign
from rovsim.simulation.synthetic_tank.settings import TankRun
from rovsim.simulation.synthetic_tank.true_run import LeftTank


def fly(case: DesignedCase, name: str, tried: CandidateFlight) -> Outcome:
    """Fly a log in the same tank, and fit all that was asked to both runs.

    `name` is that of its files and of its run.
    """
    log_file, campaign_folder = case.folder / f"{name}.csv", case.folder / f"with_{name}"
    _write_log(case, tried, log_file)
    run = TankRun(id=name, control="6dof", split="train", fly=str(log_file))
    tank = case.tank.model_copy(update={"runs": (*case.tank.runs, run)})
    try:
        make_campaign(tank, campaign_folder, built_in())
    except LeftTank as error:
        return ThroughWall(left=error.found)
    return _reached(case.plan.problem.prior, _fit(case, campaign_folder))


def _write_log(case: DesignedCase, tried: CandidateFlight, sent: Path) -> None:
    """The commands, and beside them where they begin: the tank reads both."""
    log = case.data.campaign.commands
    assert log is not None
    write_text(sent, format_commands(tried.commands, log))
    problem = case.plan.problem
    start = describe_start(problem.pilot.start, tried.heading, problem.setup.site)
    case.experiment.model_copy(update={"start": start}).write(sent.with_suffix(".json"))


def _fit(case: DesignedCase, recorded: Path) -> PriorInformation:
    """What the run before and the flight tell together."""
    runs = measure_recorded(recorded, case.settings).runs
    base = nominal(case.data.vehicle)
    train = prepare_train(runs, case.settings.replay, built_in(), base.body.free).runs
    return fit_prior(base, train, case.question, built_in())


def _reached(before: PriorInformation, after: PriorInformation) -> ReachedOdds | ReachedStd:
    """Log odds of the truth, or standard deviation and value, before and after."""
    if after.rival_names:
        return ReachedOdds(
            log_odds=0.5 * after.deviance_difference,
            log_odds_before=0.5 * before.deviance_difference,
        )
    (rival_after,), (rival_before,) = after.rivals, before.rivals
    scale = rival_after.hypothesis.terms[0].parameters[0].scale
    std, std_before = float(rival_after.std()[0]), float(rival_before.std()[0])
    value = float(rival_after.hypothesis.x[rival_after.of_interest[0]])
    return ReachedStd(
        std=std * scale,
        std_before=std_before * scale,
        gained=(std_before / std) ** 2 - 1.0,
        value=value * scale,
    )
