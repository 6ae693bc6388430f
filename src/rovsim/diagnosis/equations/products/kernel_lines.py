"""Write a law of products as the lines of an effect's kernel in Python."""

from typing import Iterator, Sequence

from rovsim.core.axes import FORCE
from rovsim.core.rounding import rounded
from rovsim.diagnosis.equations.products.library import LawTerm
from rovsim.diagnosis.equations.products.targets import FLOWS, TARGETS, WORLD_FORCES
from rovsim.diagnosis.equations.products.variables import VARIABLES, VELOCITIES_IN_CODE
from rovsim.dynamics.laws.codes import (
    DEPTH,
    DIRECTION,
    DOWN,
    EAST,
    NEARNESS,
    NORTH,
    SIZE,
    SPEED,
    SWIRL,
)
from rovsim.estimation.observer.hypothesis import Term


def write_body(names: Sequence[str], terms: Sequence[LawTerm], law: Term) -> Iterator[str]:
    """Yield the lines of the kernel of a law.

    Args:
        names: of the coefficients of the terms.
        terms: of the law.
        law: at its values, of which the drag coefficients are written into the lines.
    """
    factors = {k for t in terms for k in t.factors}
    yield from _velocities(factors, terms)
    yield from _surroundings(factors, terms)
    values: dict[str, list[str]] = {}
    for name, term in zip(names, terms, strict=True):
        text = " * ".join([f"p.{name}", *(VARIABLES[k].code for k in term.factors)])
        for head in TARGETS[term.on].heads:
            values.setdefault(head.code, []).append(text + head.inner_code)
    for symbol, parts in values.items():
        yield f"{symbol} = " + " + ".join(parts)
    body = {f: f for f in FORCE if f in values}
    world = [v if v in values else "0.0" for v in WORLD_FORCES]
    if any(v != "0.0" for v in world):
        yield from _write_rotation(world)
        body |= {
            f: f"{body[f]} + force_{f.lower()}" if f in body else f"force_{f.lower()}"
            for f in FORCE[:3]
        }
    flow = [v if v in values else "0.0" for v in FLOWS]
    if any(v != "0.0" for v in flow):
        yield from _write_drag_change(flow, law)
        body |= {
            f: f"{body[f]} + drag_{f.lower()}" if f in body else f"drag_{f.lower()}"
            for f in FORCE[:3]
        }
    yield "return " + ", ".join(body.get(f, "0.0") for f in FORCE)


def _velocities(used: set[int], terms: Sequence[LawTerm]) -> Iterator[str]:
    """Yield lines that assign the velocities and the NED z axis in body axes, as far as needed."""
    axes = {k % SIZE for k in used if k < DOWN}
    if used & {SPEED, DIRECTION} or any(TARGETS[t.on].is_water for t in terms):
        axes |= {0, 1, 2}
    for i in sorted(axes):
        yield f"{VELOCITIES_IN_CODE[i]} = at.nu_r[{i}]"
    if used & {SPEED, DIRECTION}:
        yield "U = sqrt(u * u + v * v + w * w)"
    for i in sorted({(k - DOWN) % 3 for k in used if DOWN <= k < SPEED}):
        yield f"d{'xyz'[i]} = at.R[2][{i}]  # the world's down, seen in the body"


def _surroundings(used: set[int], terms: Sequence[LawTerm]) -> Iterator[str]:
    """Yield lines that assign the distances from the law's place, and the nearness to it."""
    turning = any(t.on == SWIRL for t in terms)
    if used & {NORTH, NEARNESS} or turning:
        yield "north = at.position[0] - p.x * at.axes[0]"
    if used & {EAST, NEARNESS} or turning:
        yield "east = at.position[1] - p.y * at.axes[1]"
    if DEPTH in used:
        yield "deep = at.position[2] - p.z * at.axes[2]"
    if NEARNESS in used:
        yield "near = exp(-(north * north + east * east) / (2.0 * p.width * p.width))"


def _write_rotation(world: Sequence[str]) -> Iterator[str]:
    """Yield lines that turn a force from NED into body axes; `world` are its three components."""
    for j, f in enumerate("xyz"):
        parts = [f"at.R[{i}][{j}] * {v}" for i, v in enumerate(world) if v != "0.0"]
        yield f"force_{f} = " + " + ".join(parts)


def _write_drag_change(flow: Sequence[str], law: Term) -> Iterator[str]:
    """Yield lines that compute by how much moving water changes the drag of the vehicle.

    Args:
        flow: names of the velocity of the water north and east; `0.0` for none.
        law: gives the drag coefficients of surge, sway and heave.
    """
    yield "# drag in water that moves, less that in still water, with the model's coefficients"
    for j, (f, v) in enumerate(zip("xyz", VELOCITIES_IN_CODE[:3], strict=True)):
        parts = [f"at.R[{i}][{j}] * {w}" for i, w in enumerate(flow) if w != "0.0"]
        a, b = (rounded(law.effect[f"{kind}{j}"]) for kind in ("linear", "quadratic"))
        yield f"a = {v} - ({' + '.join(parts)})"
        yield f"drag_{f} = ({a:g} + {b:g} * abs({v})) * {v} - ({a:g} + {b:g} * abs(a)) * a"
