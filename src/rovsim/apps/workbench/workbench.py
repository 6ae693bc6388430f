"""An open campaign and its models; it calls the same functions as the commands."""

from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, Sequence

from rovsim.application.pipeline.given_diagnosis import read_given_diagnosis
from rovsim.application.pipeline.measured_campaign import MeasuredCampaign, measure, open_campaign
from rovsim.application.pipeline.models import load_models
from rovsim.application.pipeline.result_cache import kept_diagnosis, kept_flight, kept_folder
from rovsim.application.provenance import describe_origin
from rovsim.application.settings import WorkbenchSettings, select
from rovsim.apps.workbench.draft import Draft
from rovsim.apps.workbench.kept_replays import KeptReplays
from rovsim.apps.workbench.work import LongWork
from rovsim.core.errors import BadInput
from rovsim.core.files import find_free, read_text, write_text
from rovsim.core.model_names import BUILT_IN, EFFECTS
from rovsim.core.names import as_list
from rovsim.design.settings import Question
from rovsim.diagnosis.settings import DiagnosisSettings
from rovsim.dynamics.catalogue import Catalogue, load_catalogue
from rovsim.dynamics.model import Model, zero_acceleration
from rovsim.dynamics.model_file import read_model, write_model
from rovsim.results.diagnosis import Diagnosis, law_beside
from rovsim.results.ladder import Ladder, LadderStep

OPENINGS_FILE = "test_runs_opened.csv"  # one line for each model that was saved and measured


