"""Laws of the thrust: thrust along one axis pushes along another, or varies with the motion.

Examples are a jet that is blown aside, water that hovering thrusters carry along, and a thruster
that is not where the vehicle file says. Each law has one term. How the thrust itself arises from
the commands is left to the effects of the catalogue.
"""

from dataclasses import dataclass, replace
from textwrap import indent
from typing import Iterator, Mapping, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.axes import AXES, FORCE, VELOCITY
from rovsim.core.rounding import rounded
from rovsim.diagnosis.equations.effect_file import write_effect
from rovsim.diagnosis.equations.form import Form, Number, Part
from rovsim.diagnosis.equations.products.columns import Columns
from rovsim.diagnosis.equations.products.products import KERNEL_TEMPLATE
from rovsim.diagnosis.equations.products.variables import (
    LATERAL_AXES,
    VARIABLES,
    Variable,
    write_unit,
)
from rovsim.diagnosis.structure.regressors import earlier_states
from rovsim.dynamics.effects.base import Effect
from rovsim.dynamics.laws.codes import NO_FACTOR, SIZE
from rovsim.dynamics.laws.thrust_law import MAX_THRUSTERS, SECOND_THRUST, ThrustLaw
from rovsim.dynamics.model import Model
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.observed_run import ObservedRun

DIRECTION_NAMES = ("ahead", "to starboard", "downwards", "in roll", "in pitch", "in yaw")
THRUST_VARIABLES = tuple(
    Variable(
        f"T_{X}",
        f"T_{X}",
        f"T_{X}",
        int(j >= 3),
        0,
        0,
        j in LATERAL_AXES,
        f"the thrust {name} (T_{X})",
    )
    for j, (X, name) in enumerate(zip(FORCE, DIRECTION_NAMES, strict=True))
)  # powers of m, s and rad in their units; each has one of N, too


@dataclass(frozen=True)
class ThrustTerm:
    """One term: the thrust along an axis, perhaps times another factor, pushes along an axis.

    Attributes:
        on: axis (0 to 5) of the push.
        thrust: axis (0 to 5) of the thrust.
        unsigned: whether the absolute value of that thrust is taken.
        factor: code of a further factor: a velocity or its absolute value (`laws.codes`), or
            `SECOND_THRUST` for a second thrust; `NO_FACTOR` where there is no further factor.
        other: axis (0 to 5) of the second thrust; `NO_FACTOR` where there is none.
    """

    on: int
    thrust: int
    unsigned: bool = False
    factor: int = NO_FACTOR
    other: int = NO_FACTOR

    @property
    def thrusts(self) -> tuple[int, ...]:
        """Axes of the thrusts in the term; the square of a thrust has its axis twice."""
        return (self.thrust, self.other) if self.factor == SECOND_THRUST else (self.thrust,)

    @property
    def factors(self) -> tuple[Variable, ...]:
        """The factors of the term, without its coefficient."""
        primary, *secondary = (THRUST_VARIABLES[j] for j in self.thrusts)
        if self.unsigned:
            code, latex = f"abs({primary.code})", f"|{primary.latex}|"
            primary = replace(primary, code=code, latex=latex, odd=False)
        moving = [VARIABLES[self.factor]] if NO_FACTOR < self.factor < SECOND_THRUST else []
        return (primary, *secondary, *moving)

    @property
    def odd(self) -> bool:
        """Whether the product changes sign when port and starboard are exchanged."""
        return sum(bool(factor.odd) for factor in self.factors) % 2 == 1


