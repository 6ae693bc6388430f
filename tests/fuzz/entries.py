"""Doors of what a campaign and a command are made of: files, recordings, words."""

import io
import json
import zipfile
from typing import ClassVar

import numpy as np
import yaml

from damage import check_sound, damaged
from fuzz.entry import Entry, Text, command
from fuzz.hostile import value_of
from fuzz.models import step
from recordings import Swim, campaign_content, write_campaign, write_run
from rovsim.application.configuration import compose
from rovsim.application.pipeline.models import write_with_effects
from rovsim.apps.cli.main import override
from rovsim.core.array_files import read_arrays, write_arrays
from rovsim.core.mappings import flattened
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.model_file import read_model
from rovsim.dynamics.vehicle import load_vehicle
from rovsim.evaluation.held_out.published_errors import read_published
from rovsim.intake.compose import propose
from rovsim.measurement.loading import load_campaign
from rovsim.measurement.recording import read_run
from rovsim.measurement.recording.readers import mocap_readers

PUBLISHED = """run,variant,model,axis,acceleration_rmse,velocity_mae,velocity_rmse
a,6dof,knn,surge,0.1,0.02,0.03
b,3dof,gp,yaw,0.2,0.04,0.05
"""


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
        load_vehicle(campaign.vehicle, named_in=campaign.file)
        for run in campaign.runs:
            check_sound(read_run(campaign, run.id)[0])


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
        write_with_effects(self.file, "nominal", None, built_in(), self.folder / "new.yaml", {})
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
        seconds = random.choice(["nan", "20", "-1", "1e9"])
        words = ["campaign=nowhere", f"seconds={seconds}", f"{random.choice(files)}={value}"[:3000]]
        random.shuffle(words)
        self.words = [str(random.choice(self.COMMANDS)), *words, *self.words, "out=out"]

    def enter(self) -> None:
        command(*self.words)