@dataclass(eq=False)
class Workbench:
    """An open campaign: what was measured, the models, a diagnosis, and long work on them.

    Attributes:
        settings: of the workbench.
        catalogue: all effects that are known for the vehicle.
        data: the campaign as measured.
        models: by name; the base first, then those that were loaded, saved or trained.
        paths: model specifications by name: a file, or a built-in model.
        diagnosis: what the base lacks; None if there is none.
        study: ladder.json beside a diagnosis that was given; None if there is none.
        choices: what a screen keeps between two visits.
        work: long work on the campaign.
    """

    settings: WorkbenchSettings
    catalogue: Catalogue
    data: MeasuredCampaign
    models: dict[str, Model]
    paths: dict[str, str]
    diagnosis: Diagnosis | None = None
    study: Ladder | None = None
    choices: dict[str, Any] = field(default_factory=dict)
    work: LongWork = field(default_factory=LongWork)

    @staticmethod
    def opened(settings: WorkbenchSettings, catalogue: Catalogue) -> "Workbench":
        """Read the campaign and the models of the settings, and a diagnosis if there is one.

        Raises:
            BadInput: one of them cannot be used.
        """
        data = measure(open_campaign(settings.campaign), settings.signals)
        models = {m.name: m for m in load_models(settings.model, data.vehicle, catalogue)}
        _check_base(next(iter(models.values())))
        paths = dict(zip(models, dict.fromkeys(as_list(settings.model)), strict=True))
        bench = Workbench(settings, catalogue.on(data.vehicle), data, models, paths)
        if settings.diagnosis:
            file = Path(settings.diagnosis)
            bench.diagnosis = read_given_diagnosis(file, data.campaign)
            ladder_file = file.with_name("ladder.json")
            bench.study = Ladder.read(ladder_file) if ladder_file.exists() else None
        elif bench.diagnosis_path.exists():
            bench.diagnosis = Diagnosis.read(bench.diagnosis_path)
        return bench

    @property
    def base(self) -> Model:
        """The model that is diagnosed, and that effects are added to."""
        return next(iter(self.models.values()))

    @property
    def out(self) -> Path:
        """Folder in which the workbench keeps its results."""
        return kept_folder(self.settings.out, self.data.campaign)

    @cached_property
    def diagnosis_path(self) -> Path:
        """File of a diagnosis of these recordings, settings, base and code, never outdated."""
        settings = select(self.settings, DiagnosisSettings)
        return kept_diagnosis(self.out, self.data.campaign, settings, self.base, self.catalogue)

    def flight_folder(self, name: str, question: Question) -> Path:
        """Return the folder of the flight that answers a question about a model.

        Raises:
            BadInput: its file holds no model.
        """
        model = self.known_model(name)
        return kept_flight(self.out, self.data.campaign, question, model, self.catalogue)

    @cached_property
    def replays(self) -> KeptReplays:
        """Replays of models on the runs of the campaign."""
        return KeptReplays(self.data.runs, self.settings)

    @cached_property
    def baseline(self) -> Model:
        """The model that others must beat: a vehicle that keeps its velocity."""
        return zero_acceleration(self.data.vehicle)

    @cached_property
    def draft(self) -> Draft:
        """The model that the user puts together by hand."""
        return Draft(self.base, self.diagnosis, self.catalogue)

    def replace_diagnosis(self, diagnosis: Diagnosis) -> None:
        """Replace the diagnosis; a new draft begins with the effects that it selected."""
        self.diagnosis = diagnosis
        self.__dict__.pop("draft", None)

    def take_law(self) -> None:
        """Load the law that the diagnosis proposes; a new draft begins with it.

        Its file, which is Python, is run here for the first time, since the user asked for it.

        Raises:
            BadInput: its file is missing, or cannot be used any more.
        """
        files = [*self.settings.effect_files, self.law_path]
        self.catalogue = load_catalogue(files).on(self.data.vehicle)
        self.settings = self.settings.model_copy(update={"effects_file": list(map(str, files))})
        self.__dict__.pop("draft", None)

    @property
    def law_path(self) -> Path:
        """File of the law that the diagnosis proposes, written as an effect."""
        diagnosis = self.settings.diagnosis
        return law_beside(Path(diagnosis) if diagnosis else self.diagnosis_path)

    def add(self, model: Model, path: Path) -> None:
        """Add a model that was saved or trained."""
        self.models[model.name], self.paths[model.name] = model, str(path)

    @property
    def saved_in(self) -> Path:
        """Folder in which models are saved unless another place is named."""
        return Path("results") / self.data.campaign.name / "models"

    def known_models(self) -> dict[str, Path]:
        """Return files by the name of their model, open or saved before; the base first."""
        files = {path.stem: path for path in self.saved_in.glob("*.yaml")}
        files |= {name: Path(path) for name, path in self.paths.items()}
        return {name: files[name] for name in (self.base.name, *sorted(files))}

    def known_model(self, name: str) -> Model:
        """Return one of `known_models`; its file is read now if it is not open.

        Raises:
            BadInput: the file holds no model.
        """
        return self.models.get(name) or self.open_model(self.known_models()[name])

    def open_model(self, path: Path) -> Model:
        """Open the model of a file; one that is open already is left as it is.

        Raises:
            BadInput: the file holds no model, or another model has its name.
        """
        existing = self.paths.get(path.stem)
        if existing is not None and Path(existing).resolve() == path.resolve():
            return self.models[path.stem]
        if existing is not None or path.stem in BUILT_IN:
            raise BadInput(
                f"another model is called '{path.stem}'",
                where=path,
                expected="a name that no open model has (it is that of the file)",
                remedy="Rename the file.",
            )
        model = read_model(path, self.catalogue)
        self.add(model, path)
        return model

    def save(self, path: Path) -> Model:
        """Write the draft as a model file, read it back, and add it to the models.

        Raises:
            BadInput: the draft is no possible model, or the place is not allowed or taken.
        """
        allowed = (Path(), self.out, self.data.campaign.file.parent)
        _check_place(path, allowed, {*BUILT_IN, self.base.name})
        story: dict[str, object] = {
            "base": self.base.name,
            "effects": self.draft.ticked,
            "moved": self.draft.values,
        }
        story |= describe_origin(self.catalogue)
        write_model(self.draft.model(), path, provenance=story)
        model = read_model(path, self.catalogue)
        self.add(model, path)
        return model

    def free_path(self) -> Path:
        """Return a path for the next model at which there is no file yet."""
        return find_free(self.saved_in / "with_effects.yaml", "_")

    def note_opening(self, model: Model) -> int:
        """Note in a file that the test runs were opened for a model; returns how often so far."""
        log = self.out / OPENINGS_FILE
        before = read_text(log) if log.exists() else "model,error\n"
        write_text(log, f"{before}{model.name},{self.replays.step(model).windows_2s}\n")
        return len(before.splitlines())

    def only(self, *names: str) -> WorkbenchSettings:
        """Return the settings with these models alone."""
        return self.settings.model_copy(update={"model": [self.paths[name] for name in names]})

    @property
    def goes_on(self) -> str:
        """Title of the long work that is running; empty where none is."""
        return self.work.now.title if self.work.now else ""

    def ladder(self) -> Ladder:
        """Return the ladder of all models: baseline, base, effects found, others, noise floor."""
        if self.study is not None:
            extra = [self.replays.step(m) for n, m in self.models.items() if m is not self.base]
            study_steps = self.study.steps
            return Ladder(steps=(*study_steps[:-1], *extra, *study_steps[-1:]))
        references = [self.baseline, self.base]
        others = [m for m in self.models.values() if m.name not in {r.name for r in references}]
        steps = [self.replays.step(m) for m in references]
        steps += [LadderStep(model=EFFECTS)] if self.diagnosis else []
        steps += [self.replays.step(m) for m in others]
        return Ladder.with_diagnosis(steps, self.diagnosis.ladder.steps if self.diagnosis else ())


def _check_base(model: Model) -> None:
    if model.inert:
        raise BadInput(
            f"'{model.name}' has no forces that could be wrong",
            where="model",
            expected="a model of the vehicle first",
            remedy=f"Leave it out, the ladder shows it; or write model=[nominal,{model.name}].",
        )


def _check_place(path: Path, inside: Sequence[Path], taken: set[str]) -> None:
    """Refuse a model file outside the folders `inside`, over another file, or with a name taken."""
    problem = ""
    if not any(path.resolve().is_relative_to(folder.resolve()) for folder in inside):
        problem = "lies outside the folder in which the workbench was started"
    elif path.suffix not in (".yaml", ".yml"):
        problem = "does not end in .yaml"
    elif path.stem in taken:
        problem = f"would be called '{path.stem}', as another model is"
    elif path.exists():
        problem = "is there already"
    if problem:
        raise BadInput(
            problem, where=path, expected="a new model file", remedy="Give it another name."
        )
