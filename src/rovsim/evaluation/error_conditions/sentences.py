"""Say a finding in plain language: axis, condition, direction, size, share, and usual causes."""

import numpy as np

from rovsim.core.axes import ACCELERATION_UNITS, AXES, FORCE_UNITS
from rovsim.core.signs import minus
from rovsim.evaluation.error_conditions.conditions import Condition
from rovsim.evaluation.error_conditions.findings import MIN_ERROR_SHARE, ErrorExplanation, Finding
from rovsim.results.error_conditions import THROUGHOUT

ERROR_UNITS = dict(zip(AXES, ACCELERATION_UNITS, strict=True))
PUSH_UNITS = dict(zip(AXES, FORCE_UNITS, strict=True))
POSITIVE_DIRECTIONS = {
    "surge": "forward",
    "sway": "to starboard",
    "heave": "downward",
    "roll": "to starboard",
    "pitch": "nose up",
    "yaw": "to starboard",
}
NEGATIVE_DIRECTIONS = {
    "surge": "backward",
    "sway": "to port",
    "heave": "upward",
    "roll": "to port",
    "pitch": "nose down",
    "yaw": "to port",
}
# If a condition is of the same axis as the error: what it means that the two have equal signs, and
# what it means that they have opposite ones.
RELATION_PHRASES = {
    "speed": ("brakes too much when moving fast", "brakes too little when moving fast"),
    "thrust": ("responds too weakly to its thrust", "responds too strongly to its thrust"),
    "change": (
        "responds too late to a change of thrust",
        "responds too early to a change of thrust",
    ),
    "attitude": ("rights itself too strongly", "rights itself too weakly"),
}
USUAL_CAUSES = {
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
# correlation of error and condition: beyond, the error grows or falls with it
MIN_LINEAR_CORRELATION = 0.6


def say_finding(finding: Finding) -> str:
    """Say a finding in sentences that need no others."""
    earlier = f", beyond {' and '.join(finding.after)}" if finding.after else ""
    return (
        f"{_capitalize(finding.axis)}{earlier}: {_say_dependence(finding)} "
        f"{_say_share(finding)} {_say_usual_cause(finding)}"
    )


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


def relation(finding: Finding) -> float:
    """Correlation of the bin means with the condition, weighted by blocks; NaN with one bin."""
    at = finding.table.binning
    x, y, w = at.center[at.judged], finding.table.mean[at.judged], at.count[at.judged]
    if len(x) < 2:
        return float("nan")
    x, y = x - np.average(x, weights=w), y - np.average(y, weights=w)
    spread = np.sqrt(np.sum(w * x * x) * np.sum(w * y * y))
    return float(np.sum(w * x * y) / spread) if spread > 0 else 0.0


def _say_dependence(finding: Finding) -> str:
    """Say how the error depends on the condition, and how large it gets."""
    condition, unit = finding.table.binning.condition, ERROR_UNITS[finding.axis]
    if condition.kind == THROUGHOUT:
        return _say_constant(finding, unit)
    wordings = RELATION_PHRASES.get(condition.kind) if condition.axis == finding.axis else None
    r = relation(finding)
    if wordings and condition.name != "heading" and abs(r) > MIN_LINEAR_CORRELATION:
        return f"the model {wordings[0] if r > 0 else wordings[1]}. {_say_extreme(finding, unit)}."
    return f"the error changes with {condition.name}: {_say_range(finding, unit)}."


def _say_constant(finding: Finding, unit: str) -> str:
    """Say by how much, and to which side, the vehicle constantly accelerates more."""
    mean = float(finding.table.mean[0])
    side = (POSITIVE_DIRECTIONS if mean > 0 else NEGATIVE_DIRECTIONS)[finding.axis]
    push = (
        f", as a push of {_format_push(finding)} would make it" if finding.push is not None else ""
    )
    return (
        f"throughout, the vehicle accelerates {amount(abs(mean))} {unit} more {side} "
        f"than the model{push}, whatever else varies."
    )


def _format_push(finding: Finding) -> str:
    """Write the force or moment that would cause the mean error, with its unit."""
    return f"{amount(abs(finding.push or 0.0))} {PUSH_UNITS[finding.axis]}"


def _say_extreme(finding: Finding, unit: str) -> str:
    """Say in which bin of the condition the mean error is largest."""
    b = int(np.argmax(np.where(finding.table.binning.judged, np.abs(finding.table.mean), -1.0)))
    mean, condition = abs(float(finding.table.mean[b])), finding.table.binning.condition
    return (
        f"The error is largest, {amount(mean)} {unit}, where {condition.name} is "
        f"{_format_span(finding, b)}"
    )


def _say_range(finding: Finding, unit: str) -> str:
    """Say the lowest and the highest mean error, and in which bins they are."""
    filled, mean = finding.table.binning.judged, finding.table.mean
    low = int(np.argmin(np.where(filled, mean, np.inf)))
    high = int(np.argmax(np.where(filled, mean, -np.inf)))
    return (
        f"{_signed(mean[low])} {unit} {_format_span(finding, low)}, "
        f"{_signed(mean[high])} {unit} {_format_span(finding, high)} (measured minus model)"
    )


def _signed(value: float) -> str:
    """Write a number with its sign, also if that is a plus."""
    return f"{'−' if value < 0 else '+'}{amount(abs(float(value)))}"


def _format_span(finding: Finding, b: int) -> str:
    """Say which values are in bin b; the outer bins are open."""
    edges, condition = finding.table.binning.edges, finding.table.binning.condition
    if condition.unit == "rad":
        return f"near {minus(f'{np.degrees(finding.table.binning.center[b]):.0f}')}°"
    low, high = (_plain(x) for x in edges[b : b + 2])
    if b == 0:
        return f"below {high} {condition.unit}"
    if b == len(edges) - 2:
        return f"above {low} {condition.unit}"
    return f"between {low} and {high} {condition.unit}"


def _plain(value: float) -> str:
    """Write a number, with a sign only if it is negative."""
    return minus(amount(float(value)))


def _say_share(finding: Finding) -> str:
    """Say which share of the error a condition explains, and which others would explain as much."""
    share, at = f"{100 * finding.share_of_error:.0f} %", finding.table.binning.condition
    if at.kind == THROUGHOUT:
        return f"{share} of the squared error is constant."
    text = f"{_capitalize(at.name)} explains {share} of the squared error."
    if finding.constant > MIN_ERROR_SHARE:
        push = f" (a push of {_format_push(finding)})" if finding.push is not None else ""
        text = f"{text[:-1]}, a constant alone {100 * finding.constant:.0f} %{push}."
    alternatives = [c.name for c in finding.alike[:2]]
    if not alternatives:
        return text
    names = " or ".join(alternatives)
    return f"{text} ({_capitalize(names)} would explain about as much: they varied together.)"


def _capitalize(words: str) -> str:
    """Begin with a capital letter; the rest stays as it is."""
    return words[0].upper() + words[1:]


def _say_usual_cause(finding: Finding) -> str:
    """Say what often causes such a finding."""
    return f"Often: {USUAL_CAUSES[_cause_key(finding.axis, finding.table.binning.condition)]}."


def _cause_key(axis: str, condition: Condition) -> str:
    """Key in `USUAL_CAUSES` of axis and condition; "coupled" for a condition of another axis."""
    if condition.name == "heading":
        return "heading"
    of_motion = condition.kind in ("speed", "thrust", "attitude")
    return "coupled" if of_motion and condition.axis not in ("", axis) else condition.kind
