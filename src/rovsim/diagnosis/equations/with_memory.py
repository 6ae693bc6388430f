"""Laws with a memory, which no product of what acts at one instant can be.

Each is an effect that no catalogue lists, of a few numbers that are fitted together: the wake that
an axis leaves, and play of the thrusters. The file of such a law has the effect's own method.
"""

import inspect
from abc import abstractmethod
from dataclasses import dataclass, replace
from textwrap import dedent
from typing import ClassVar, Mapping, Sequence

from rovsim import AXES
from rovsim.core.axes import FORCE, VELOCITY
from rovsim.diagnosis.equations.effect_file import round_start, write_effect
from rovsim.diagnosis.equations.form import Form, Number, Part, get_law, split_law, stated
from rovsim.dynamics.effects.base import Effect
from rovsim.dynamics.effects.fluid_memory import FluidMemory
from rovsim.dynamics.effects.thruster_play import ThrusterPlay
from rovsim.dynamics.effects.wake_by_axis import WakeByAxis
from rovsim.estimation.observer.hypothesis import Hypothesis, Term


@dataclass(frozen=True)
class WithMemory(Form):
    """A law that is an effect of its own; `names` of the parameters that it may do without."""

    names: tuple[str, ...]

    effect: ClassVar[type[Effect]]
    imitates: ClassVar[tuple[str, ...]] = ()  # effects that it cannot stand beside
    imports: ClassVar[str]

    @classmethod
    @abstractmethod
    def begin(cls, moving: Sequence[str]) -> list[tuple["WithMemory", Term]]:
        """The law at all values that a fit starts from, on axes that move and are seen."""

    def list_numbers(self, law: Term, std: Mapping[str, float]) -> list[Number]:
        """The free parameters, as the effect declares them."""
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
        """The method of the effect itself, with the parameters that were fitted."""
        (base,) = self.effect.__bases__
        method = next(one for one in vars(self.effect).values() if callable(one))
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
        """Without each of its names, as long as one is left."""
        return [
            (type(self)(_all_but(gone, self.names)), drop_number(h, gone))
            for gone in (self.names if len(self.names) > 1 else ())
        ]

    def _symbol(self, name: str) -> str:
        return next(p.symbol for p in self.effect.parameters if p.name == name)


class Wake(WithMemory):
    """Water that some axes have set moving goes on pushing them."""

    effect = WakeByAxis
    imitates = (FluidMemory.id,)
    imports = (
        "import numpy as np\n\nfrom rovsim import AXES\nfrom rovsim.dynamics.body import Body\n"
    )

    @classmethod
    def begin(cls, moving: Sequence[str]) -> list[tuple[WithMemory, Term]]:
        """All axes that move, at several time constants."""
        axes = tuple(moving)
        some = {p.name: p.scale for p in WakeByAxis.parameters if p.name in axes}
        return [
            (cls(axes), Term(WakeByAxis(**some | start), (*axes, "time_constant")))
            for start in WakeByAxis.starts
        ]

    @property
    def parts(self) -> tuple[Part, ...]:
        """One for each axis."""
        return tuple(Part(axis, (VELOCITY[AXES.index(axis)], "memory")) for axis in self.names)

    @property
    def equation(self) -> str:
        """In LaTeX."""
        each = [AXES.index(axis) for axis in self.names]
        pushes = [
            rf"{FORCE[i]} = -{self._symbol(AXES[i])}\,({VELOCITY[i]} - m_{VELOCITY[i]})"
            for i in each
        ]
        return r",\quad ".join((*pushes, r"T \dot m = \nu_r - m"))

    @property
    def meaning(self) -> str:
        """In a sentence."""
        return f"Water that {' and '.join(self.names)} set moving, to m, goes on pushing there."

    def divide(self, law: Term) -> list[Effect]:
        """Each axis by itself."""
        return [
            law.effect.with_values(dict.fromkeys(_all_but(own, self.names), 0.0))
            for own in self.names
        ]

    def _symbol(self, name: str) -> str:
        return f"c_{VELOCITY[AXES.index(name)]}" if name in AXES else super()._symbol(name)


class Play(WithMemory):
    """Thrusters follow only once what is asked of them has moved by a band."""

    effect = ThrusterPlay
    imports = "import numpy as np\nfrom numpy import ndarray as Array\n\n"

    @classmethod
    def begin(cls, moving: Sequence[str]) -> list[tuple[WithMemory, Term]]:
        """A narrow and a wide band, and one that grows with the force."""
        form = cls(tuple(p.name for p in ThrusterPlay.parameters))
        return [(form, Term(ThrusterPlay(**start), form.names)) for start in ThrusterPlay.starts]

    @property
    def parts(self) -> tuple[Part, ...]:
        """All thrusters together."""
        return (Part("thrusters", ("thrust", "memory")),)

    @property
    def equation(self) -> str:
        """In LaTeX."""
        force, width = r"F_\text{static}", {"band": "b", "share": r"s\,|F_\text{static}|"}
        w = " + ".join(width[name] for name in self.names)
        return rf"F \leftarrow \min(\max(F,\ {force} - w),\ {force} + w),\quad w = {w}"

    @property
    def meaning(self) -> str:
        """In a sentence."""
        return ThrusterPlay.__doc__ or ""

    def divide(self, law: Term) -> list[Effect]:
        """It is one."""
        return [law.effect]


def drop_number(h: Hypothesis, gone: str) -> Hypothesis:
    """A hypothesis whose law is without one of its numbers, which then is zero."""
    rest, law = split_law(h)[0], get_law(h)
    fewer = Term(law.effect.with_values({gone: 0.0}), _all_but(gone, law.free))
    return replace(rest, terms=(*rest.terms, fewer))


def _all_but(gone: str, names: Sequence[str]) -> tuple[str, ...]:
    return tuple(name for name in names if name != gone)


FORMS: tuple[type[WithMemory], ...] = (Wake, Play)
