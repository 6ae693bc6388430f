"""A case whose flight is planned: all that flying it and fitting it need."""

import time
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from rovsim.application.configuration import compose
from rovsim.application.pipeline.measured_campaign import MeasuredCampaign, measure, open_campaign
from rovsim.application.settings import Settings
from rovsim.benchmarks.blind.case import Range
from rovsim.benchmarks.designs.cases import ask, hide
from rovsim.design.plan import Plan, plan
from rovsim.design.report import report_plan
from rovsim.design.search import CandidateFlight
from rovsim.design.settings import Question
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.model import nominal
from rovsim.results.experiment import Experiment
from rovsim.simulation.synthetic_tank.campaign import make_campaign
from rovsim.simulation.synthetic_tank.settings import TankSettings


@dataclass(frozen=True, eq=False)
class DesignedCase:
    """A hidden effect, the run before as measured, and the flight that was planned from it.

    `folder` holds its campaigns and logs. The plan took `seconds` by the clock and `cpu_seconds`
    of the processor.
    """

    folder: Path
    tank: TankSettings
    settings: Settings
    data: MeasuredCampaign
    question: Question
    plan: Plan
    seconds: float
    cpu_seconds: float

    @cached_property
    def experiment(self) -> Experiment:
        """What `rovsim design` would write of the plan."""
        model, site = nominal(self.data.vehicle), self.plan.problem.setup.site
        return report_plan(self.plan, model, self.question, site)

    @cached_property
    def best_usual(self) -> CandidateFlight | None:
        """The usual manoeuvre that would tell most; None where none stays within the limits."""
        baselines = [baseline for baseline in self.plan.baselines.values() if baseline]
        if not baselines:
            return None
        return max(baselines, key=lambda baseline: baseline.expected.utility).flight


def design_case(case: str, seeds: Range, folder: Path) -> DesignedCase:
    """Record the run before, and plan a flight from it."""
    tank, settings = hide(case, seeds), compose([])
    question = ask(case, settings)
    make_campaign(tank, folder / "before", built_in())
    data = measure_recorded(folder / "before", settings)
    began, began_cpu = time.perf_counter(), time.process_time()
    flight_plan = plan(nominal(data.vehicle), data.runs, question, None, built_in())
    seconds, cpu = time.perf_counter() - began, time.process_time() - began_cpu
    return DesignedCase(folder, tank, settings, data, question, flight_plan, seconds, cpu)


def measure_recorded(folder: Path, settings: Settings) -> MeasuredCampaign:
    """The campaign in a folder, as any other is measured."""
    return measure(open_campaign(str(folder)), settings.signals)
