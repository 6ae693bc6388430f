"""A model being put together: effects ticked, their values moved."""

import time
from copy import deepcopy
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from rovsim.diagnosis.apply import add_uncertainty, choose_effects, extend, list_entries
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.effect_entry import EffectEntry, Value, build_effects
from rovsim.dynamics.effects.parameters import Parameter
from rovsim.dynamics.model import Model
from rovsim.results.diagnosis import Diagnosis
from rovsim.results.fitted import FittedEffect

MOVING = 1.0  # s between two values of one hand that goes on moving
SPAN = 2.0  # scales that a slider reaches at least: a scale is a change worth looking for


@dataclass(eq=False)
class Draft:
    """A base, the diagnosis whose fitted effects are offered, and what was changed.

    `ticked` ids in order; `values` by effect and parameter where the user moved them.
    """

    base: Model
    diagnosis: Diagnosis | None
    catalogue: Catalogue
    ticked: list[str] = field(default_factory=list)
    values: dict[str, dict[str, float]] = field(default_factory=dict)
    _before: list[tuple[list[str], dict[str, dict[str, float]]]] = field(default_factory=list)
    _changing: tuple[object, float] = (None, 0.0)  # what the last change was of, and when
    _found: dict[str, Model] = field(default_factory=dict)  # by what they lack

    def __post_init__(self) -> None:
        self.ticked = [fitted.effect for fitted in self.chosen if fitted.effect in self.catalogue]

    @property
    def chosen(self) -> tuple[FittedEffect, ...]:
        """The selected effects; or the law that was taken in, and what is beside it."""
        return choose_effects(self.diagnosis, self.catalogue) if self.diagnosis else ()

    @property
    def fitted(self) -> dict[str, FittedEffect]:
        """What is known here and has values in the diagnosis, those first that are chosen."""
        by_name = {fitted.effect: fitted for fitted in self.chosen}
        for name, fitted in (self.diagnosis.fitted if self.diagnosis else {}).items():
            by_name.setdefault(name, fitted)
        return {name: fitted for name, fitted in by_name.items() if name in self.catalogue}

    @property
    def unknown(self) -> list[str]:
        """Effects that the diagnosis selected, and that the catalogue does not know."""
        return [fitted.effect for fitted in self.chosen if fitted.effect not in self.catalogue]

    def _remember(self, change: object) -> None:
        """Keep what is there; a value that goes on moving is one change."""
        now = time.monotonic()
        last, moved = self._changing
        if change is None or change != last or now - moved > MOVING:
            self._before.append((self.ticked, deepcopy(self.values)))
        self._changing = change, now

    @property
    def changed(self) -> bool:
        """Whether there is anything to undo."""
        return bool(self._before)

    def undo(self) -> None:
        """Take back the last change."""
        if self._before:
            self.ticked, self.values = self._before.pop()
            self._changing = None, 0.0

    def tick(self, effect: str, yes: bool) -> None:
        """Add or leave out an effect."""
        self._remember(None)
        self.ticked = [*(t for t in self.ticked if t != effect), *([effect] if yes else [])]

    def move(self, effect: str, parameter: str, value: float) -> None:
        """Change a value."""
        self._remember((effect, parameter))
        self.values.setdefault(effect, {})[parameter] = value

    def reset(self, effect: str, parameter: str) -> None:
        """Give a value back the one it began with: the fitted one, if there is one."""
        self._remember(None)
        self.values.get(effect, {}).pop(parameter, None)

    def entry(self, effect: str) -> EffectEntry:
        """An effect with its fitted values, those moved in their place.

        An effect without fitted values begins where a fit of it would.
        """
        if effect in self.fitted:
            (entry,) = list_entries([self.fitted[effect]], Path("diagnosis.json"))
        else:
            cls = self.catalogue[effect]
            defaults = {
                p.name: p.default for p in cls.parameters if p.fitted and p.default == p.default
            }
            start = {**defaults, **cls.starts[0]}
            entry = EffectEntry.model_validate({"effect": effect, "parameters": start})
        moved = {k: Value(value=v) for k, v in self.values.get(effect, {}).items()}
        return entry.model_copy(update={"parameters": {**entry.parameters, **moved}})

    def model(self) -> Model:
        """The base and the ticked effects.

        Raises:
            BadInput: values no model can have.
        """
        model = extend(self.base, build_effects(map(self.entry, self.ticked), self.catalogue))
        if self.diagnosis is None or any(self.values.values()):
            return model
        return add_uncertainty(
            model, self.ticked, self.base, self.diagnosis, Path("diagnosis.json"), self.catalogue
        )

    def found(self, but: str = "") -> Model:
        """The base and the chosen effects as they were fitted, perhaps all but one; made once."""
        if but not in self._found:
            entries = list_entries(
                [fitted for fitted in self.chosen if fitted.effect != but], Path("diagnosis.json")
            )
            effects = build_effects(entries, self.catalogue)
            self._found[but] = extend(self.base, effects)
        return self._found[but]


def reach(parameter: Parameter, value: float) -> tuple[float, float]:
    """Lowest and highest value of a slider that begins at `value`."""
    if parameter.discrete and np.isfinite(whole := (parameter.low, parameter.highest)).all():
        return whole
    span = max(SPAN * parameter.scale, abs(value))
    low, high = max(parameter.low, value - span), min(parameter.high, value + span)
    return (float(low), float(high)) if np.isfinite([low, high]).all() else (-1.0, 1.0)
