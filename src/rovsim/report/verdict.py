"""What `diagnose` says on the terminal."""

import textwrap
from typing import Any, Mapping

from rovsim.figures.marks import number, significant

WIDTH, BAR = 96, 24
VERDICTS = {
    "missing_effects": "The model lacks physics that the catalogue knows.",
    "adequate": "Nothing is missing: what is left is noise.",
    "unexplained": "Something is missing that the catalogue does not know.",
    "insufficient_data": "The recording does not say: not enough was moved.",
}


def told(found: Mapping[str, Any]) -> str:
    """Verdict, selected effects with bars, what is left, what to record next."""
    lines = ["", f"{found['verdict']}: {VERDICTS[found['verdict']]}", ""]
    lines += [line for one in found["selected"] for line in _effect(one)]
    lines += _ranking(found)
    if found["indistinguishable"]:
        groups = "; ".join(" = ".join(g) for g in found["indistinguishable"])
        lines += ["", f"cannot be told apart: {groups}"]
    if found["unexplained"]["significant"]:
        lines += ["", *_wrapped(found["unexplained"]["hint"])]
    errors = ", ".join(
        f"{k.replace('_', ' ')} {significant(number(v))}" for k, v in found["error"].items()
    )
    lines += ["", f"error on the test runs (2 s windows, normalised): {errors}"]
    return "\n".join([*lines, "", *_wrapped(f"next: {found['next_experiment']}")])


def _wrapped(text: str) -> list[str]:
    return textwrap.wrap(text, WIDTH)


def _bar(share: float) -> str:
    full = max(0, min(BAR, round(BAR * share)))
    return "█" * full + "·" * (BAR - full)


def _effect(one: Mapping[str, Any]) -> list[str]:
    share = one["error_reduction"] or 0.0
    sure = f"of the error, probability {one['probability']:.3f}"
    head = f"  {one['effect']:<22}{_bar(share)} {100 * share:5.1f} % {sure}"
    rows = [
        f"      {name:<18}{value['value']:>10.4g} ± {1.96 * value['std']:.2g} {value['unit']}"
        if "std" in value
        else f"      {name:<18}{value['value']:>10.4g} {value['unit']}"
        for name, value in one["parameters"].items()
    ]
    return [head, *rows]


def _ranking(found: Mapping[str, Any]) -> list[str]:
    shown = [r for r in found["ranking"] if (r["error_reduction"] or 0.0) > 0.0][:5]
    if not shown:
        return []
    rows = [
        f"  {r['effect']:<22}{_bar(r['error_reduction'])} {100 * r['error_reduction']:5.1f} %"
        for r in shown
    ]
    return ["", "each alone:", *rows]
