"""Laws of the thrust: along one axis it pushes along another, or with the motion.

A jet that is blown aside, water that hovering thrusters take along, a thruster that sits elsewhere
than the vehicle file says. One term each; how the thrust itself comes about is the catalogue's.
"""

from dataclasses import dataclass, replace
from textwrap import indent
from typing import Iterator, Mapping, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim import AXES
from rovsim.core.axes import FORCE, VELOCITY
from rovsim.diagnosis.equations.effect_file import write_effect
from rovsim.diagnosis.equations.form import Form, Number, Part
from rovsim.diagnosis.equations.products.columns import Columns
from rovsim.diagnosis.equations.products.products import KERNEL
from rovsim.diagnosis.equations.products.variables import ODD, VARIABLES, Variable, write_unit
from rovsim.diagnosis.structure.regressors import earlier_states
from rovsim.dynamics.effects.base import Effect
from rovsim.dynamics.effects.law_codes import NONE, SIZE
from rovsim.dynamics.effects.thrust_law import OTHER, THRUSTERS, ThrustLaw
from rovsim.dynamics.model import Model
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.observed_run import ObservedRun

NAMES = ("ahead", "to starboard", "downwards", "in roll", "in pitch", "in yaw")
THRUST = tuple(
    Variable(
        f"T_{X}", f"T_{X}", f"T_{X}", int(j >= 3), 0, 0, j in ODD, f"the thrust {name} (T_{X})"
    )
    for j, (X, name) in enumerate(zip(FORCE, NAMES, strict=True))
)  # in N, too


@dataclass(frozen=True)
class ThrustTerm:
    """What acts `on` an axis: `thrust` along one (its size where `unsigned`), and a `factor`.

    The factor is a velocity or its size, as `law_codes` numbers them, or the thrust along `other`.
    """

    on: int
    thrust: int
    unsigned: bool = False
    factor: int = NONE
    other: int = NONE

    @property
    def thrusts(self) -> tuple[int, ...]:
        """Axes of the thrusts in it; a square has one twice."""
        return (self.thrust, self.other) if self.factor == OTHER else (self.thrust,)

    @property
    def factors(self) -> tuple[Variable, ...]:
        """What is multiplied."""
        first, *others = (THRUST[j] for j in self.thrusts)
        if self.unsigned:
            code, latex = f"abs({first.code})", f"|{first.latex}|"
            first = replace(first, code=code, latex=latex, odd=False)
        moving = [VARIABLES[self.factor]] if NONE < self.factor < OTHER else []
        return (first, *others, *moving)

    @property
    def odd(self) -> bool:
        """Whether it changes sign when port and starboard are exchanged."""
        return sum(bool(factor.odd) for factor in self.factors) % 2 == 1


def list_thrust_terms(runs: Sequence[ObservedRun], model: Model) -> list[ThrustTerm]:
    """Terms that turn with the mirror, but for a thrust along its own axis; none where unknown."""
    B = model.body.B
    if not 0 < B.shape[1] <= THRUSTERS or len(model.vehicle.thrusters.units) != B.shape[1]:
        return []
    moving = [int(i) for i in np.flatnonzero(np.logical_and.reduce([run.axes for run in runs]))]
    driven = [j for j in range(6) if np.abs(B[j]).max() > 1e-3]
    terms = (term for i in moving for j in driven for term in _of(i, j, moving, driven))
    return [term for term in dict.fromkeys(terms) if term.odd == (term.on in ODD)]


def _of(i: int, j: int, moving: Sequence[int], driven: Sequence[int]) -> Iterator[ThrustTerm]:
    if i != j:
        yield ThrustTerm(i, j)
    yield ThrustTerm(i, j, True)
    for k in moving:
        yield from (ThrustTerm(i, j, False, k), ThrustTerm(i, j, True, k))
        yield ThrustTerm(i, j, False, SIZE + k)
    for k in driven:
        if k >= j:
            yield ThrustTerm(i, j, False, OTHER, k)
        if k != j:
            yield ThrustTerm(i, j, True, OTHER, k)


def push_thrust(
    terms: Sequence[ThrustTerm], run: ObservedRun, model: Model, middle: Array
) -> Array:
    """Wrench (c, n, 6) of terms with a coefficient of 1 at the readings of a run."""
    step = np.minimum(run.at[run.innovation_samples], len(run.grid) - 2)
    force = run.replay_drives.of([model])[0].force[step]
    return push_at(terms, earlier_states(run)[:, 7:], force @ model.body.B.T)


