"""Every door into the program: a valid input, ways to damage it, and the code behind the door.

An entry is one class here; the tests find it by itself.
"""

import io
import json
import zipfile
from hashlib import sha256
from pathlib import Path
from typing import Any, Callable, ClassVar

import numpy as np
import yaml

from damage import check_sound, damaged
from fuzz.hostile import TEXTS, changed, changed_array, value_of
from recordings import Swim, campaign_content, write_campaign, write_run
from rovsim.application.intake.compose import propose
from rovsim.application.pipeline.models import add_effects
from rovsim.application.settings import compose
from rovsim.apps.cli.main import main, override
from rovsim.core.array_files import read_arrays, write_arrays
from rovsim.core.errors import RovsimError
from rovsim.core.mappings import flattened
from rovsim.core.shipped import shipped
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.learned.features import feature_names
from rovsim.dynamics.learned.residual import write_residual
from rovsim.dynamics.model import Model
from rovsim.dynamics.model_file import load_model, read_model
from rovsim.dynamics.vehicle import load_vehicle
from rovsim.evaluation.held_out.published_errors import read_published
from rovsim.measurement.campaign import load_campaign
from rovsim.measurement.recording import read_run
from rovsim.measurement.recording.readers import mocap_readers
from rovsim.simulation.stepper import Stepper

ENTRIES: dict[str, type["Entry"]] = {}
PUBLISHED = """run,variant,model,axis,acceleration_rmse,velocity_mae,velocity_rmse
a,6dof,knn,surge,0.1,0.02,0.03
b,3dof,gp,yaw,0.2,0.04,0.05
"""
REST = np.array([0.0, 0, 1, 1, *[0] * 9])  # a vehicle at rest


class Refused(RovsimError):
    """A command that ended with an exit code of its own."""


class Entry:
    """One door: `prepare` writes a valid input once, `damage` spoils it, `enter` uses it."""

    name: ClassVar[str]
    share: ClassVar[float] = 1.0  # of the tries: less where one takes long
    refuses: ClassVar[bool] = True  # some of the damage; a log is read around a scratch

    def __init_subclass__(cls) -> None:
        if hasattr(cls, "name"):
            ENTRIES[cls.name] = cls

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def prepare(self) -> None:
        raise NotImplementedError

    def damage(self, random: np.random.Generator) -> None:
        raise NotImplementedError

    def enter(self) -> None:
        """Use the input as the program does; RovsimError refuses it."""
        raise NotImplementedError


class Text(Entry):
    """A YAML or JSON file: faults in its tree, in its bytes, or another text altogether."""

    file: Path
    form: Callable[[Any], str] = staticmethod(
        lambda tree: yaml.safe_dump(tree, allow_unicode=True, sort_keys=False)
    )

    def written(self, tree: Any) -> None:
        self.tree = tree
        self.file.write_text(self.form(tree), encoding="utf-8")
        self.good = self.file.read_bytes()

    def damage(self, random: np.random.Generator) -> None:
        way = random.random()
        if way < 0.7:
            text = self.form(changed(self.tree, random)).encode("utf-8", "surrogatepass")
        elif way < 0.97:
            text = damaged(self.good, random)
        else:
            text = random.choice(list(TEXTS.values())).encode()
        self.file.write_bytes(text)


class CampaignYaml(Text):
    name = "campaign.yaml"

    def prepare(self) -> None:
        self.folder = write_run(self.folder, "csv", Swim.ned(frames=40))
        self.file = self.folder / "campaign.yaml"
        content = campaign_content("csv")
        content["tank"] = {"x": [0.0, 5.0], "z": [0.0, 3.0]}
        content["mocap"]["sensors"] = {}
        write_campaign(self.folder, content)
        self.written(yaml.safe_load(self.file.read_text()))

    def enter(self) -> None:
        campaign = load_campaign(self.folder)
        load_vehicle(campaign.vehicle, beside=self.folder)
        for run in campaign.runs:
            check_sound(read_run(campaign, run.id)[0])


def step(model: Model) -> None:
    """One step of the compiled engine: sizes that do not fit would crash it."""
    stepper = Stepper(model, duration=60.0)
    stepper.step(REST, np.zeros(stepper.columns), 0.01)


