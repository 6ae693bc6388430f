"""Write a law as a Python file: an effect in the form that `docs/your_own_effect.md` explains."""

from textwrap import indent
from typing import Mapping, Sequence

from rovsim.core.rounding import rounded
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
    """Write the Python source of an effect.

    Args:
        name: id of the effect; its class is named after that.
        form: gives the equation of the law, and its meaning in a sentence.
        numbers: parameters of the effect.
        story: one line on where the law comes from.
        base: name of the base class of the effect.
        imports: lines of imports that come before that of the base class.
        method: source of the method that computes the effect, not indented.
        start: parameter values that a fit begins from; empty where the defaults will do.
    """
    return FILE_TEMPLATE.format(
        story=story,
        meaning=form.meaning,
        imports=imports,
        id=name,
        base=base,
        names=", ".join(sorted((base, "Parameter"))),
        equation=form.equation,
        title="".join(word.capitalize() for word in name.split("_")),
        parameters="\n".join(_parameter(n) for n in numbers),
        starts=f"    starts = ({dict(start)},)\n" if start else "",
        method=indent(method.strip("\n"), "    "),
    )


def round_start(numbers: Sequence[Number]) -> dict[str, float]:
    """Round the fitted values to six digits, as the start of a fit of the written effect."""
    return {n.name: rounded(n.value) for n in numbers}


def _parameter(n: Number) -> str:
    """The line of the file that declares one parameter."""
    bounds = "" if n.low is None else f", low={n.low:g}"
    bounds += "" if n.high is None else f", high={n.high:g}"
    bounds += "" if n.default is None else f", default={n.default:.6g}"
    return f'        Parameter("{n.name}", "{n.unit}", r"{n.symbol}"{bounds}, scale={n.scale:g}),'


FILE_TEMPLATE = '''\
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