def list_thrust_terms(runs: Sequence[ObservedRun], model: Model) -> list[ThrustTerm]:
    """List the candidate terms that respect the mirror symmetry of port and starboard.

    A push along an axis has to change sign with that axis. A thrust that pushes along its own axis
    in proportion is left out, as the model has that already.

    Args:
        runs: which say in what axes the vehicle moves and is measured.
        model: its body has the allocation matrix B (6, thrusters).

    Returns:
        The terms; none where there are no thrusters or too many, or where B has another number
            of columns.
    """
    B = model.body.B
    if not 0 < B.shape[1] <= MAX_THRUSTERS or len(model.vehicle.thrusters.units) != B.shape[1]:
        return []
    moving = [int(i) for i in np.flatnonzero(np.logical_and.reduce([run.axes for run in runs]))]
    driven = [j for j in range(6) if np.abs(B[j]).max() > 1e-3]
    terms = (
        term for i in moving for j in driven for term in _list_between_axes(i, j, moving, driven)
    )
    return [term for term in dict.fromkeys(terms) if term.odd == (term.on in LATERAL_AXES)]


def _list_between_axes(
    i: int, j: int, moving: Sequence[int], driven: Sequence[int]
) -> Iterator[ThrustTerm]:
    """Yield terms on axis `i` of the thrust along axis `j`.

    Args:
        i: axis of the push.
        j: axis of the thrust.
        moving: axes in which the vehicle moves and is measured.
        driven: axes along which the thrusters push.
    """
    if i != j:
        yield ThrustTerm(i, j)
    yield ThrustTerm(i, j, True)
    for k in moving:
        yield from (ThrustTerm(i, j, False, k), ThrustTerm(i, j, True, k))
        yield ThrustTerm(i, j, False, SIZE + k)
    for k in driven:
        if k >= j:
            yield ThrustTerm(i, j, False, SECOND_THRUST, k)
        if k != j:
            yield ThrustTerm(i, j, True, SECOND_THRUST, k)


def evaluate_thrust(
    terms: Sequence[ThrustTerm], run: ObservedRun, model: Model, middle: Array
) -> Array:
    """Evaluate terms with a coefficient of 1 at the n readings of a run.

    Args:
        terms: c terms.
        run: with its commands.
        model: gives the forces of the thrusters, and their allocation.
        middle: not used, as no term depends on a place; see `columns.Wrenches`.

    Returns:
        Wrenches (c, n, 6) along the body axes, in the unit of each term's product.
    """
    step = np.minimum(run.at[run.innovation_samples], len(run.grid) - 2)
    force = run.replay_drives.of([model])[0].force[step]
    return evaluate_thrust_at(terms, earlier_states(run)[:, 7:], force @ model.body.B.T)


def evaluate_thrust_at(terms: Sequence[ThrustTerm], nu: Array, thrust: Array) -> Array:
    """Evaluate terms with a coefficient of 1 at given velocities and thrusts.

    Args:
        terms: c terms.
        nu: body velocities (n, 6), m/s and rad/s.
        thrust: of all thrusters together along the body axes (n, 6), N and N m.

    Returns:
        Wrenches (c, n, 6) along the body axes, in the unit of each term's product.
    """
    wrenches = np.zeros((len(terms), len(nu), 6))
    table = np.hstack([nu, np.abs(nu)])
    for out, term in zip(wrenches, terms, strict=True):
        value = thrust[:, term.thrust]
        value = np.abs(value) if term.unsigned else value
        if term.factor == SECOND_THRUST:
            value = value * thrust[:, term.other]
        elif term.factor != NO_FACTOR:
            value = value * table[:, term.factor]
        out[:, term.on] = value
    return wrenches


def begin(columns: Columns, k: int, h: Hypothesis) -> Hypothesis:
    """Add the law of the k-th term to a hypothesis, with the coefficient that regression gives."""
    term, power = columns.terms[k], columns.gram[1 + k, 1 + k]
    law = build_law(term, h.model, float(columns.size[k]), columns.gram[0, 1 + k] / power)
    return replace(h, terms=(*h.terms, law))


