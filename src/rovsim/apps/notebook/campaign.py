"""An open campaign in a notebook: it calls the functions of the commands, with their settings."""

from dataclasses import dataclass, field
from os import PathLike, fspath
from pathlib import Path
from typing import Sequence

from pandas import DataFrame

from rovsim.application.configuration import compose
from rovsim.application.export.sizes import flights
from rovsim.application.export.targets import target
from rovsim.application.export.write import export_model, model_parts, write_export
from rovsim.application.pipeline.comparison import compare
from rovsim.application.pipeline.diagnosis import diagnose
from rovsim.application.pipeline.measured_campaign import (
    MeasuredCampaign,
    measure,
    open_campaign,
    refuse_unusable,
)
from rovsim.application.pipeline.models import load_models, load_one_model, write_with_effects
from rovsim.application.pipeline.result_cache import kept_diagnosis, kept_folder
from rovsim.application.pipeline.training import train
from rovsim.application.provenance import describe_origin, provenance
from rovsim.application.sections import TrainingSettings
from rovsim.application.settings import Settings, select
from rovsim.apps.notebook import html
from rovsim.apps.notebook.progress import in_a_cell
from rovsim.apps.notebook.shown import ShownComparison, ShownDiagnosis, ShownExport, ShownModel
from rovsim.core.extras import require
from rovsim.core.files import sha256_of
from rovsim.core.model_names import name_learned
from rovsim.core.progress import reported
from rovsim.diagnosis.settings import DiagnosisSettings
from rovsim.dynamics.catalogue import Catalogue, load_catalogue
from rovsim.dynamics.model_file import read_model
from rovsim.results.diagnosis import Diagnosis
from rovsim.simulation.synthetic_tank.campaign import make_campaign

Spec = str | PathLike[str]


@dataclass(eq=False)
class Campaign:
    """A campaign whose recordings were read and cleaned.

    Methods take models as the commands do: a name or a file. Comparisons are kept while the
    notebook runs. Diagnoses are kept in the folder of the workbench, and are read from there as
    long as recordings, settings, model and code are the same.
    """

    settings: Settings
    catalogue: Catalogue
    data: MeasuredCampaign
    _compared: dict[tuple[str, ...], ShownComparison] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """Name of the campaign, as in campaign.yaml."""
        return self.data.campaign.name

    @property
    def runs(self) -> DataFrame:
        """All runs: split, control, length, and why a run is not used."""
        rows = {
            run.id: (
                run.split,
                run.control,
                self.data.quality[run.id].duration_s if run.id in self.data.motions else None,
                self.data.quality[run.id].unusable or "",
            )
            for run in self.data.campaign.runs
        }
        columns = ["split", "control", "seconds", "unusable"]
        return DataFrame.from_dict(rows, orient="index", columns=columns)

    def compare(self, *models: Spec) -> ShownComparison:
        """Replay all runs with these models (nominal unless given); returns errors and figures.

        Raises:
            BadInput: a model cannot be loaded, or no run can be used.
        """
        refuse_unusable(self.data)
        specs = [fspath(model) for model in models or ("nominal",)]
        key = tuple(map(_content, specs))
        if key not in self._compared:
            loaded = load_models(specs, self.data.vehicle, self.catalogue)
            with in_a_cell():
                self._compared[key] = ShownComparison(compare(self.data, loaded, self.settings))
        return self._compared[key]

    def diagnose(self, model: Spec = "nominal") -> ShownDiagnosis:
        """Find which effects a model lacks; a diagnosis that was made before is read.

        Raises:
            BadInput: the model cannot be loaded, or cannot be diagnosed.
        """
        base = load_one_model(fspath(model), self.data.vehicle, self.catalogue)
        settings, folder = select(self.settings, DiagnosisSettings), self._folder
        path = kept_diagnosis(folder, self.data.campaign, settings, base, self._vehicle_catalogue)
        if not path.exists():
            with in_a_cell():
                diagnosis = diagnose(
                    self.data.campaign, self.data.runs, base, settings, self.catalogue
                )
                diagnosis.write(path)
        return ShownDiagnosis(Diagnosis.read(path), path, self._vehicle_catalogue)

    def add(
        self,
        diagnosis: ShownDiagnosis,
        path: Spec,
        effects: Sequence[str] | None = None,
        to: Spec = "nominal",
    ) -> ShownModel:
        """Write a model with the effects that a diagnosis selected, or with those named.

        Another model of that name is kept beside it, as NAME.earlier.yaml.

        Raises:
            BadInput: an effect that the diagnosis does not have, or a place that cannot be written.
        """
        story = {"diagnosis": str(diagnosis.path), **describe_origin(self.catalogue)}
        out = Path(path)
        write_with_effects(diagnosis.path, fspath(to), effects, self.catalogue, out, story)
        return self.model(out)

    def train(
        self,
        residual: str = "knn",
        model: Spec = "nominal",
        control: str = "6dof",
        path: Spec | None = None,
        **keys: object,
    ) -> ShownModel:
        """Train a residual on top of a model; `keys` are those of its section: k=5 for knn.

        Raises:
            BadInput: no such learner or key, or no run of that control to learn from.
        """
        require("learn", by="campaign.train")
        overrides = [f"residual={residual}", f"control={control}"]
        config = compose([*overrides, *(f"residual.{key}={value}" for key, value in keys.items())])
        update = {"residual": config.residual, "control": config.control}
        settings = select(self.settings.model_copy(update=update), TrainingSettings)
        base = load_one_model(fspath(model), self.data.vehicle, self.catalogue)
        name = name_learned(residual, control, base.name)
        out = Path(path or self._folder / "trained" / name / f"{name}.yaml")
        with in_a_cell():
            story = provenance(settings, self.catalogue, self.data.campaign)
            train(self.data.motions.values(), base, settings, self.catalogue, out, story)
        return self.model(out)

    def export(self, model: Spec, to: str, path: Spec | None = None) -> ShownExport:
        """Write a model for another simulator; the parts left out are sized over these runs.

        Raises:
            BadInput: no such simulator, or it cannot hold such a model.
        """
        simulator = target(to)
        loaded = load_one_model(fspath(model), self.data.vehicle, self.catalogue)
        out = Path(path or f"{loaded.name}{simulator.suffix}")
        over, parts = f"the runs of {self.name}", model_parts(loaded)
        export = export_model(
            loaded, simulator, lambda: flights(loaded, self.data.motions.values()), over, parts
        )
        write_export(export, out)
        return ShownExport(out, simulator.title, export.left)

    def model(self, path: Spec) -> ShownModel:
        """Read a model file.

        Raises:
            BadInput: it is missing, or does not describe a model.
        """
        return ShownModel(read_model(Path(path), self.catalogue), Path(path))

    @property
    def _folder(self) -> Path:
        return kept_folder(self.settings.out, self.data.campaign)

    @property
    def _vehicle_catalogue(self) -> Catalogue:
        return self.catalogue.on(self.data.vehicle)

    def _repr_html_(self) -> str:
        vehicle = f"Vehicle: {self.data.vehicle.name}"
        parts = [html.heading(self.name), html.sentences([vehicle]), html.table(self.runs)]
        return "".join(parts)


