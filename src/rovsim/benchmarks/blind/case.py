"""One case: what is hidden in which tank, and what an answer may say about it."""

import hashlib
import zlib
from typing import Any, Literal, Mapping

import numpy as np
from pydantic import Field

from rovsim.benchmarks.blind.laws import find_outside
from rovsim.benchmarks.blind.recipes import RECIPES
from rovsim.core.schema import Section
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effect_entry import EffectEntry, Value
from rovsim.dynamics.effects.base import Effect, Parameter
from rovsim.simulation.synthetic_tank.settings import TankSettings

# First and last seed of each range. Whoever builds or tunes a method looks at development cases
# alone; a case of the other range is flown to report, never to decide.
SEEDS = {"development": (1_000_000, 1_999_999), "reporting": (5_000_000, 5_999_999)}
Range = Literal["development", "reporting"]

WEAKER = 0.8  # of the size, each time the vehicle leaves the tank


class Unlisted(Section):
    """Physics outside the catalogue, by its name in `outside` or `laws`."""

    name: str
    parameters: dict[str, float] = Field(default_factory=dict)

    def build(self) -> Effect:
        """The effect with these values."""
        return find_outside(self.name)(**self.parameters)


class Case(Section):
    """One case.

    `kind` is the row of the table it is counted in; `hidden` the truth in the catalogue's terms;
    `outside` what no entry describes; `forgiven` effects that may be named or not; `silent`
    hidden ones that the recordings cannot show, and an answer must say so; `strength` in
    terms of the recipes; `tank` settings that differ from the default campaign.
    """

    id: str
    kind: str
    seed: int
    hidden: tuple[EffectEntry, ...] = ()
    outside: tuple[Unlisted, ...] = ()
    forgiven: tuple[str, ...] = ()
    silent: tuple[str, ...] = ()
    strength: float = 1.0
    tank: dict[str, Any] = Field(default_factory=dict)

    @property
    def names(self) -> list[str]:
        """What an answer has to name."""
        return [e.effect for e in self.hidden if e.effect not in (*self.forgiven, *self.silent)]

    @property
    def verdicts(self) -> set[str]:
        """Verdicts that are right."""
        if self.outside:
            return {"unexplained"}
        return {"missing_effects"} if self.names else {"adequate"} | self._either()

    def _either(self) -> set[str]:
        quiet = {"insufficient_data"} if self.partial else set()
        return quiet | ({"missing_effects"} if self.forgiven else set())

    @property
    def partial(self) -> bool:
        """Whether not all axes need be measured, or move."""
        released = any(run.get("release") for run in self.tank.get("runs", ()))
        return bool(self.tank.get("sensors")) or released

    def settings(self) -> TankSettings:
        """The campaign to fly."""
        return TankSettings.model_validate(
            {"name": "hidden", "seed": self.seed, "effects": self.hidden, **self.tank}
        )

    def weaker(self) -> "Case":
        """The same case with smaller effects: where the pilot could not hold the vehicle."""
        outside = tuple(_shrunk_outside(entry) for entry in self.outside)
        hidden = tuple(_shrunk(entry) for entry in self.hidden)
        strength = self.strength * WEAKER
        return self.model_copy(update={"hidden": hidden, "outside": outside, "strength": strength})


def _shrunk(entry: EffectEntry) -> EffectEntry:
    """An entry whose first parameters, those a recipe sizes, are closer to their defaults."""
    declared = {p.name: p for p in built_in()[entry.effect].parameters}
    fixed = RECIPES[entry.effect].fixed
    values = {
        k: v if k in fixed or not declared[k].fitted else Value(value=_closer(v.value, declared[k]))
        for k, v in entry.parameters.items()
    }
    return EffectEntry(effect=entry.effect, parameters=values)


def _shrunk_outside(one: Unlisted) -> Unlisted:
    first = find_outside(one.name).parameters[0]
    smaller = {first.name: _closer(one.parameters[first.name], first)}
    return Unlisted(name=one.name, parameters=one.parameters | smaller)


def _closer(value: float, parameter: Parameter) -> float:
    return float(f"{parameter.combine(parameter.neutral_value, value, WEAKER):.4g}")


def seed_of(case_id: str, seeds: Range) -> int:
    """A case's seed: its own, whatever else the suite holds."""
    first, last = SEEDS[seeds]
    return first + zlib.crc32(case_id.encode()) % (last - first + 1)


def share_of(case_id: str) -> float:
    """Where a case comes in a random order, 0 to 1; cases below a share are a sample of a suite."""
    digest = hashlib.sha256(case_id.encode()).digest()  # CRC-32 is linear: alike ids go together
    return int.from_bytes(digest[:8]) / 2**64


def random_of(case_id: str, seeds: Range) -> np.random.Generator:
    """What the case's own values are drawn with."""
    return np.random.default_rng([seed_of(case_id, seeds), 1])


def merged(*settings: Mapping[str, Any]) -> dict[str, Any]:
    """Tank settings together, section by section."""
    combined: dict[str, Any] = {}
    for layer in settings:
        for key, value in layer.items():
            nested = isinstance(value, Mapping) and isinstance(combined.get(key), Mapping)
            combined[key] = {**combined[key], **value} if nested else value
    return combined
