"""Plan the next flight: the commands that tell most about what is not yet known.

rovsim design campaign=DIR model=FILE [between=[a,b]] [know=[effect.parameter,…]] [seconds=60]
              out=OUT

between: two effects that could not be told apart. know: values to be known better; without either,
all that the model file says was fitted. Writes OUT/experiment.csv (a command log as this
campaign's), OUT/experiment.json (what to expect, and what the usual manoeuvres would tell), a
picture and OUT/instructions.txt. `rovsim tank … fly=OUT/experiment.csv` flies it.
"""

from pydantic import Field

from rovsim.application.pipeline.design import design, write_flight
from rovsim.application.pipeline.models import load_one_model
from rovsim.application.settings import CampaignSettings, select
from rovsim.apps.cli.opening import measure_campaign
from rovsim.apps.cli.output import say
from rovsim.design.settings import DesignSettings, Question
from rovsim.diagnosis.settings import DiagnosisSettings, SearchSettings
from rovsim.dynamics.catalogue import Catalogue
from rovsim.reporting.words.experiment import tell_experiment


class Settings(CampaignSettings):
    """What `rovsim design` takes."""

    between: list[str] | None
    know: list[str] | None
    seconds: float
    design: DesignSettings
    search: SearchSettings
    seed: int = Field(ge=0)


def run(settings: Settings, catalogue: Catalogue) -> None:
    """Plan, write the files, and say what to expect."""
    question = _ask(settings)
    data, out = measure_campaign(settings, "design")
    model = load_one_model(settings.model, data.vehicle, catalogue)
    flight = design(data, model, question, catalogue)
    write_flight(out, flight)
    text = tell_experiment(flight.experiment, model.vehicle.thruster_names)
    say(settings, f"{text}\n\n{out / 'experiment.csv'}", flight.experiment.to_json())


def _ask(settings: Settings) -> Question:
    """What is asked, checked."""
    return Question.of(
        select(settings, DiagnosisSettings),
        settings.design,
        "command line",
        seconds=settings.seconds,
        between=settings.between or (),
        know=settings.know or (),
    )
