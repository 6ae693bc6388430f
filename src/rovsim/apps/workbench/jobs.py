"""Start long work on an open campaign in another process, and load the results when it is done."""

from pathlib import Path
from typing import Any

from nicegui import ui
from nicegui.binding import BindableProperty, bind_from

from rovsim.application.configuration import compose
from rovsim.apps.workbench import tasks
from rovsim.apps.workbench.workbench import Workbench
from rovsim.core.model_names import NOMINAL, name_learned
from rovsim.design.settings import Question
from rovsim.dynamics.model_file import read_model
from rovsim.reporting.wording import title

WAITING_SENTENCE = "Waits until what goes on has ended, one long work at a time: {}."


class Beginning(ui.button):
    """A button that starts long work; it is disabled, and says why, while other work runs."""

    other = BindableProperty(on_change=lambda button, _: button.wait())

    def __init__(self, bench: Workbench, words: str, **given: Any) -> None:
        super().__init__(words, **given)
        self.other = ""
        bind_from(self, "other", bench, "goes_on")

    def wait(self) -> None:
        """Disable the button while other work runs, with the reason as tooltip and description."""
        self.set_enabled(not self.other)
        reason = WAITING_SENTENCE.format(self.other) if self.other else None
        for name in ("title", "aria-description"):
            self.props.set_optional(name, reason)


def start_diagnosis(bench: Workbench) -> None:
    """Start a diagnosis of the base."""
    settings, path = bench.only(bench.base.name), bench.diagnosis_path
    bench.work.begin(
        "Finding what is missing", bench.replace_diagnosis, tasks.diagnose_into, settings, path
    )


def start_training(bench: Workbench, kind: str, name: str) -> None:
    """Start to train a residual of this kind on top of the model called `name`."""
    base = NOMINAL if name == bench.base.name else name
    trained = name_learned(kind, bench.settings.control, base)
    residual = compose([f"residual={kind}"]).residual
    settings = bench.only(name).model_copy(update={"residual": residual})

    def take(path: Path) -> None:
        bench.add(read_model(path, bench.catalogue), path)

    path = bench.out / "trained" / trained / f"{trained}.yaml"
    bench.work.begin(f"Training {title(trained)}", take, tasks.train_into, settings, path)


def start_report(bench: Workbench) -> None:
    """Start to write the report and the JSON files behind it."""

    def take(path: Path) -> None:
        bench.choices["report"] = path

    settings = bench.only(*bench.models)
    results = (bench.ladder(), bench.diagnosis)
    bench.work.begin("Writing the report", take, tasks.report_into, settings, *results, bench.out)


def start_design(bench: Workbench, name: str, question: Question) -> None:
    """Start to plan the flight that answers a question about the model called `name`."""

    arguments = (bench.only(name), question, bench.flight_folder(name, question))
    bench.work.begin(
        "Planning a flight", lambda folder: None, tasks.design_into, *arguments
    )  # the screen reads the result from this folder
