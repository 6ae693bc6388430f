"""What every effect has: parameters with values, where fits begin, and what it needs of a run."""

from abc import ABC
from copy import copy
from typing import Any, ClassVar, Literal, Mapping, Protocol, Self

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput, unlisted
from rovsim.core.run import CommandKind, Site
from rovsim.dynamics.effects.base.parameters import Parameter, Signature

Requirement = Literal["nothing", "commands", "demands", "thrusters", "surfaces", "waterplane"]


class Actuated(Protocol):
    """What effects need to know of a vehicle: its mass, its thrusters and its control surfaces."""

    @property
    def dry_mass(self) -> float:
        """Dry mass, kg: without the water inside the vehicle."""

    @property
    def thruster_count(self) -> int:
        """Number of thrusters."""

    @property
    def thruster_names(self) -> tuple[str, ...]:
        """Names of the thrusters, in the vehicle file's order."""

    @property
    def surface_names(self) -> tuple[str, ...]:
        """Names of the control surfaces, in the vehicle file's order."""


class Effect(ABC):
    """A physical effect with values for its parameters; a value not given is the default.

    Raises:
        BadInput: an unknown parameter, or a value that is not a number or is out of range.
    """

    id: ClassVar[str]
    equation: ClassVar[str]
    symbols: ClassVar[tuple[tuple[str, str], ...]] = ()  # (LaTeX, meaning); no parameters
    neglects: ClassVar[str]
    source: ClassVar[str]
    parameters: ClassVar[tuple[Parameter, ...]]
    starts: ClassVar[tuple[dict[str, float], ...]] = ({},)  # where fits begin; {} = the defaults
    cause: ClassVar[str] = ""  # what in a laboratory makes it act, one sentence
    revealed_by: ClassVar[str] = ""  # what to record to confirm it, one sentence
    telling: ClassVar[tuple[str, ...]] = ()  # that show the effect in a run; (): any of them
    signature: ClassVar[Signature | None] = None  # how the catalogue page shows it
    listed: ClassVar[bool] = True  # False: part of every vehicle, not for the catalogue
    rank: ClassVar[int] = 0  # order among the effects of one kind along the thrust path
    requires: ClassVar[Requirement] = "nothing"  # a run without it cannot show the effect
    differs_between_runs: ClassVar[bool] = False  # crews change it: clocks, ballast, markers

    def __init__(self, **values: float) -> None:
        names = [p.name for p in self.parameters]
        for name in values:
            if name not in names:
                raise unlisted(
                    name, names, found=f"unknown parameter '{name}'", where=f"effect {self.id}"
                )
        numbers = [
            self._checked(p, values[p.name]) if p.name in values else p.default
            for p in self.parameters
        ]
        self.values: Array = np.array(numbers, dtype=float)
        self.values.setflags(write=False)
        self.std: Mapping[str, float] = {}  # standard deviations of fitted values

    def _checked(self, parameter: Parameter, value: Any) -> float:
        is_number = isinstance(value, (int, float, np.number)) and not isinstance(value, bool)
        if is_number and parameter.low <= value <= parameter.high and np.isfinite(value):
            return float(value)
        raise BadInput(
            f"{parameter.name} is {value!r}",
            where=f"effect {self.id}",
            expected=f"a number {parameter.range_in_words}",
            remedy="Correct that value.",
        )

    def __getitem__(self, name: str) -> float:
        return float(self.values[[p.name for p in self.parameters].index(name)])

    def __repr__(self) -> str:
        arguments = ", ".join(f"{k}={v:g}" for k, v in self.given().items())
        return f"{type(self).__name__}({arguments})"

    def given(self) -> dict[str, float]:
        """The values that differ from their default, by name."""
        return {
            p.name: float(v)
            for p, v in zip(self.parameters, self.values, strict=True)
            if v != p.default and np.isfinite(v)
        }

    def with_values(self, values: Mapping[str, float]) -> "Effect":
        """The same effect with some values replaced, and no standard deviations."""
        return type(self)(**self.given() | dict(values))

    def neutral(self) -> "Effect":
        """The effect at its defaults, which change nothing; unless it is not `listed`: itself."""
        return type(self)() if self.listed else self

    def with_std(self, std: Mapping[str, float]) -> "Effect":
        """The same effect with the standard deviations of its fitted values."""
        effect = copy(self)
        effect.std = dict(std)
        return effect

    @classmethod
    def starts_at(cls, site: Site) -> tuple[dict[str, float], ...]:
        """Initial values of fits at this site; several where the likelihood is flat at neutral."""
        return cls.starts

    @classmethod
    def on(cls, vehicle: Actuated) -> "type[Effect]":
        """The same effect with the parameters and starts that it has on a vehicle."""
        return cls

    @classmethod
    def adapted(cls, **own: Any) -> type[Self]:
        """A subclass with other class attributes, such as parameters, for `on` to return."""
        attributes = {"__doc__": cls.__doc__, "__module__": cls.__module__}
        return type(cls.__name__, (cls,), attributes | own)

    @classmethod
    def free_at(cls, start: Mapping[str, float]) -> tuple[str, ...]:
        """Names of the parameters that a fit from these initial values may change."""
        return tuple(p.name for p in cls.parameters if p.fitted)

    def check(self, site: Site, kind: CommandKind) -> None:  # noqa: B027 - most need nothing
        """Refuse a run that lacks what this effect needs.

        Raises:
            BadInput: no tank is known, or the commands are of another kind.
        """

    def needs_duration(self) -> bool:
        """Whether its values refer to the duration of a run, which then must be known."""
        return False