class Vehicle(Text):
    name = "vehicle"
    source = "bluerov2_heavy"

    def prepare(self) -> None:
        self.file = self.folder / "vehicle.yaml"
        source = shipped("conf/vehicle") / f"{self.source}.yaml"
        self.written(yaml.safe_load(source.read_text()))

    @np.errstate(all="ignore")
    def enter(self) -> None:
        step(load_model("nominal", load_vehicle(str(self.file)), built_in()))


class Torpedo(Vehicle):
    name = "vehicle with fins"
    source = "remus100"


class ModelYaml(Text):
    name = "model"

    def prepare(self) -> None:
        self.file = self.folder / "model.yaml"
        vehicle = yaml.safe_load((shipped("conf/vehicle") / "bluerov2_heavy.yaml").read_text())
        effects = [
            {"effect": "thruster_lag", "parameters": {"time_constant": 0.2}},
            {"effect": "linear_damping", "parameters": {"surge": {"value": 3.0, "std": 0.1}}},
            {"effect": "input_delay", "parameters": {"delay": 0.1}},
        ]
        self.written({"schema": "rovsim.model/1", "vehicle": vehicle, "effects": effects})

    @np.errstate(all="ignore")
    def enter(self) -> None:
        step(read_model(self.file, built_in()))


class Neighbours(Entry):
    """Arrays of a residual whose digest is right, so that what is in them is looked at."""

    name = "residual knn"
    settings: ClassVar[dict[str, Any]] = {"kind": "knn"}

    def prepare(self) -> None:
        from rovsim.learning.learner import learner_settings, train

        random = np.random.default_rng(0)
        settings = learner_settings(self.settings)
        X = random.normal(size=(200, len(feature_names(settings.features))))
        residual = train(X, X[:, :6], settings, seed=0).residual("all")
        self.model, self.file = self.folder / "model.yaml", self.folder / "residual.npz"
        self.stored = write_residual(self.folder, residual).model_dump(mode="json")
        self.arrays = read_arrays(self.file)
        self._name()

    def _name(self) -> None:
        digest = sha256(self.file.read_bytes()).hexdigest()
        content = {"vehicle": "bluerov2_heavy", "residual": {**self.stored, "sha256": digest}}
        self.model.write_text(yaml.safe_dump(content))

    def damage(self, random: np.random.Generator) -> None:
        arrays = dict(self.arrays)
        name = str(random.choice(list(arrays)))
        arrays[name] = changed_array(arrays[name], random)
        write_arrays(self.file, **arrays)
        if random.random() < 0.3:
            self.file.write_bytes(damaged(self.file.read_bytes(), random))
        self._name()

    @np.errstate(all="ignore")
    def enter(self) -> None:
        step(read_model(self.model, built_in()))


class Process(Neighbours):
    name = "residual gp"
    settings: ClassVar = {"kind": "gp", "max_points": 40, "tuning_points": 40, "iterations": 3}


class Archive(Entry):
    """An .npz that promises more than it holds, or unpacks to more than a memory."""

    name = "archive"
    share = 0.2

    def prepare(self) -> None:
        self.file = self.folder / "arrays.npz"
        write_arrays(self.file, data=np.arange(100.0))

    def damage(self, random: np.random.Generator) -> None:
        head = io.BytesIO()
        shape = (int(random.choice([10**9, 10**15, 2**62, 4, 0])), int(random.choice([1, 10**6])))
        shape = shape[: int(random.integers(1, 3))]
        kind = str(random.choice(["<f8", "|O", "<U100000000", "|V9"]))
        described = {"descr": kind, "fortran_order": False, "shape": shape}
        np.lib.format.write_array_header_1_0(head, described)
        filling = bytes(int(random.choice([0, 8, 10**6, 3 * 10**8], p=[0.4, 0.3, 0.25, 0.05])))
        names = ["data.npy", "../../up.npy", "a\nb.npy", "", "data", "x" * 60_000]
        with zipfile.ZipFile(self.file, "w", zipfile.ZIP_DEFLATED) as archive:
            for name in dict.fromkeys(random.choice(names, 2, p=[0.75, *[0.05] * 5])):
                archive.writestr(zipfile.ZipInfo(name), head.getvalue() + filling, 8)

    def enter(self) -> None:
        read_arrays(self.file)


