"""Models side by side as the compiled engine reads them: constants, and parameters of wrenches."""

from collections import Counter
from functools import lru_cache
from types import ModuleType
from typing import NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effects.base import Wrench
from rovsim.dynamics.engine.modules import attached, engine
from rovsim.dynamics.engine.types import Constants, WrenchParameters
from rovsim.dynamics.model import Model
from rovsim.simulation.drive import Reads

KEPT = 8  # what the threads of a fit simulate now, on one run after another


class PackedModels(NamedTuple):
    """m models of one vehicle, packed for one engine.

    Attributes:
        engine: compiled, with all wrench effects that any of them has.
        constants: of their equations of motion.
        parameters: of their wrench effects.
        reads: columns of a drive that the engine's effects read; None if they read nothing.
    """

    engine: ModuleType
    constants: Constants
    parameters: WrenchParameters
    reads: Reads | None


@lru_cache(KEPT)
def pack(models: tuple[Model, ...], candidates: tuple[type[Wrench], ...]) -> PackedModels:
    """Pack models; `candidates` are wrench effects that later models of the same task may have."""
    compiled, extra = _slots(models, candidates)
    slots = [*compiled, *extra]
    parameters = WrenchParameters(
        np.stack([_slotted(m, slots) for m in models]),
        attached(extra, sum(len(cls.channels) for cls in compiled)) if extra else None,
    )
    constants = Constants.stacked([m.constants for m in models])
    made = engine(compiled, bool(extra))
    return PackedModels(made, constants, parameters, _reads(models[0], slots))


def _slots(
    models: Sequence[Model], candidates: Sequence[type[Wrench]]
) -> tuple[tuple[type[Wrench], ...], list[type[Wrench]]]:
    """List the wrench effects that an engine is compiled with, and those attached to it.

    An engine takes seconds to compile, and effects that a model lacks hardly slow it down. So it
    has all built-in wrench effects, or none where no model has any. A user's own effects, and an
    effect that a model has a second time, are attached.
    """
    counts = Counter(candidates)
    for model in models:
        counts |= Counter(type(wrench) for wrench in model.wrenches)
    if not counts:
        return (), []
    extra = counts - Counter(built_in().wrenches)
    return built_in().wrenches, sorted(extra.elements(), key=lambda cls: cls.id)


def _slotted(model: Model, slots: Sequence[type[Wrench]]) -> Array:
    """For each slot 1 where the model has such an effect, else 0, followed by its parameters."""
    wrenches = list(model.wrenches)
    blocks = [np.zeros(0)]
    for cls in slots:
        wrench = next((w for w in wrenches if type(w) is cls), None)
        if wrench is not None:
            wrenches.remove(wrench)
        values = np.zeros(len(cls.parameters)) if wrench is None else wrench.values
        blocks += [np.array([float(wrench is not None)]), values]
    return np.concatenate(blocks)


def _reads(model: Model, slots: Sequence[type[Wrench]]) -> Reads | None:
    """Columns of a drive that the effects of an engine read; None if they read nothing."""
    if not any(cls.reads() for cls in slots):
        return None
    actuators = len(model.body.places) + model.body.B.shape[1]
    return Reads(actuators, tuple(name for cls in slots for name in cls.channels))
