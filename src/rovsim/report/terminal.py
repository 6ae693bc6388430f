"""What `compare` says on the terminal: how far each model is, and where the last one fails."""

import textwrap
from typing import Any, Mapping

from rovsim.figures.marks import number, short, significant

WIDTH = 96
MOST = 6  # findings printed; the report has them all


def told(errors: Mapping[str, float | None], where: Mapping[str, Any]) -> str:
    """A table {model: normalised 2 s error}, then the findings of the last model searched."""
    lines = [
        "",
        "error on the test runs: velocity after being set to the measured state every 2 s,",
    ]
    lines += ["in units of the measured velocity's spread, mean over the excited axes", ""]
    width = max((len(short(name)) for name in errors), default=0)
    lines += [f"  {short(n):<{width}}  {significant(number(e))}" for n, e in errors.items()]
    return "\n".join([*lines, *_findings(where)])


def _findings(where: Mapping[str, Any]) -> list[str]:
    models = where.get("models", {})
    if not models:
        return []
    name, model = list(models.items())[-1]
    told, rest = model["sentences"][:MOST], len(model["sentences"]) - MOST
    lines = [
        "",
        f"where {short(name)} fails ({model['split']} runs {', '.join(model['runs'])})",
        "",
    ]
    for one in told:
        lines += textwrap.wrap(one, WIDTH, initial_indent="  - ", subsequent_indent="    ")
    return [*lines, f"  … and {rest} more in the report"] if rest > 0 else lines
