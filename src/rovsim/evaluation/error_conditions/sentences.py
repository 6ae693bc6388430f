"""Say a finding in plain language: axis, condition, direction, size, share, and usual causes."""

import numpy as np

from rovsim.core.axes import ACCELERATION_UNITS, AXES, FORCE_UNITS
from rovsim.core.signs import minus
from rovsim.evaluation.error_conditions.conditions import Condition
from rovsim.evaluation.error_conditions.findings import SMALLEST, ErrorExplanation, Finding
from rovsim.results.error_conditions import THROUGHOUT

UNITS = dict(zip(AXES, ACCELERATION_UNITS, strict=True))  # of an error, by axis
PUSH_UNITS = dict(zip(AXES, FORCE_UNITS, strict=True))
POSITIVE = {
    "surge": "forward",
    "sway": "to starboard",
    "heave": "downward",
    "roll": "to starboard",
    "pitch": "nose up",
    "yaw": "to starboard",
}
NEGATIVE = {
    "surge": "backward",
    "sway": "to port",
    "heave": "upward",
    "roll": "to port",
    "pitch": "nose down",
    "yaw": "to port",
}
# If a condition is of the same axis as the error: what it means that the two have equal signs, and
# what it means that they have opposite ones.
RELATIONS = {
    "speed": ("brakes too much when moving fast", "brakes too little when moving fast"),
    "thrust": ("responds too weakly to its thrust", "responds too strongly to its thrust"),
    "change": (
        "responds too late to a change of thrust",
        "responds too early to a change of thrust",
    ),
    "attitude": ("rights itself too strongly", "rights itself too weakly"),
}
USUAL = {
    "speed": "damping, or an added mass that is off",
    "absolute": "lift or coupled damping",
    "thrust": "thruster gain, or an added mass that is off",
    "change": "thruster lag, a delay or clock offset of the commands",
    "attitude": "the centre of buoyancy, or a trim moment",
    "place": "tether, walls, surface, or a world frame that is not level",
    "time": "a battery that empties, or drifting clocks",
    THROUGHOUT: "net buoyancy, trim, a constant push",
    "heading": "a current, a tether, or a world frame that is not level",
    "coupled": "a coupling (allocation, lift, off-diagonal damping or mass), or an autopilot "
    "that the log does not show",
}
STRAIGHT = 0.6  # correlation of error and condition: beyond, the error grows or falls with it


def say_finding(found: Finding) -> str:
    """Say a finding in sentences that need no others."""
    earlier = f", beyond {' and '.join(found.after)}" if found.after else ""
    return f"{_begin(found.axis)}{earlier}: {_what(found)} {_share(found)} {_usual(found)}"


def say_findings(explanation: ErrorExplanation) -> list[str]:
    """Say all findings, or why there are none, in sentences."""
    if not explanation.enough:
        return ["Too little was recorded to tell under which condition the model fails."]
    if not explanation.findings:
        return [
            "No condition explains the error. Over speed, thrust, attitude, place and time, the "
            "mean error is no larger than chance would make it."
        ]
    return [say_finding(finding) for finding in explanation.findings]


def amount(value: float) -> str:
    """Write a number with two significant digits, and without an exponent."""
    return f"{value:.0f}" if abs(value) >= 10 else f"{value:#.2g}".rstrip(".")


def relation(found: Finding) -> float:
    """Correlation of the bin means with the condition, weighted by blocks; NaN with one bin."""
    at = found.table.binning
    x, y, w = at.center[at.judged], found.table.mean[at.judged], at.count[at.judged]
    if len(x) < 2:
        return float("nan")
    x, y = x - np.average(x, weights=w), y - np.average(y, weights=w)
    spread = np.sqrt(np.sum(w * x * x) * np.sum(w * y * y))
    return float(np.sum(w * x * y) / spread) if spread > 0 else 0.0


def _what(found: Finding) -> str:
    """Say how the error depends on the condition, and how large it gets."""
    condition, unit = found.table.binning.condition, UNITS[found.axis]
    if condition.kind == THROUGHOUT:
        return _constant(found, unit)
    wordings = RELATIONS.get(condition.kind) if condition.axis == found.axis else None
    r = relation(found)
    if wordings and condition.name != "heading" and abs(r) > STRAIGHT:
        return f"the model {wordings[0] if r > 0 else wordings[1]}. {_extreme(found, unit)}."
    return f"the error changes with {condition.name}: {_range(found, unit)}."