class DiagnosisJson(Text):
    """A diagnosis that is given to `add`."""

    name = "diagnosis.json"
    form = staticmethod(json.dumps)

    def prepare(self) -> None:
        self.file = self.folder / "diagnosis.json"
        fitted = {
            "effect": "thruster_lag",
            "parameters": {"time_constant": {"value": 0.2, "std": 0.01, "unit": "s"}},
        }
        self.written(
            {
                "schema": "rovsim.diagnosis/1",
                "verdict": "missing_effects",
                "selected": [fitted],
                "ranking": [fitted],
                "indistinguishable": [],
                "where": [],
                "unexplained": {"fraction": 0.1, "significant": False, "hint": ""},
                "next_experiment": "",
                "error": {"nominal": 0.2, "with_effects": 0.1, "noise_floor": 0.1},
                "base": {"vehicle": "bluerov2_heavy"},
                "ladder": {"steps": []},
            }
        )

    def enter(self) -> None:
        add_effects(self.file, "nominal", None, built_in(), self.folder / "new.yaml", {})
        step(read_model(self.folder / "new.yaml", built_in()))


class Recordings(Entry):
    """Files that `init` looks into: a whole folder, one of them damaged."""

    format: ClassVar[str]
    refuses = False

    def prepare(self) -> None:
        (self.folder / "raw").mkdir()
        write_run(self.folder / "raw", self.format, Swim.ned(frames=60))
        (self.folder / "raw" / "campaign.yaml").unlink()
        files = sorted(p for p in (self.folder / "raw").rglob("*") if p.is_file())
        self.good = {file: file.read_bytes() for file in files}
        self.count = 0

    def damage(self, random: np.random.Generator) -> None:
        for file, raw in self.good.items():
            file.write_bytes(raw)
        file = list(self.good)[int(random.integers(len(self.good)))]
        file.write_bytes(damaged(self.good[file], random))

    @np.errstate(all="ignore")
    def enter(self) -> None:
        self.count += 1
        scratch = self.folder / f"scratch{self.count}"
        propose([self.folder / "raw"], self.folder / "out", scratch)


for _format in mocap_readers():
    type(
        f"Init_{_format}",
        (Recordings,),
        {"name": f"init {_format}", "format": _format, "share": 0.2},
    )


class Published(Text):
    """The csv of errors that others reached."""

    name = "published errors"

    def prepare(self) -> None:
        self.file = self.folder / "published.csv"
        self.good = PUBLISHED.encode()

        self.file.write_bytes(self.good)

    def damage(self, random: np.random.Generator) -> None:
        self.file.write_bytes(damaged(self.good, random))

    def enter(self) -> None:
        read_published(self.file)


class Overrides(Entry):
    """Keys and values of the command line."""

    name = "overrides"
    share = 0.3

    def prepare(self) -> None:
        self.keys = list(flattened(compose([]).model_dump(mode="json")))
        self.words = ["tank=tiny"]

    def damage(self, random: np.random.Generator) -> None:
        self.words = [self._word(random) for _ in range(random.integers(1, 3))]

    def _word(self, random: np.random.Generator) -> str:
        key = self.keys[int(random.integers(len(self.keys)))]
        value = value_of(random)
        text = value if isinstance(value, str) else json.dumps(value)
        word = f"{key}={text[:2000]}"
        if random.random() < 0.3:
            word = damaged(word.encode("utf-8", "replace"), random).decode("utf-8", "replace")
        return str(random.choice(["", "", "", "+", "++", "~", "-", "--"])) + word

    def enter(self) -> None:
        compose([override(word) for word in self.words])


class CommandLine(Overrides):
    """Whole commands whose words are wrong; they may answer with exit code 2 alone."""

    name = "command line"
    share = 0.2
    COMMANDS = ("compare", "diagnose", "train", "add", "export", "design", "init", "tank", "fmu")

    def prepare(self) -> None:
        super().prepare()
        self.words = ["--version"]

    def damage(self, random: np.random.Generator) -> None:
        super().damage(random)
        files = ("campaign", "model", "diagnosis", "effects_file", "effects", "fly", "to")
        value = value_of(random)
        # a campaign that is not there ends what would take long
        words = ["campaign=nowhere", "seconds=nan", f"{random.choice(files)}={value}"[:3000]]
        random.shuffle(words)
        self.words = [str(random.choice(self.COMMANDS)), *words, *self.words, "out=out"]

    def enter(self) -> None:
        try:
            main(self.words)
        except SystemExit as end:
            if end.code != 0:
                raise Refused(end.code) from None
