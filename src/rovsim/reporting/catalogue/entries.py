"""Write the text of the catalogue page from the declarations of the effects alone."""

import inspect
from itertools import groupby
from typing import Iterable, Mapping

import numpy as np

from rovsim.core.signs import minus
from rovsim.dynamics.effects.base import (
    Autopilot,
    Coefficients,
    CommandTiming,
    CommandTransform,
    DemandTransform,
    Effect,
    FrameMisalignment,
    MeasurementFilter,
    Parameter,
    Signature,
    StochasticCurrent,
    ThrustCurveShape,
    ThrusterDynamics,
    ThrustScaling,
    Wrench,
)
from rovsim.reporting.units import unit
from rovsim.reporting.words.symbols import explain_symbols

PAGE, PICTURES = "catalogue.md", "images/effects"
MAX_OPEN_ROWS = 8  # rows of a table that is folded away
CHAPTERS = {
    "What the vehicle weighs and displaces, and what pushes it": (
        Coefficients,
        StochasticCurrent,
        Wrench,
    ),
    "From a logged command to a thruster's force": (
        CommandTiming,
        DemandTransform,
        CommandTransform,
        ThrustCurveShape,
        ThrustScaling,
        ThrusterDynamics,
    ),
    "What the motion capture reports": (FrameMisalignment, MeasurementFilter),
}
INTRODUCTION = """\
# The catalogue of effects

What a simulator of an underwater vehicle may lack, one entry each: what it is, what makes it happen
in a laboratory, what it looks like, and what to record to be sure of it.

**How to read a picture.** The effect was hidden in two minutes of a small synthetic tank, in calm
water and with better cameras than usual, with the values under the picture: often larger than in a
laboratory, to be seen. Black is what the nominal model then misses: the acceleration error at the
measured state, measured minus model, in means over half a second (grey dots; black dots are their
mean over a bin, with two standard errors, or their root mean square). Orange is what the true
effect adds to the model. Left: over the condition that shows it best. Right: over time.

Several pictures are alike. One run shows that something is missing; what it is, and not something
that imitates it, often takes a manoeuvre of its own. Each entry names that one.

This page is written by `make catalogue` from the declarations in `src/rovsim/dynamics/effects/`:
edit those.
"""


def page(effects: Mapping[str, type[Effect]]) -> str:
    """Return the Markdown of the page with these effects, grouped by where they act.

    It does not depend on the order of `effects`.
    """
    chapters = chaptered(effects)
    parts = [INTRODUCTION, *(_contents(title, classes) for title, classes in chapters.items())]
    for title, classes in chapters.items():
        parts += [f"## {title}\n", *(entry(cls) for cls in classes)]
    return "\n".join(parts).rstrip() + "\n"


def chaptered(effects: Mapping[str, type[Effect]]) -> dict[str, list[type[Effect]]]:
    """Sort effects into chapters by where they act.

    Effects of an autopilot or of thrusters belong to the chapter on commands.
    """
    command = list(CHAPTERS)[1]
    chapters: dict[str, list[type[Effect]]] = {title: [] for title in CHAPTERS}
    for _, cls in sorted(effects.items()):
        # a filter of poses also shifts the clock of the commands: the last that fits counts
        title = next(t for t, kinds in reversed(CHAPTERS.items()) if issubclass(cls, kinds))
        on_the_way = issubclass(cls, Autopilot) or cls.__module__.endswith(".thrusters")
        chapters[command if on_the_way else title].append(cls)
    return chapters


def _contents(title: str, classes: Iterable[type[Effect]]) -> str:
    links = " · ".join(f"[{cls.id}](#{cls.id})" for cls in classes)
    return f"**{title}:** {links}\n"


def entry(cls: type[Effect]) -> str:
    """Return the Markdown of one effect: its equation, picture, cause and parameters."""
    summary, _, details = (inspect.getdoc(cls) or "").partition("\n\n")
    more = f"\n{_flat(details)}\n" if details else ""
    return f"""\
### {cls.id}

{_flat(summary)}
{more}
```math
{cls.equation}
```

{_where(cls)}{_picture(cls.id, cls.signature, {p.name: p.unit for p in cls.parameters})}
**Cause.** {cls.cause}

**What settles it.** {cls.revealed_by}

**Neglects** {cls.neglects}. **Source:** {cls.source}.

{_table(cls.parameters)}
"""


def _where(cls: type[Effect]) -> str:
    meanings = "; ".join(f"$`{symbol}`$: {meaning}" for symbol, meaning in explain_symbols(cls))
    return f"where {meanings}.\n\n" if meanings else ""


def _picture(name: str, signature: Signature | None, units: Mapping[str, str]) -> str:
    if signature is None:
        return ""
    quantity = "size of the" if signature.size else "mean"
    text = f"{quantity} {signature.axis} error over {signature.condition}"
    values = ", ".join(
        f"{k} = {minus(f'{v:g}')} {unit(units[k])}".strip() for k, v in signature.values.items()
    )
    return (
        f"![{name}: {text}]({PICTURES}/{name}.png)\n\n<sub>Hidden: {values}. Left: {text}.</sub>\n"
    )


def _table(parameters: Iterable[Parameter]) -> str:
    """Return a table of parameters; those that differ only in name share a row."""
    rows = ["| parameter | symbol | unit | range | default | scale |", "|---|---|---|---|---|---|"]
    alike = groupby(parameters, key=lambda p: (p.unit, p.low, p.high, _default(p), p.scale))
    for (si, low, high, default, scale), group in alike:
        row = list(group)
        names = ", ".join(f"`{p.name}`" for p in row)
        columns = [names, _symbols(row), unit(si) or "–", _range(low, high), default, f"{scale:g}"]
        rows.append(f"| {' | '.join(columns)} |")
    text = "\n".join(rows)
    if len(rows) <= MAX_OPEN_ROWS:
        return text
    return f"<details><summary>Parameters</summary>\n\n{text}\n\n</details>"


def _symbols(same: list[Parameter]) -> str:
    """List the symbols of the parameters in a row: up to three, else the first and the last."""
    symbols = [f"$`{p.symbol}`$" for p in same]
    return ", ".join(symbols) if len(symbols) <= 3 else f"{symbols[0]} … {symbols[-1]}"


def _default(p: Parameter) -> str:
    return "the site's" if np.isnan(p.default) else minus(f"{p.default:g}")


def _range(low: float, high: float) -> str:
    if np.isinf(low) and np.isinf(high):
        return "any"
    if np.isinf(high):
        return minus(f"≥ {low:g}")
    return minus(f"≤ {high:g}" if np.isinf(low) else f"{low:.3g} … {high:.3g}")


def _flat(text: str) -> str:
    return " ".join(text.split())
