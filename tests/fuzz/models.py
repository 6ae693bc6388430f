"""Doors of models: vehicle files, model files, trained residuals, and what they are exported to."""

from hashlib import sha256
from typing import Any, ClassVar
from xml.etree import ElementTree

import numpy as np
import yaml

from damage import damaged
from fuzz.entry import Entry, Text
from fuzz.hostile import changed, changed_array, value_of
from rovsim.application.export.equation import Equation
from rovsim.application.export.targets import targets
from rovsim.application.export.write import represent
from rovsim.core.array_files import read_arrays, write_arrays
from rovsim.core.shipped import shipped
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.learned.residual import write_residual
from rovsim.dynamics.learned.settings import feature_names
from rovsim.dynamics.model import Model
from rovsim.dynamics.model_file import load_model, read_model
from rovsim.dynamics.vehicle import load_vehicle
from rovsim.simulation.noise_draws import NoiseDraws
from rovsim.simulation.stepper import Stepper

REST = np.array([0.0, 0, 1, 1, *[0] * 9])  # a vehicle at rest
# each ends a comment, a text or a line in some language
LETTERS = tuple("a'\"<>&%#{}[]$`;|\\- \t\n\r\x00\x1b\x85\u2028\ufffe\ud800é")


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
        residual = train(X, X[:, :6], settings, seed=0, control="all")
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


class UncertainModel(Text):
    """How sure a model file is of itself; noise and values are drawn from it."""

    name = "model uncertainty"

    def prepare(self) -> None:
        self.file = self.folder / "model.yaml"
        lift = {"effect": "lift", "parameters": {"coefficient": {"value": 20.0, "std": 2.0}}}
        names = ["surge", "sway"]
        drag = {name: {"value": 3.0, "std": 0.1} for name in names}
        between = [f"linear_damping.{name}" for name in names]
        self.uncertainty = {
            "noise": {
                "disturbance": [0.1] * 6,
                "memory_s": [1.0] * 6,
                "reading": [1e-3] * 6,
                "period_s": 0.05,
                "colour": [1e-3] * 6,
                "colour_memory_s": [0.5] * 6,
            },
            "correlation": {"between": between, "rows": [[1.0], [0.3, 1.0]]},
            "instead": [{"probability": 0.2, "effects": [lift]}],
        }
        effects = [{"effect": "linear_damping", "parameters": drag}]
        for each in ([lift], effects):  # either may be drawn: compiled here, where time is no fault
            self.model = {"vehicle": "bluerov2_heavy", "effects": each}
            self.file.write_text(self.form(self.model))
            step(read_model(self.file, built_in()))
        self.written({**self.model, "uncertainty": self.uncertainty})

    def damage(self, random: np.random.Generator) -> None:
        content = {**self.model, "uncertainty": changed(self.uncertainty, random)}
        self.file.write_text(self.form(content), encoding="utf-8", errors="surrogatepass")

    @np.errstate(all="ignore")
    def enter(self) -> None:
        model, random = read_model(self.file, built_in()), np.random.default_rng(0)
        step(model.draw(random) if model.uncertainty else model)
        noise = model.uncertainty and NoiseDraws.of(model.uncertainty.noise, random)
        if noise:
            assert np.isfinite(noise.draw_disturbance(np.full(5, 0.05), 3)).all()


class Exported(Vehicle):
    """Names that leave the comment or text they stand in, in every language that is written."""

    name = "export"
    share = 0.5

    def prepare(self) -> None:
        super().prepare()
        self.lines = self._count(self._texts())

    def damage(self, random: np.random.Generator) -> None:
        vehicle = yaml.safe_load(self.good)
        names = [vehicle, *vehicle["thrusters"]["units"]]
        for k in random.integers(len(names), size=random.integers(1, 4)):
            names[k]["name"] = self._name(random)
        text = self.form(vehicle).encode("utf-8", "surrogatepass")
        self.file.write_bytes(text)

    def _name(self, random: np.random.Generator) -> Any:
        if random.random() < 0.3:
            return value_of(random)
        letters = LETTERS[:18] if random.random() < 0.7 else LETTERS
        return "".join(random.choice(letters, random.integers(1, 20)))

    def _texts(self) -> dict[str, str]:
        model = load_model("nominal", load_vehicle(str(self.file)), built_in())
        name = model.vehicle.name
        model = model.called(name)
        every = targets().items()
        return {n: t.text(Equation(represent(model, t)[0]), [name]) for n, t in every}

    def _count(self, texts: dict[str, str]) -> dict[str, int]:
        return {name: text.count("\n") for name, text in texts.items() if name == "mss"}

    @np.errstate(all="ignore")
    def enter(self) -> None:
        texts = self._texts()
        for name in ("gz", "stonefish"):
            ElementTree.fromstring(texts[name])
        assert "MRB" in yaml.safe_load(texts["fossen"])
        assert self._count(texts) == self.lines, "a name began a line of its own"
