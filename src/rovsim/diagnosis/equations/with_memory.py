"""Laws with a memory, which a product of states at one instant cannot express.

Each is an effect that the catalogue does not list, with a few parameters that are fitted together:
the wake of each axis, and how thrusters answer: with play, or at a limited rate. The file that is
written for such a law contains the effect's own method.
"""

import inspect
from abc import abstractmethod
from dataclasses import dataclass, replace
from textwrap import dedent
from typing import ClassVar, Mapping, Sequence

from rovsim.core.axes import AXES, FORCE, VELOCITY
from rovsim.diagnosis.equations.effect_file import round_start, write_effect
from rovsim.diagnosis.equations.form import Form, Number, Part, get_law, split_law, stated
from rovsim.dynamics.effects.base import Effect
from rovsim.dynamics.effects.fluid_memory import FluidMemory
from rovsim.dynamics.effects.thrusters import ThrusterLag
from rovsim.dynamics.laws.propeller_lag import PropellerLag
from rovsim.dynamics.laws.thruster_play import ThrusterPlay
from rovsim.dynamics.laws.thruster_rate import PropellerRate, ThrustRate
from rovsim.dynamics.laws.wake_by_axis import WakeByAxis
from rovsim.estimation.observer.hypothesis import Hypothesis, Term


@dataclass(frozen=True)
class WithMemory(Form):
    """A law that has an effect class of its own.

    Attributes:
        names: parameters of the effect that a simpler law may lack; one of them has to stay.
        effect: class of the effect.
        imitates: ids of effects that do much the same; they are removed before the law is fitted.
        imports: lines of imports that the effect's method needs, for the file of the law.
    """

    names: tuple[str, ...]

    effect: ClassVar[type[Effect]]
    imitates: ClassVar[tuple[str, ...]] = ()
    imports: ClassVar[str]

    @classmethod
    @abstractmethod
    def begin(cls, moving: Sequence[str]) -> list[tuple["WithMemory", Term]]:
        """List the law at all values that a fit starts from.

        Args:
            moving: names of the axes that were measured, and in which the vehicle can move.
        """

    def list_numbers(self, law: Term, std: Mapping[str, float]) -> list[Number]:
        """List the free parameters, in the units that the effect declares."""
        return [
            Number(
                p.name,
                p.unit,
                self._symbol(p.name),
                law.effect[p.name],
                std[p.name],
                p.scale,
                stated(p.low),
                stated(p.high),
                law.effect[p.name] if p.default else None,
            )
            for p in law.parameters
        ]

    def write(self, name: str, law: Term, numbers: Sequence[Number], story: str) -> str:
        """Write an effect with the fitted parameters, and the method of the law's effect class."""
        (base,) = self.effect.__bases__
        method = next(member for member in vars(self.effect).values() if callable(member))
        return write_effect(
            name,
            self,
            numbers,
            story,
            base=base.__name__,
            imports=self.imports,
            method=dedent(inspect.getsource(method)),
            start=round_start(numbers),
        )

    def simplify(self, h: Hypothesis) -> list[tuple[Form, Hypothesis]]:
        """List the laws without one of the parameters in `names`, as long as another is left."""
        return [
            (type(self)(_drop_name(name, self.names)), drop_number(h, name))
            for name in (self.names if len(self.names) > 1 else ())
        ]

    def _symbol(self, name: str) -> str:
        """LaTeX symbol of a parameter."""
        return next(p.symbol for p in self.effect.parameters if p.name == name)


