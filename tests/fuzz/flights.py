"""Doors of flights to come: what a design is asked, and logs that are flown."""

import json
from contextlib import suppress
from typing import Any

import numpy as np

from damage import damaged
from fuzz.entry import Entry
from fuzz.hostile import changed
from rovsim.application.configuration import compose
from rovsim.application.pipeline.design import design
from rovsim.application.pipeline.measured_campaign import measure, open_campaign
from rovsim.core.progress import heard_by
from rovsim.core.schema import checked
from rovsim.design.settings import Question
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.model import nominal
from rovsim.simulation.synthetic_tank.campaign import make_campaign
from rovsim.simulation.synthetic_tank.settings import TankRun, TankSettings

THRUSTERS = 8
PLAN: dict[str, Any] = {
    "schema": "rovsim.experiment/1", "seconds": 3.0, "model": "nominal",
    "start": {"x_m": 2.5, "y_m": 2.0, "z_m": 1.5, "yaw_rad": 0.0}, "manoeuvre": "designed",
    "expects": {}, "baselines": {}, "instructions": [],
    "keeps": {"nearest_wall_m": 1.0, "speed_m_s": 0.3, "turn_rate_rad_s": 0.1, "tilt_rad": 0.1},
}  # fmt: skip


class Flown(Entry):
    """A log of commands and the plan beside it, given to `rovsim tank fly=`."""

    name = "fly"
    share = 0.5

    def prepare(self) -> None:
        self.log, self.plan = self.folder / "plan.csv", self.folder / "plan.json"
        time = np.arange(0.0, 3.0, 0.05)
        pulses = np.column_stack([time, *np.full((THRUSTERS, len(time)), 1510.0)])
        head = ",".join(["time_s", *(f"t{k + 1}" for k in range(THRUSTERS))])
        rows = (",".join(f"{v:g}" for v in row) for row in pulses)
        self.good = "\n".join([head, *rows, ""]).encode()
        self.log.write_bytes(self.good)
        self.plan.write_text(json.dumps(PLAN))

    def damage(self, random: np.random.Generator) -> None:
        whole = random.random() < 0.3
        self.log.write_bytes(self.good if whole else damaged(self.good, random))
        plan = changed(PLAN, random) if whole else PLAN
        self.plan.write_text(json.dumps(plan))

    def enter(self) -> None:
        run = TankRun(id="flown", control="6dof", split="train", fly=str(self.log))
        tank = TankSettings(name="flown", runs=(run,))
        make_campaign(tank, self.folder / "flown", built_in(), lambda *_: None)


class Begun(Exception):
    """A question makes sense: the search begins, which takes long."""


class Designed(Entry):
    """What `rovsim design` is asked of a campaign, up to the search."""

    name = "design"
    share = 0.5

    def prepare(self) -> None:
        settings = compose([])
        runs = tuple(TankRun(id=s, control="6dof", split=s) for s in ("train", "test"))
        tank = TankSettings(name="swum", duration=12.0, runs=runs)
        make_campaign(tank, self.folder / "swum", built_in(), lambda *_: None)
        self.data = measure(open_campaign(str(self.folder / "swum")), settings.signals)
        self.question: dict[str, Any] = {
            "between": ["quadratic_damping", "cubic_damping"],
            "know": ["linear_damping.sway", "thruster_lag.time_constant"],
            "seconds": 20.0, "seed": 1,
            "design": {
                "population": 8, "rounds": 1,
                "limits": {
                    "clearance": 0.2, "speed": 1.0, "turn_rate": 1.5, "tilt": 0.5, "slew": 5.0,
                    "depth": [0.5, 2.0],
                },
            },
        }  # fmt: skip
        self.asked = self.question

    def damage(self, random: np.random.Generator) -> None:
        self.asked = changed(self.question, random)
        if random.random() < 0.3:
            ids = [*built_in(), "rigid_body", "nobody"]
            self.asked = {**self.question, "between": list(map(str, random.choice(ids, 2)))}

    @np.errstate(all="ignore")
    def enter(self) -> None:
        question = checked(Question, self.asked, "command line")
        with suppress(Begun), heard_by(_stop_at_the_search):
            design(self.data, nominal(self.data.vehicle), question, built_in())


def _stop_at_the_search(what: str, _: float | None) -> None:
    if what.endswith("usual manoeuvres"):
        raise Begun
