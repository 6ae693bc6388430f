"""A hypothesis: a base model and further effects, some of whose parameters are to be fitted."""

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Mapping, NamedTuple

import numpy as np
from numpy import ndarray as Array

from rovsim.dynamics.effects.base import Effect, Parameter
from rovsim.dynamics.model import Model

SCALED_STEP = 0.02  # of a parameter's scale: far above rounding, far below curvature


class Bounds(NamedTuple):
    """Least and greatest value that a fit may give a parameter, in its unit."""

    low: float
    high: float


@dataclass(frozen=True, eq=False)
class Term:
    """An effect with its values, of which the parameters in `free` may change.

    Each within the range that its effect declares, or within `bounds`, by name, where this vehicle
    allows less; and as fine as its effect declares, or as `resolutions`, by name, where these runs
    show less.
    """

    effect: Effect
    free: tuple[str, ...]
    bounds: Mapping[str, Bounds] = field(default_factory=dict)
    resolutions: Mapping[str, float] = field(default_factory=dict)

    @property
    def id(self) -> str:
        """The effect's id."""
        return self.effect.id

    @cached_property
    def parameters(self) -> list[Parameter]:
        """The free parameters, with the range that the fit keeps to, and their resolution."""
        by_name = {p.name: p for p in self.effect.parameters}
        return [self._limited(by_name[name]) for name in self.free]

    def _limited(self, parameter: Parameter) -> Parameter:
        low, high = self.bounds.get(parameter.name, (parameter.low, parameter.high))
        resolution = self.resolutions.get(parameter.name, parameter.resolution)
        return replace(parameter, low=low, high=high, resolution=resolution)

    @cached_property
    def x(self) -> Array:
        """Values of the free parameters, in units of their scale."""
        return np.array([self.effect[p.name] / p.scale for p in self.parameters])

    @property
    def choices(self) -> int:
        """How many numbers it chose: its free parameters, or the one way it was tried.

        No choice are shapes: they are fitted wherever the data determine them.
        """
        return max(1, sum(not p.shape for p in self.parameters))

    @property
    def vanishes(self) -> bool:
        """Whether its defaults are its absence; if not, it stays or goes as a whole."""
        return {} in self.effect.starts

    def step_limits(self, trusted: float) -> tuple[Array, Array]:
        """Lowest and highest scaled step that stays in range, and within `trusted` scales."""
        scale = np.array([p.scale for p in self.parameters])
        low = np.array([p.low for p in self.parameters]) / scale - self.x
        high = np.array([p.high for p in self.parameters]) / scale - self.x
        return np.maximum(low, -trusted) - 1e-9, np.minimum(high, trusted) + 1e-9

    def merged(self, more: "Term") -> "Term":
        """This term with the changes of another of the same effect added."""
        if not more.free:  # what is tried takes the other's place
            return more
        old, new = self.effect.given(), more.effect.given()
        parameters = {p.name: p for p in self.effect.parameters}
        values = {
            k: parameters[k].combine(old.get(k, parameters[k].neutral_value), v)
            for k, v in new.items()
        }
        free = (*self.free, *(name for name in more.free if name not in self.free))
        return replace(self, effect=self.effect.with_values(values), free=free)

    def at(self, x: Array) -> "Term":
        """The same term at other scaled values, kept inside their range."""
        values = {
            p.name: float(np.clip(v * p.scale, p.low, p.high))
            for p, v in zip(self.parameters, x, strict=True)
        }
        return replace(self, effect=self.effect.with_values(values))


@dataclass(frozen=True, eq=False)
class Hypothesis:
    """A base model and terms that are added to it."""

    base: Model
    terms: tuple[Term, ...] = ()

    @cached_property
    def model(self) -> Model:
        """The base with all terms."""
        model = self.base
        for term in self.terms:
            model = model + term.effect
        return model

    @property
    def key(self) -> tuple:
        """The same for the same base and terms, in the same order, at the same values."""
        effects = tuple((e.id, e.values.tobytes()) for e in self.base.effects)
        terms = (
            (t.id, t.free, tuple(sorted(t.bounds.items())), t.effect.values.tobytes())
            for t in self.terms
        )
        # a vehicle cannot be hashed; models that come of one another share theirs
        return (id(self.base.vehicle), self.base.residual, effects, *terms)

    @property
    def x(self) -> Array:
        """All free parameters, scaled."""
        return np.concatenate([np.empty(0), *(term.x for term in self.terms)])

    @property
    def parameter_names(self) -> list[str]:
        """The free parameters, as `effect.parameter`."""
        return [f"{term.id}.{p.name}" for term in self.terms for p in term.parameters]

    @property
    def free_parameters(self) -> frozenset[str]:
        """Ids of the terms and names of their free parameters, in any order."""
        return frozenset([*(term.id for term in self.terms), *self.parameter_names])

    @property
    def shapes(self) -> Array:
        """Which of them (k,) are shapes, that say nothing without the others."""
        return np.array([p.shape for term in self.terms for p in term.parameters], bool)

    @property
    def absence(self) -> Array:
        """Their values (k,), scaled, at which they change nothing."""
        return np.array([p.default / p.scale for term in self.terms for p in term.parameters])

    @cached_property
    def steps(self) -> Array:
        """A step of each scaled parameter (k,) that stays inside its range, to see what changes."""
        parameters = [p for term in self.terms for p in term.parameters]
        sizes = [max(SCALED_STEP, p.resolution / p.scale) for p in parameters]
        return np.array(
            [
                -step if (x + step) * p.scale > p.high else step
                for x, step, p in zip(self.x, sizes, parameters, strict=True)
            ],
            float,
        )

    @cached_property
    def perturbed(self) -> list["Hypothesis"]:
        """Hypotheses (k,) that are one of these steps away each; made once, as their models are."""
        return [
            self.replaced(i, term.at(term.x + step))
            for i, (term, own) in enumerate(zip(self.terms, self.columns, strict=True))
            for step in np.diag(self.steps[own])
        ]

    @property
    def columns(self) -> list[list[int]]:
        """Entries of x that belong to each term."""
        stops = np.cumsum([len(term.free) for term in self.terms])
        return [list(range(b - len(t.free), b)) for t, b in zip(self.terms, stops, strict=True)]

    def at(self, x: Array) -> "Hypothesis":
        """The same hypothesis at other scaled values."""
        stops = np.cumsum([len(term.free) for term in self.terms])
        parts = np.split(x, stops[:-1]) if self.terms else []
        return replace(self, terms=tuple(t.at(p) for t, p in zip(self.terms, parts, strict=True)))

    def with_term(self, term: Term) -> "Hypothesis":
        """The hypothesis and one more term; two of the same effect become one."""
        places = [i for i, other in enumerate(self.terms) if other.id == term.id]
        if not places:
            return replace(self, terms=(*self.terms, term))
        merged = self.terms[places[0]].merged(term)
        return replace(
            self, terms=tuple(merged if i == places[0] else t for i, t in enumerate(self.terms))
        )

    def without(self, index: int) -> "Hypothesis":
        """The hypothesis without one of its terms."""
        return replace(self, terms=(*self.terms[:index], *self.terms[index + 1 :]))

    def without_effect(self, effect_id: str) -> "Hypothesis":
        """The hypothesis without the term of an effect; the same if it has none."""
        return replace(self, terms=tuple(term for term in self.terms if term.id != effect_id))

    def replaced(self, index: int, term: Term) -> "Hypothesis":
        """The hypothesis with another term in the place of one of its own."""
        return replace(self, terms=(*self.terms[:index], term, *self.terms[index + 1 :]))