class Wake(WithMemory):
    """A wake: water that motion along some axes has set moving goes on pushing along them.

    `names` are these axes.
    """

    effect = WakeByAxis
    imitates = (FluidMemory.id,)
    imports = (
        "import numpy as np\n\nfrom rovsim import AXES\nfrom rovsim.dynamics.body import Body\n"
    )

    @classmethod
    def begin(cls, moving: Sequence[str]) -> list[tuple[WithMemory, Term]]:
        """Start with a wake of all axes that move, from several time constants."""
        axes = tuple(moving)
        scales = {p.name: p.scale for p in WakeByAxis.parameters if p.name in axes}
        return [
            (cls(axes), Term(WakeByAxis(**scales | start), (*axes, "time_constant")))
            for start in WakeByAxis.starts
        ]

    @property
    def parts(self) -> tuple[Part, ...]:
        """One term for each axis."""
        return tuple(Part(axis, (VELOCITY[AXES.index(axis)], "memory")) for axis in self.names)

    @property
    def equation(self) -> str:
        """The law in LaTeX."""
        indices = [AXES.index(axis) for axis in self.names]
        equations = [
            rf"{FORCE[i]} = -{self._symbol(AXES[i])}\,({VELOCITY[i]} - m_{VELOCITY[i]})"
            for i in indices
        ]
        return r",\quad ".join((*equations, r"T \dot m = \nu_r - m"))

    @property
    def meaning(self) -> str:
        """The law in a sentence."""
        return f"Water that {' and '.join(self.names)} set moving, to m, goes on pushing there."

    def divide(self, law: Term) -> list[Effect]:
        """Return the wake of each axis by itself."""
        return [
            law.effect.with_values(dict.fromkeys(_drop_name(name, self.names), 0.0))
            for name in self.names
        ]

    def _symbol(self, name: str) -> str:
        return f"c_{VELOCITY[AXES.index(name)]}" if name in AXES else super()._symbol(name)


class OfThrusters(WithMemory):
    """A law of how thrusters answer, the same for all of them."""

    @classmethod
    def begin(cls, moving: Sequence[str]) -> list[tuple[WithMemory, Term]]:
        """Start where the effect says, with all its parameters."""
        form = cls(tuple(p.name for p in cls.effect.parameters))
        return [(form, Term(cls.effect(**start), form.names)) for start in cls.effect.starts]

    @property
    def parts(self) -> tuple[Part, ...]:
        """A single term, for all thrusters together."""
        return (Part("thrusters", ("thrust", "memory")),)

    @property
    def equation(self) -> str:
        """The law in LaTeX."""
        return self.effect.equation

    @property
    def meaning(self) -> str:
        """The law in a sentence."""
        return self.effect.__doc__ or ""

    def divide(self, law: Term) -> list[Effect]:
        """Return the effect itself: the law has a single term."""
        return [law.effect]


class Play(OfThrusters):
    """Play: the force of a thruster follows only once the demanded force has moved by a band.

    `names` are the parameters of the width of the band.
    """

    effect = ThrusterPlay
    imports = "import numpy as np\nfrom numpy import ndarray as Array\n\n"

    @property
    def equation(self) -> str:
        """The law in LaTeX."""
        force, width = r"F_\text{static}", {"band": "b", "share": r"s\,|F_\text{static}|"}
        w = " + ".join(width[name] for name in self.names)
        return rf"F \leftarrow \min(\max(F,\ {force} - w),\ {force} + w),\quad w = {w}"


class LimitedThrustRate(OfThrusters):
    """The force of a thruster changes at a limited rate."""

    effect = ThrustRate
    imports = (
        "from numpy import ndarray as Array\n\n"
        "from rovsim.dynamics.laws.thruster_rate import limit_rate\n"
    )


class LimitedPropellerRate(OfThrusters):
    """The speed of a propeller changes at a limited rate."""

    effect = PropellerRate
    imports = (
        "import numpy as np\nfrom numpy import ndarray as Array\n\n"
        "from rovsim.dynamics.laws.thruster_rate import limit_rate\n"
    )


class LaggingPropeller(OfThrusters):
    """The speed of a propeller follows by a first order."""

    effect = PropellerLag
    imitates = (ThrusterLag.id,)
    imports = (
        "import numpy as np\nfrom numpy import ndarray as Array\n\n"
        "from rovsim.dynamics.laws.propeller_lag import lag_speed\n"
    )


def drop_number(h: Hypothesis, gone: str) -> Hypothesis:
    """Return a hypothesis whose law has one parameter less: it is zero, and no longer free."""
    without_law, law = split_law(h)[0], get_law(h)
    reduced = Term(law.effect.with_values({gone: 0.0}), _drop_name(gone, law.free))
    return replace(without_law, terms=(*without_law.terms, reduced))


def _drop_name(gone: str, names: Sequence[str]) -> tuple[str, ...]:
    """All names except one."""
    return tuple(name for name in names if name != gone)


OF_THRUSTERS: tuple[type[WithMemory], ...] = (
    Play,
    LimitedThrustRate,
    LimitedPropellerRate,
    LaggingPropeller,
)
FORMS: tuple[type[WithMemory], ...] = (Wake, *OF_THRUSTERS)