def _content(spec: str) -> str:
    """Return a model's name, or its path with a digest, so that a changed file is read again."""
    path = Path(spec)
    return f"{spec} {sha256_of(path)}" if path.is_file() else spec


def open(
    folder: Spec, *overrides: str, effects_file: Spec | Sequence[Spec] = (), out: Spec | None = None
) -> Campaign:
    """Open a campaign: read, check and clean its runs.

    Args:
        folder: that holds campaign.yaml.
        overrides: settings as on the command line, for example "filter=savgol".
        effects_file: files with effects of one's own.
        out: folder of results; results/NAME/ui unless given.

    Raises:
        BadInput: an override, the campaign or a file cannot be used.
    """
    files = [effects_file] if isinstance(effects_file, str | PathLike) else effects_file
    update = {
        "campaign": fspath(folder),
        "effects_file": [fspath(file) for file in files] or None,
        "out": None if out is None else fspath(out),
    }
    settings = compose(overrides).model_copy(update=update)
    catalogue = load_catalogue(settings.effect_files)
    with in_a_cell():
        data = measure(open_campaign(settings.campaign), settings.signals, even_unusable=True)
    return Campaign(settings, catalogue, data)


def tank(folder: Spec, *overrides: str, effects_file: Spec | Sequence[Spec] = ()) -> Path:
    """Make a synthetic campaign, as `rovsim tank` does; returns its folder.

    Raises:
        BadInput: an override that cannot be used, or a folder that holds something else.
    """
    files = [effects_file] if isinstance(effects_file, str | PathLike) else effects_file
    catalogue = load_catalogue([Path(file) for file in files])
    with in_a_cell(), reported("flying") as progress:
        make_campaign(compose(overrides).tank, Path(folder), catalogue, progress)
    return Path(folder)