def push_at(terms: Sequence[ThrustTerm], nu: Array, thrust: Array) -> Array:
    """Wrench (c, n, 6) of terms at velocities (n, 6) and thrust (n, 6) N, N m."""
    wrenches = np.zeros((len(terms), len(nu), 6))
    table = np.hstack([nu, np.abs(nu)])
    for out, term in zip(wrenches, terms, strict=True):
        value = thrust[:, term.thrust]
        value = np.abs(value) if term.unsigned else value
        if term.factor == OTHER:
            value = value * thrust[:, term.other]
        elif term.factor != NONE:
            value = value * table[:, term.factor]
        out[:, term.on] = value
    return wrenches


def begin(columns: Columns, k: int, h: Hypothesis) -> Hypothesis:
    """A hypothesis with the law of the k-th term, at what the regression gives it."""
    term, power = columns.terms[k], columns.gram[1 + k, 1 + k]
    law = build_law(term, h.model, float(columns.size[k]), columns.gram[0, 1 + k] / power)
    return replace(h, terms=(*h.terms, law))


def build_law(term: ThrustTerm, model: Model, size: float, coefficient: float) -> Term:
    """The law of a term that pushes with an RMS of `size` where its coefficient is 1."""
    B = model.body.B
    values = {"c": float(coefficient), "size": 1.0 / size, "on": float(term.on)}
    values |= {"unsigned": float(term.unsigned), "factor": float(term.factor)}
    values |= {f"b{i}": float(b) for i, b in enumerate(B[term.thrust])}
    if term.factor == OTHER:
        values |= {f"d{i}": float(b) for i, b in enumerate(B[term.other])}
    return Term(ThrustLaw(**values), ("c",))


@dataclass(frozen=True)
class WithThrust(Form):
    """A coefficient times a thrust, and perhaps another factor."""

    term: ThrustTerm

    @property
    def parts(self) -> tuple[Part, ...]:
        """It is one."""
        own = (VELOCITY[self.term.factor % SIZE],) if NONE < self.term.factor < OTHER else ()
        return (Part(AXES[self.term.on], ("thrust", *own)),)

    @property
    def equation(self) -> str:
        """In LaTeX."""
        product = r"\,".join(("c", *(factor.latex for factor in self.term.factors)))
        return f"{FORCE[self.term.on]} = {product}"

    @property
    def meaning(self) -> str:
        """In a sentence."""
        what = "moment" if self.term.on >= 3 else "force"
        with_what = " and ".join(factor.meaning for factor in self.term.factors)
        return f"A {AXES[self.term.on]} {what} that varies with {with_what}."

    @property
    def unit(self) -> str:
        """SI unit of the coefficient."""
        factors = self.term.factors
        powers = {"N": 1 - len(self.term.thrusts)}
        powers["m"] = int(self.term.on >= 3) - sum(factor.meters for factor in factors)
        powers["s"] = -sum(factor.seconds for factor in factors)
        powers["rad"] = -sum(factor.radians for factor in factors)
        return write_unit(powers)

    def list_numbers(self, law: Term, std: Mapping[str, float]) -> list[Number]:
        """The coefficient."""
        size = law.effect["size"]
        value = law.effect["c"] * size
        scale = float(f"{max(abs(value), 1e-6):.1g}")
        return [Number(AXES[self.term.on], self.unit, "c", value, std["c"] * size, scale)]

    def divide(self, law: Term) -> list[Effect]:
        """It is one."""
        return [law.effect]

    def write(self, name: str, law: Term, numbers: Sequence[Number], story: str) -> str:
        """A kernel of plain arithmetic that reads the thrusters."""
        return write_effect(
            name,
            self,
            numbers,
            story,
            base="Wrench",
            imports="",
            start={},
            method=KERNEL.format(body=indent("\n".join(self._lines(law)), "    ")),
        )

    def _lines(self, law: Term) -> Iterator[str]:
        t = self.term
        yield "F = at.actuators.force"
        for j, row in dict(zip(t.thrusts, "bd", strict=False)).items():
            yield f"{THRUST[j].code} = {_sum(law, row)}  # thrust {NAMES[j]}"
        if NONE < t.factor < OTHER:
            yield f"{VARIABLES[t.factor % SIZE].code} = at.nu_r[{t.factor % SIZE}]"
        yield f"push = {' * '.join((f'p.{AXES[t.on]}', *(f.code for f in t.factors)))}"
        yield "return " + ", ".join("push" if i == t.on else "0.0" for i in range(6))

    def simplify(self, h: Hypothesis) -> list[tuple[Form, Hypothesis]]:
        """It has one term."""
        return []


def _sum(law: Term, row: str) -> str:
    """Thrust along an axis, of the thrusters that have a share in it."""
    shares = [(i, float(f"{law.effect[f'{row}{i}']:.6g}")) for i in range(THRUSTERS)]
    return " + ".join(f"{b:g} * F[{i}]" for i, b in shares if b)
