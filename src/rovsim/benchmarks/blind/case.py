"""One case: what is hidden in which tank, and which answers to it are right."""

import hashlib
import zlib
from typing import Any, Literal, Mapping

import numpy as np
from pydantic import Field

from rovsim.benchmarks.blind.known_laws import find_outside
from rovsim.benchmarks.blind.recipes import RECIPES
from rovsim.core.rounding import rounded
from rovsim.core.schema import Section
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effect_entry import EffectEntry, Value
from rovsim.dynamics.effects.base import Effect, Parameter
from rovsim.simulation.synthetic_tank.settings import TankSettings

# First and last seed of each range. Methods are built and tuned on development cases alone; cases
# of the other range are flown to report results, never to decide anything.
SEED_RANGES = {"development": (1_000_000, 1_999_999), "reporting": (5_000_000, 5_999_999)}
Range = Literal["development", "reporting"]

WEAKENING_FACTOR = 0.8  # of the size, each time the vehicle leaves the tank


class Unlisted(Section):
    """Physics outside the catalogue.

    Attributes:
        name: in `outside` or `laws`.
        parameters: values by name, in the parameters' units.
    """

    name: str
    parameters: dict[str, float] = Field(default_factory=dict)

    def build(self) -> Effect:
        """Build the effect with these values."""
        return find_outside(self.name)(**self.parameters)


class Case(Section):
    """One case of the benchmark.

    Attributes:
        id: unique name; the seed is made from it.
        kind: row of the table in which the case is counted.
        seed: of the campaign.
        hidden: effects of the catalogue that are hidden.
        outside: physics that is hidden and that no effect of the catalogue describes.
        forgiven: effects that an answer may name or not.
        silent: hidden effects that the recordings cannot show; an answer has to say so.
        strength: of the hidden effects, relative to their recipes.
        tank: settings that differ from the default campaign.
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
        """Ids of the effects that an answer has to name."""
        return [e.effect for e in self.hidden if e.effect not in (*self.forgiven, *self.silent)]

    @property
    def verdicts(self) -> set[str]:
        """Verdicts that are right."""
        if self.outside:
            return {"unexplained"}
        return (
            {"missing_effects"} if self.names else {"adequate"} | self._verdicts_beside_adequate()
        )

    def _verdicts_beside_adequate(self) -> set[str]:
        """Return verdicts that are right besides `adequate` where no effect has to be named."""
        all_silent = bool(self.hidden) and all(e.effect in self.silent for e in self.hidden)
        quiet = {"insufficient_data"} if self.partial or all_silent else set()
        return quiet | ({"missing_effects"} if self.forgiven else set())

    @property
    def partial(self) -> bool:
        """Whether there may be axes that are not measured, or that do not move."""
        released = any(run.get("release") for run in self.tank.get("runs", ()))
        return bool(self.tank.get("sensors")) or released

    def settings(self) -> TankSettings:
        """Return the settings of the campaign to fly."""
        return TankSettings.model_validate(
            {"name": "hidden", "seed": self.seed, "effects": self.hidden, **self.tank}
        )

    def weaker(self) -> "Case":
        """Return the same case with smaller effects, for a pilot that cannot hold the vehicle."""
        outside = tuple(_shrunk_outside(entry) for entry in self.outside)
        hidden = tuple(_weaken_entry(entry) for entry in self.hidden)
        strength = self.strength * WEAKENING_FACTOR
        return self.model_copy(update={"hidden": hidden, "outside": outside, "strength": strength})


def _weaken_entry(entry: EffectEntry) -> EffectEntry:
    """Move the parameters of an effect that strength changes closer to their neutral values."""
    declared = {p.name: p for p in built_in()[entry.effect].parameters}
    fixed = RECIPES[entry.effect].fixed
    values = {
        k: v
        if k in fixed or not declared[k].fitted
        else Value(value=_weaken_value(v.value, declared[k]))
        for k, v in entry.parameters.items()
    }
    return EffectEntry(effect=entry.effect, parameters=values)


def _shrunk_outside(one: Unlisted) -> Unlisted:
    """Move the first parameter of an effect outside the catalogue, its size, closer to neutral."""
    first = find_outside(one.name).parameters[0]
    smaller = {first.name: _weaken_value(one.parameters[first.name], first)}
    return Unlisted(name=one.name, parameters=one.parameters | smaller)


def _weaken_value(value: float, parameter: Parameter) -> float:
    return rounded(parameter.combine(parameter.neutral_value, value, WEAKENING_FACTOR), 4)


def seed_of(case_id: str, seeds: Range) -> int:
    """Return the seed of a case, which does not depend on the other cases of the suite."""
    first, last = SEED_RANGES[seeds]
    return first + zlib.crc32(case_id.encode()) % (last - first + 1)


def share_of(case_id: str) -> float:
    """Return a pseudo-random number from 0 to 1; cases below a share are a sample of a suite."""
    digest = hashlib.sha256(case_id.encode()).digest()  # CRC-32 would correlate similar ids
    return int.from_bytes(digest[:8]) / 2**64


def random_of(case_id: str, seeds: Range) -> np.random.Generator:
    """Return the random numbers from which a case's own values are drawn."""
    return np.random.default_rng([seed_of(case_id, seeds), 1])


def merged(*settings: Mapping[str, Any]) -> dict[str, Any]:
    """Merge tank settings section by section; later ones win."""
    combined: dict[str, Any] = {}
    for layer in settings:
        for key, value in layer.items():
            nested = isinstance(value, Mapping) and isinstance(combined.get(key), Mapping)
            combined[key] = {**combined[key], **value} if nested else value
    return combined
