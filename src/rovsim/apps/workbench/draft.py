"""A draft: a model that a user puts together from effects by hand."""

import time
from copy import deepcopy
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from rovsim.diagnosis.apply import add_uncertainty, choose_effects, extend
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.effect_entry import EffectEntry, Value, build_effects
from rovsim.dynamics.effects.base import Parameter
from rovsim.dynamics.model import Model
from rovsim.results.diagnosis import Diagnosis
from rovsim.results.fitted import FittedEffect

MAX_MOVE_PAUSE_S = 1.0  # s between two values of one hand that goes on moving
SOURCE = Path("diagnosis.json")  # where fitted effects are from, for messages
# scales that a slider reaches at least: a scale is a change worth looking for
MIN_SLIDER_SCALES = 2.0


@dataclass(eq=False)
class Draft:
    """The base with the effects that a user has added to it.

    Attributes:
        base: the model without them.
        diagnosis: whose fitted effects are offered; None if there is none.
        catalogue: all effects that are known.
        ticked: ids of the added effects, in the order in which they were added.
        values: by effect and parameter, where the user has changed them.
    """

    base: Model
    diagnosis: Diagnosis | None
    catalogue: Catalogue
    ticked: list[str] = field(default_factory=list)
    values: dict[str, dict[str, float]] = field(default_factory=dict)
    _before: list[tuple[list[str], dict[str, dict[str, float]]]] = field(default_factory=list)
    _changing: tuple[object, float] = (None, 0.0)  # subject and time (s) of the last change
    _fitted_models: dict[str, Model] = field(default_factory=dict)  # by the effect that is left out

    def __post_init__(self) -> None:
        self.ticked = [fitted.effect for fitted in self.chosen if fitted.effect in self.catalogue]

    @property
    def chosen(self) -> tuple[FittedEffect, ...]:
        """The selected effects; or the proposed law, if it was loaded, and effects beside it."""
        return choose_effects(self.diagnosis, self.catalogue) if self.diagnosis else ()

    @property
    def fitted(self) -> dict[str, FittedEffect]:
        """Known effects that the diagnosis has fitted, by id; the chosen ones come first."""
        by_name = {fitted.effect: fitted for fitted in self.chosen}
        for name, fitted in (self.diagnosis.fitted if self.diagnosis else {}).items():
            by_name.setdefault(name, fitted)
        return {name: fitted for name, fitted in by_name.items() if name in self.catalogue}

    @property
    def unknown(self) -> list[str]:
        """Ids of effects that the diagnosis selected but the catalogue does not have."""
        return [fitted.effect for fitted in self.chosen if fitted.effect not in self.catalogue]

    def _remember(self, change: object) -> None:
        """Keep the present state for `undo`, before a change.

        A value that is changed again and again within `MAX_MOVE_PAUSE_S` is one change. `change` is
        its subject; None for a change that always counts by itself.
        """
        now = time.monotonic()
        last, moved = self._changing
        if change is None or change != last or now - moved > MAX_MOVE_PAUSE_S:
            self._before.append((self.ticked, deepcopy(self.values)))
        self._changing = change, now

    @property
    def changed(self) -> bool:
        """Whether there is anything to undo."""
        return bool(self._before)

    def undo(self) -> None:
        """Undo the last change."""
        if self._before:
            self.ticked, self.values = self._before.pop()
            self._changing = None, 0.0

    def tick(self, effect: str, yes: bool) -> None:
        """Add or leave out an effect."""
        self._remember(None)
        self.ticked = [*(t for t in self.ticked if t != effect), *([effect] if yes else [])]

    def move(self, effect: str, parameter: str, value: float) -> None:
        """Change the value of a parameter."""
        self._remember((effect, parameter))
        self.values.setdefault(effect, {})[parameter] = value

    def reset(self, effect: str, parameter: str) -> None:
        """Set a parameter back to its fitted value, or to its start if it has none."""
        self._remember(None)
        self.values.get(effect, {}).pop(parameter, None)

    def entry(self, effect: str) -> EffectEntry:
        """Return an effect as a model file states it, with the values that the user changed.

        All others are the fitted ones; for an effect that was not fitted, those where its fit would
        start.
        """
        if effect in self.fitted:
            entry = EffectEntry.of(self.fitted[effect], SOURCE)
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
        """Build a model of the base and the ticked effects.

        It states the uncertainty of the diagnosis as long as no value was changed.

        Raises:
            BadInput: the values are not possible.
        """
        model = extend(self.base, build_effects(map(self.entry, self.ticked), self.catalogue))
        if self.diagnosis is None or any(self.values.values()):
            return model
        return add_uncertainty(
            model, self.ticked, self.base, self.diagnosis, SOURCE, self.catalogue
        )

    def fitted_model(self, but: str = "") -> Model:
        """Return the base with the chosen effects as they were fitted, without the effect `but`."""
        if but not in self._fitted_models:
            kept = [fitted for fitted in self.chosen if fitted.effect != but]
            entries = [EffectEntry.of(fitted, SOURCE) for fitted in kept]
            effects = build_effects(entries, self.catalogue)
            self._fitted_models[but] = extend(self.base, effects)
        return self._fitted_models[but]


def reach(parameter: Parameter, value: float) -> tuple[float, float]:
    """Return the lowest and highest value of a slider that begins at `value`."""
    if parameter.discrete and np.isfinite(whole := (parameter.low, parameter.highest)).all():
        return whole
    span = max(MIN_SLIDER_SCALES * parameter.scale, abs(value))
    low, high = max(parameter.low, value - span), min(parameter.high, value + span)
    return (float(low), float(high)) if np.isfinite([low, high]).all() else (-1.0, 1.0)
