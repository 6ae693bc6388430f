"""Plan the flight that answers a question about a campaign best."""

from dataclasses import dataclass
from itertools import islice
from typing import Mapping, Sequence

import numpy as np
from numpy import ndarray as Array
from threadpoolctl import threadpool_limits

from rovsim.core.errors import BadInput
from rovsim.core.progress import begin_stage
from rovsim.design.adequacy import (
    explain_infeasible,
    require_information,
    warn_of_misfit,
    warn_of_walls,
)
from rovsim.design.authority import Authority
from rovsim.design.envelope import Envelope
from rovsim.design.from_train_runs import fit_prior
from rovsim.design.pilot import ModelPilot
from rovsim.design.prior_information import PriorInformation
from rovsim.design.recording_setup import RecordingSetup, describe_setup
from rovsim.design.safe_flights import FinalCheck, SafeFlight
from rovsim.design.scenarios import Scenarios, draw_scenarios
from rovsim.design.search import (
    CandidateFlight,
    DesignProblem,
    evaluate_baselines,
    in_parts,
    search,
)
from rovsim.design.settings import Question
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.model import Model
from rovsim.estimation.observer.train_runs import prepare_train
from rovsim.estimation.observer.usable_runs import select_usable
from rovsim.measurement.runs import Runs
from rovsim.simulation.batch import Batch

# Scenarios while searching and in the end, and models that information is averaged over.
SEARCH_SCENARIOS, CHECK_SCENARIOS, DRAWS_PER_RIVAL = 8, 40, 4
FINALISTS = 4  # safe flights, the best first, whose information is averaged over models
# Share of the time that is over when a stage begins: means over the development seeds.
STAGES = {"learning": 0.0, "usual manoeuvres": 0.03, "searching": 0.12, "checking": 0.93}


@dataclass(frozen=True, eq=False)
class Plan:
    """The planned flight, and the usual manoeuvres beside it.

    Attributes:
        best: the flight of the largest utility.
        baselines: the usual manoeuvres by name; None for one that leaves the limits at every
            amplitude.
        problem: what flights were made with and judged by.
        warnings: sentences on what speaks against the flight.
    """

    best: SafeFlight
    baselines: Mapping[str, SafeFlight | None]
    problem: DesignProblem
    warnings: tuple[str, ...]


@threadpool_limits.wrap(limits=1, user_api="blas")  # matrices are too small for more to help
def plan(
    model: Model,
    runs: Runs,
    question: Question,
    columns: Sequence[int] | None,
    catalogue: Catalogue,
) -> Plan:
    """Find the flight of the largest utility; report each of the STAGES as it begins.

    Args:
        model: the best model so far.
        runs: all usable runs of a campaign.
        question: what is asked, and the settings of the search.
        columns: the axes (0 to 5) of a command log per axis; None for a log of thrusters.
        catalogue: all effects.

    Raises:
        BadInput: the train runs or the vehicle allow no plan, no flight stays within the limits,
            or none tells anything about the question.
    """
    begin_stage("learning")
    train = prepare_train(
        runs, question.replay, catalogue, model.body.free, question.most_seconds
    ).runs
    usable = select_usable(train)
    if not usable.enough:
        raise BadInput(
            f"only {usable.seconds:.0f} s of the train runs can be used",
            where="rovsim design",
            expected="at least 10 s in which the vehicle moves: a design builds on them",
            remedy="Record a train run of a minute in which the vehicle moves.",
        )
    setup = describe_setup(usable.runs, question.seconds, columns, question.replay, catalogue)
    prior = fit_prior(model, usable.runs, question, catalogue)
    random = np.random.default_rng(question.seed)
    problem = _pose_problem(prior, setup, question, random)
    begin_stage("usual manoeuvres")
    baselines = evaluate_baselines(problem, question.seed)
    begin_stage("searching")
    flights = search(problem, question.design, question.seed)
    begin_stage("checking")
    return _choose(problem, baselines, flights, question, random)


def _pose_problem(
    prior: PriorInformation, setup: RecordingSetup, question: Question, random: np.random.Generator
) -> DesignProblem:
    limits, first = question.design.limits, prior.rivals[0].hypothesis.model
    envelope = Envelope.within(setup, limits, first.vehicle.floats)
    batch = Batch([first], setup.site, candidates=setup.wrenches, learned=False)
    authority = Authority(first, setup.kind, setup.axes, setup.largest)
    if not {0, 1, 5} <= set(authority.axes):
        raise BadInput(
            f"{first.vehicle.name} cannot push sideways",
            where="rovsim design",
            expected="a vehicle that can stay near a place without looking",
            remedy="Record what `diagnose` recommends under next_experiment.",
        )
    start = envelope.middle
    if first.vehicle.floats:
        start[2] = setup.site.level
    pilot = ModelPilot(authority, setup.site, start, limits, batch)
    if not pilot.full.any():
        raise BadInput(
            "no axis can be commanded",
            where="rovsim design",
            expected="commands that push the vehicle",
            remedy="Check thrusters and mixer of the vehicle file.",
        )
    return DesignProblem(
        pilot, envelope, _draw(prior, SEARCH_SCENARIOS, setup, random), prior, setup
    )


def _draw(
    prior: PriorInformation, count: int, setup: RecordingSetup, random: np.random.Generator
) -> Scenarios:
    """Draw about `count` scenarios: the likeliest one of each rival first."""
    models = [rival.draw(max(2, count // len(prior.rivals)), random) for rival in prior.rivals]
    return draw_scenarios(models, prior, setup, random)


def _choose(
    problem: DesignProblem,
    baselines: Mapping[str, list[CandidateFlight]],
    designed_numbers: Sequence[Array],
    question: Question,
    random: np.random.Generator,
) -> Plan:
    """Choose the best flight, averaged over possible models, of those that surely stay safe.

    A usual manoeuvre is chosen where no designed flight is better.

    Args:
        problem: with the scenarios of the search; new ones are drawn here.
        baselines: the usual manoeuvres by name, each at several amplitudes, the best first.
        designed_numbers: numbers of the designed flights, the best first.
        question: what is asked.
        random: generator of scenarios and models.

    Raises:
        BadInput: no flight stays within the limits, or the best one tells nothing.
    """
    prior = problem.prior
    scenarios = _draw(prior, CHECK_SCENARIOS, problem.setup, random)
    some = [rival.draw(DRAWS_PER_RIVAL, random) for rival in prior.rivals]
    check = FinalCheck(problem, scenarios, some)
    usual = {name: next(check.find_safe(flights), None) for name, flights in baselines.items()}
    designed = (
        flight for part in in_parts(designed_numbers) for flight in problem.evaluate_numbers(part)
    )
    finalists = [
        *islice(check.find_safe(designed), FINALISTS),
        *(flight for flight in usual.values() if flight),
    ]
    if not finalists:
        raise explain_infeasible(problem, question)
    best = max(finalists, key=lambda safe: safe.expected.utility)
    require_information(best.expected, prior)
    walls = warn_of_walls(best.paths, problem.pilot.start, problem.envelope)
    return Plan(best, usual, problem, (*warn_of_misfit(prior, question), *walls))
