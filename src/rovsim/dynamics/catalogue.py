"""The catalogue: every effect that a model file can name and a diagnosis can find."""

import importlib
import pkgutil
from functools import cache
from importlib.metadata import entry_points
from pathlib import Path
from types import MappingProxyType, ModuleType
from typing import Iterable, Iterator, Mapping, Sequence

from rovsim.core.errors import BadInput, nearest
from rovsim.dynamics import effects
from rovsim.dynamics.effects.base import Effect, Requirement, Wrench
from rovsim.dynamics.user_effects.effects_file import check_effects, read_effects
from rovsim.dynamics.user_effects.trials import try_on
from rovsim.dynamics.vehicle import Vehicle

# What a vehicle may lack, in words; its vehicle file has a section of that name.
PART_NAMES: Mapping[Requirement, str] = {
    "thrusters": "thrusters",
    "surfaces": "control surfaces",
    "waterplane": "a waterplane",
}


class Catalogue(Mapping[str, type[Effect]]):
    """Effect classes by id, sorted.

    Attributes:
        files: those of a user's effects.
        impossible: by id, what a vehicle would need for effects that are left out (`on`).
    """

    def __init__(
        self,
        effects: Mapping[str, type[Effect]],
        files: Sequence[Path] = (),
        impossible: Mapping[str, Requirement] = MappingProxyType({}),
    ) -> None:
        self._by_id = dict(sorted(effects.items()))
        self.files = tuple(files)
        self.impossible = impossible

    def __getitem__(self, name: str) -> type[Effect]:
        return self._by_id[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._by_id)

    def __len__(self) -> int:
        return len(self._by_id)

    @property
    def wrenches(self) -> tuple[type[Wrench], ...]:
        """The wrench effects, for which engines are compiled."""
        return tuple(cls for cls in self.values() if issubclass(cls, Wrench))

    def on(self, vehicle: Vehicle) -> "Catalogue":
        """The effects that can act on a vehicle, with the parameters and starts they have there.

        Raises:
            BadInput: a user's effect fails on this vehicle.
        """
        needs = {name: cls.requires for name, cls in self.items()}
        impossible = {name: need for name, need in needs.items() if need in vehicle.lacking}
        classes = {n: cls.on(vehicle) for n, cls in self.items() if n not in impossible}
        for name in classes.keys() - built_in().keys():
            try_on(classes[name], vehicle)
        return Catalogue(classes, self.files, {**self.impossible, **impossible})

    def find(self, name: str) -> type[Effect]:
        """The effect with this id.

        Raises:
            BadInput: there is none, and the message names the nearest id; or it cannot act on the
                vehicle.
        """
        if name in self:
            return self[name]
        if name in self.impossible:
            need = self.impossible[name]
            raise BadInput(
                f"'{name}' cannot act on a vehicle without {PART_NAMES[need]}",
                where="effects",
                expected="effects of what the vehicle has",
                remedy=f"Leave it out, or describe what is there in the vehicle file, in '{need}'.",
            )
        raise BadInput(
            f"unknown effect '{name}'",
            where="effects",
            expected="an id of the catalogue, or one that effects_file=FILE.py declares",
            remedy=nearest(name, self),
        )


def load_catalogue(files: Sequence[Path] = ()) -> Catalogue:
    """Load the effects of this package, of installed packages, and of these files.

    Raises:
        BadInput: a file or an entry point cannot be used, or has no complete effect.
    """
    classes = dict(built_in())
    for origin, content in _installed():
        classes |= check_effects(content, origin, classes)
    for path in files:
        classes |= read_effects(path, classes)
    return Catalogue(classes, files)


@cache
def built_in() -> Catalogue:
    """The effects of this package: every module of `rovsim.dynamics.effects`."""
    for module in pkgutil.iter_modules(effects.__path__):
        importlib.import_module(f"{effects.__name__}.{module.name}")
    by_id: dict[str, type[Effect]] = {}
    for cls in _concrete(Effect):
        if not cls.__module__.startswith(f"{effects.__name__}."):
            continue
        if by_id.get(cls.id, cls) is not cls:
            raise BadInput(
                f"the id '{cls.id}' is that of {by_id[cls.id].__module__} as well",
                where=cls.__module__,
                expected="an id that no other effect has",
                remedy="Give the new effect an id of its own.",
            )
        by_id[cls.id] = cls
    return Catalogue(by_id)


def _concrete(cls: type[Effect]) -> Iterable[type[Effect]]:
    """Yield the listed subclasses that have an id, without those adapted to a vehicle."""
    if getattr(cls, "id", None) and cls.listed:
        yield cls
        return  # its subclasses are the same effect on some vehicle
    for inner in cls.__subclasses__():
        yield from _concrete(inner)


@cache
def _installed() -> list[tuple[str, Mapping[str, object]]]:
    """Members of all modules or classes that entry points `rovsim.effects` name, with their origin.

    Raises:
        BadInput: one of them cannot be imported.
    """
    modules: list[tuple[str, Mapping[str, object]]] = []
    for entry in entry_points(group="rovsim.effects"):
        origin = f"entry point {entry.name} = {entry.value}"
        try:
            loaded = entry.load()
        except Exception as error:
            raise BadInput(
                f"cannot be imported ({type(error).__name__}: {error})",
                where=origin,
                expected="a class or a module of effects",
                remedy="Correct that package, or remove it.",
            ) from None
        content = vars(loaded) if isinstance(loaded, ModuleType) else {entry.name: loaded}
        modules.append((origin, content))
    return modules
