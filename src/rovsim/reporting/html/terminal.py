"""What `compare` and `diagnose` say on the terminal."""

import textwrap
from typing import Any, Mapping, Sequence

from rovsim.dynamics.effects.base import Effect
from rovsim.reporting.figures.marks import number, short, significant
from rovsim.reporting.html.verdict import Missing, verdict

WIDTH, BAR = 96, 24
MOST = 6  # findings printed; the report has them all
RANKED = 5  # effects of the ranking printed


def compared(errors: Mapping[str, float | None], where: Mapping[str, Any]) -> str:
    """A table {model: normalised 2 s error}, then the findings of the last model searched."""
    lines = [
        "",
        "error on the test runs: velocity after being set to the measured state every 2 s,",
    ]
    lines += ["in units of the measured velocity's spread, mean over the excited axes", ""]
    width = max((len(short(name)) for name in errors), default=0)
    most = max((e for e in errors.values() if e is not None), default=0.0) or 1.0
    lines += [
        f"  {short(n):<{width}}  {_bar((e or 0.0) / most)} {significant(number(e))}"
        for n, e in errors.items()
    ]
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


def diagnosed(found: Mapping[str, Any], catalogue: Mapping[str, type[Effect]]) -> str:
    """The verdict, the selected effects and those most worth by themselves, with bars."""
    said = verdict(found, catalogue)
    lines = ["", f"{said.name}: {said.sentence}", ""]
    for one, words in zip(found["selected"], said.missing, strict=True):
        lines += _effect(one["error_reduction"] or 0.0, words)
    lines += _ranking(found["ranking"])
    following = [f"Next: {said.next}"] if said.next else []
    for remark in (*said.remarks, *following):
        lines += ["", *textwrap.wrap(remark, WIDTH)]
    return "\n".join(lines)


def _effect(share: float, words: Missing) -> list[str]:
    values = [f"      {value}" for value in words.parameters]
    return [f"  {words.effect:<22}{_bar(share)} {words.worth}", *values]


def _ranking(ranking: Sequence[Mapping[str, Any]]) -> list[str]:
    shown = [r for r in ranking if (r["error_reduction"] or 0.0) > 0.0][:RANKED]
    if not shown:
        return []
    rows = [
        f"  {r['effect']:<22}{_bar(r['error_reduction'])} {100 * r['error_reduction']:.0f} %"
        for r in shown
    ]
    return ["", "each alone, at its first estimate:", *rows]


def _bar(share: float) -> str:
    full = max(0, min(BAR, round(BAR * share)))
    return "█" * full + "·" * (BAR - full)