def build_law(term: ThrustTerm, model: Model, size: float, coefficient: float) -> Term:
    """Make the law of a term, its coefficient free.

    Args:
        term: the term.
        model: its body has the allocation matrix.
        size: RMS of the term's wrench over all runs where the coefficient of its equation is 1.
        coefficient: that of the equation times `size`; its absolute value is the RMS of the law's
            wrench, N or N m.
    """
    B = model.body.B
    values = {"c": float(coefficient), "size": 1.0 / size, "on": float(term.on)}
    values |= {"unsigned": float(term.unsigned), "factor": float(term.factor)}
    values |= {f"b{i}": float(b) for i, b in enumerate(B[term.thrust])}
    if term.factor == SECOND_THRUST:
        values |= {f"d{i}": float(b) for i, b in enumerate(B[term.other])}
    return Term(ThrustLaw(**values), ("c",))


@dataclass(frozen=True)
class WithThrust(Form):
    """A law of one term: a coefficient times a thrust, and perhaps another factor."""

    term: ThrustTerm

    @property
    def parts(self) -> tuple[Part, ...]:
        """A single term."""
        velocity = (
            (VELOCITY[self.term.factor % SIZE],)
            if NO_FACTOR < self.term.factor < SECOND_THRUST
            else ()
        )
        return (Part(AXES[self.term.on], ("thrust", *velocity)),)

    @property
    def equation(self) -> str:
        """The law in LaTeX."""
        product = r"\,".join(("c", *(factor.latex for factor in self.term.factors)))
        return f"{FORCE[self.term.on]} = {product}"

    @property
    def meaning(self) -> str:
        """The law in a sentence."""
        kind = "moment" if self.term.on >= 3 else "force"
        factors = " and ".join(factor.meaning for factor in self.term.factors)
        return f"A {AXES[self.term.on]} {kind} that varies with {factors}."

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
        """List the only parameter, the coefficient, in the unit of the equation."""
        size = law.effect["size"]
        value = law.effect["c"] * size
        scale = rounded(max(abs(value), 1e-6), 1)
        return [Number(AXES[self.term.on], self.unit, "c", value, std["c"] * size, scale)]

    def divide(self, law: Term) -> list[Effect]:
        """Return the effect itself: the law has a single term."""
        return [law.effect]

    def write(self, name: str, law: Term, numbers: Sequence[Number], story: str) -> str:
        """Write an effect whose kernel reads the forces of the thrusters."""
        return write_effect(
            name,
            self,
            numbers,
            story,
            base="Wrench",
            imports="",
            start={},
            method=KERNEL_TEMPLATE.format(body=indent("\n".join(self._lines(law)), "    ")),
        )

    def _lines(self, law: Term) -> Iterator[str]:
        """Yield the lines of the kernel."""
        t = self.term
        yield "F = at.actuators.force"
        for j, row in dict(zip(t.thrusts, "bd", strict=False)).items():
            yield f"{THRUST_VARIABLES[j].code} = {_sum(law, row)}  # thrust {DIRECTION_NAMES[j]}"
        if NO_FACTOR < t.factor < SECOND_THRUST:
            yield f"{VARIABLES[t.factor % SIZE].code} = at.nu_r[{t.factor % SIZE}]"
        yield f"push = {' * '.join((f'p.{AXES[t.on]}', *(f.code for f in t.factors)))}"
        yield "return " + ", ".join("push" if i == t.on else "0.0" for i in range(6))

    def simplify(self, h: Hypothesis) -> list[tuple[Form, Hypothesis]]:
        """Return nothing: the only term cannot be removed."""
        return []


def _sum(law: Term, row: str) -> str:
    """Write the thrust along an axis as a sum over the thrusters that contribute to it.

    Args:
        law: whose parameters hold rows of the allocation matrix.
        row: letter of the row: `b` for the first thrust, `d` for a second one.
    """
    shares = [(i, rounded(law.effect[f"{row}{i}"])) for i in range(MAX_THRUSTERS)]
    return " + ".join(f"{b:g} * F[{i}]" for i, b in shares if b)
