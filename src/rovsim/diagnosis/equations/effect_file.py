"""A law as a file: one effect in the form that `docs/your_own_effect.md` explains."""

from textwrap import indent
from typing import Mapping, Sequence

from rovsim.diagnosis.equations.form import Form, Number


def write_effect(
    name: str,
    form: Form,
    numbers: Sequence[Number],
    story: str,
    *,
    base: str,
    imports: str,
    method: str,
    start: Mapping[str, float],
) -> str:
    """Python source of an effect.

    Args:
        name: its id.
        form: what it says.
        numbers: its parameters.
        story: where it comes from, one line.
        base: its base class.
        imports: what is imported before that.
        method: its method, not indented.
        start: values that a fit begins from; empty where its defaults will do.
    """
    return FILE.format(
        story=story,
        meaning=form.meaning,
        imports=imports,
        id=name,
        base=base,
        names=", ".join(sorted((base, "Parameter"))),
        equation=form.equation,
        title="".join(part.capitalize() for part in name.split("_")),
        parameters="\n".join(_parameter(n) for n in numbers),
        starts=f"    starts = ({dict(start)},)\n" if start else "",
        method=indent(method.strip("\n"), "    "),
    )


def round_start(numbers: Sequence[Number]) -> dict[str, float]:
    """Where a fit of the written effect begins."""
    return {n.name: float(f"{n.value:.6g}") for n in numbers}


def _parameter(n: Number) -> str:
    more = "" if n.low is None else f", low={n.low:g}"
    more += "" if n.high is None else f", high={n.high:g}"
    more += "" if n.default is None else f", default={n.default:.6g}"
    return f'        Parameter("{n.name}", "{n.unit}", r"{n.symbol}"{more}, scale={n.scale:g}),'


FILE = '''\
"""{story}

A proposal: read it, change it, and see with `rovsim compare effects_file=…` what it is worth.
"""

{imports}from rovsim.dynamics.effects.base import {names}


class {title}({base}):
    """{meaning}"""

    id = "{id}"
    equation = r"{equation}"
    neglects = "whatever the recordings did not show"
    source = "regression on what no effect of the catalogue explained"
    parameters = (
{parameters}
    )
{starts}
{method}
'''