def _constant(found: Finding, unit: str) -> str:
    """Say by how much, and to which side, the vehicle constantly accelerates more."""
    mean = float(found.table.mean[0])
    side = (POSITIVE if mean > 0 else NEGATIVE)[found.axis]
    push = f", as a push of {_push(found)} would make it" if found.push is not None else ""
    return (
        f"throughout, the vehicle accelerates {amount(abs(mean))} {unit} more {side} "
        f"than the model{push}, whatever else varies."
    )


def _push(found: Finding) -> str:
    """Write the force or moment that would cause the mean error, with its unit."""
    return f"{amount(abs(found.push or 0.0))} {PUSH_UNITS[found.axis]}"


def _extreme(found: Finding, unit: str) -> str:
    """Say in which bin of the condition the mean error is largest."""
    b = int(np.argmax(np.where(found.table.binning.judged, np.abs(found.table.mean), -1.0)))
    mean, condition = abs(float(found.table.mean[b])), found.table.binning.condition
    return (
        f"The error is largest, {amount(mean)} {unit}, where {condition.name} is {_span(found, b)}"
    )


def _range(found: Finding, unit: str) -> str:
    """Say the lowest and the highest mean error, and in which bins they are."""
    filled, mean = found.table.binning.judged, found.table.mean
    low = int(np.argmin(np.where(filled, mean, np.inf)))
    high = int(np.argmax(np.where(filled, mean, -np.inf)))
    return (
        f"{_signed(mean[low])} {unit} {_span(found, low)}, "
        f"{_signed(mean[high])} {unit} {_span(found, high)} (measured minus model)"
    )


def _signed(value: float) -> str:
    """Write a number with its sign, also if that is a plus."""
    return f"{'−' if value < 0 else '+'}{amount(abs(float(value)))}"


def _span(found: Finding, b: int) -> str:
    """Say which values are in bin b; the outer bins are open."""
    edges, condition = found.table.binning.edges, found.table.binning.condition
    if condition.unit == "rad":
        return f"near {minus(f'{np.degrees(found.table.binning.center[b]):.0f}')}°"
    low, high = (_plain(x) for x in edges[b : b + 2])
    if b == 0:
        return f"below {high} {condition.unit}"
    if b == len(edges) - 2:
        return f"above {low} {condition.unit}"
    return f"between {low} and {high} {condition.unit}"


def _plain(value: float) -> str:
    """Write a number, with a sign only if it is negative."""
    return minus(amount(float(value)))


def _share(found: Finding) -> str:
    """Say which share of the error a condition explains, and which others would explain as much."""
    share, at = f"{100 * found.share_of_error:.0f} %", found.table.binning.condition
    if at.kind == THROUGHOUT:
        return f"{share} of the squared error is constant."
    text = f"{_begin(at.name)} explains {share} of the squared error."
    if found.constant > SMALLEST:
        push = f" (a push of {_push(found)})" if found.push is not None else ""
        text = f"{text[:-1]}, a constant alone {100 * found.constant:.0f} %{push}."
    alternatives = [c.name for c in found.alike[:2]]
    if not alternatives:
        return text
    names = " or ".join(alternatives)
    return f"{text} ({_begin(names)} would explain about as much: they varied together.)"


def _begin(words: str) -> str:
    """Begin with a capital letter; the rest stays as it is."""
    return words[0].upper() + words[1:]


def _usual(found: Finding) -> str:
    """Say what often causes such a finding."""
    return f"Often: {USUAL[_cause(found.axis, found.table.binning.condition)]}."


def _cause(axis: str, condition: Condition) -> str:
    """Key in `USUAL` of an axis and a condition; "coupled" if the condition is of another axis."""
    if condition.name == "heading":
        return "heading"
    of_motion = condition.kind in ("speed", "thrust", "attitude")
    return "coupled" if of_motion and condition.axis not in ("", axis) else condition.kind
