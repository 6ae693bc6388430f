"""Plan the next flight, and write its commands, picture and instructions."""

import textwrap
from dataclasses import dataclass
from pathlib import Path
from typing import Sequence

from rovsim.application.pipeline.measured_campaign import MeasuredCampaign
from rovsim.application.pipeline.models import require_physics
from rovsim.core.errors import BadInput
from rovsim.core.files import appearing_together, write_text
from rovsim.core.progress import staged
from rovsim.core.run import Commands
from rovsim.design.plan import STAGES, Plan, plan
from rovsim.design.report import report_plan
from rovsim.design.settings import Question
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.model import Model
from rovsim.measurement.campaign_file import CommandLog
from rovsim.measurement.recording.commands import as_logged
from rovsim.measurement.recording.formats.commands_csv import format_commands
from rovsim.reporting.figures.planned_flight import PlannedFlight, draw_flight
from rovsim.reporting.figures.style import save
from rovsim.reporting.words.experiment import list_steps
from rovsim.results.experiment import Experiment

LINE_LETTERS = 96  # of instructions
COMMAND_UNITS = {"pwm": "µs", "normalized": "−1 to 1", "demand": "−1 to 1", "wrench": "N, N m"}


@dataclass(frozen=True, eq=False)
class Designed:
    """A planned flight, as it is written.

    Attributes:
        experiment: the result.
        log: text of the file of commands, in the format of the campaign's own logs.
        picture: what the figure shows.
    """

    experiment: Experiment
    log: str
    picture: PlannedFlight


def design(
    data: MeasuredCampaign, model: Model, question: Question, catalogue: Catalogue
) -> Designed:
    """Plan the next flight of a campaign.

    Args:
        data: the campaign as measured.
        model: of physics, as it is known so far.
        question: what the flight should tell.
        catalogue: all effects.

    Raises:
        BadInput: the model has a trained residual or no physics, the question makes no sense, or
            there is no such flight.
    """
    require_physics(model, "design with")
    _refuse(question)
    log = data.campaign.commands
    if log is None:
        raise BadInput(
            "no run has commands",
            where=data.campaign.file,
            expected="a campaign that logs commands: they are what a flight is made of",
            remedy="Record a run with commands first, however short.",
        )
    columns = log.axis_numbers if log.per_axis else None
    with staged("designing", STAGES):
        flight_plan = plan(model, data.runs, question, columns, catalogue)
    site = next(iter(data.motions.values())).site
    commands = flight_plan.best.flight.commands
    sent = format_commands(commands, log)
    experiment = report_plan(flight_plan, model, question, site, sent)
    return Designed(experiment, sent, _picture(flight_plan, commands, log))


def write_flight(out: Path, designed: Designed) -> None:
    """Write the log, the picture, the instructions and what to expect: all of them, or nothing.

    Raises:
        BadInput: `out` cannot be written to.
    """
    experiment = designed.experiment
    with appearing_together(out, last="experiment.json") as folder:
        write_text(folder / experiment.commands, designed.log)
        save(draw_flight(designed.picture), folder, "experiment")
        write_text(folder / "instructions.txt", format_instructions(experiment.instructions))
        experiment.write(folder / "experiment.json")


def format_instructions(instructions: Sequence[str]) -> str:
    """Format instructions as a text of numbered steps, each with its parts below."""
    lines: list[str] = []
    for number, (step, parts) in enumerate(list_steps(instructions), 1):
        lines.append(_fill(step, f"{number}. "))
        lines += [_fill(part, "   * ") for part in parts]
    return "\n\n".join(lines) + "\n"


def _fill(text: str, mark: str) -> str:
    return textwrap.fill(text, LINE_LETTERS, initial_indent=mark, subsequent_indent=" " * len(mark))


def _refuse(question: Question) -> None:
    if len(set(question.between)) not in (0, 2) or len(question.between) > 2:
        raise BadInput(
            f"between=[{','.join(question.between)}]",
            where="command line",
            expected="two different effects, as between=[input_delay,thruster_lag]",
            remedy="Name the two that a diagnosis could not tell apart.",
        )


def _picture(plan: Plan, commands: Commands, log: CommandLog) -> PlannedFlight:
    return PlannedFlight(
        plan.best.paths[:, :, :3],
        plan.problem.setup.site.tank,
        commands.time,
        as_logged(commands, log),
        tuple(log.names),
        COMMAND_UNITS[log.kind],
    )
