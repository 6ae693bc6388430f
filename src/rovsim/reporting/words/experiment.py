"""Say what a designed flight promises, for the terminal and the workbench."""

from typing import Sequence

from rovsim.core.normal import Z_95
from rovsim.dynamics.parameter_labels import label_parameters
from rovsim.reporting.units import unit
from rovsim.reporting.wording import significant
from rovsim.results.base import or_nan
from rovsim.results.experiment import Experiment, RivalOdds, Surer, UsualManoeuvre

MAX_TOLD_ODDS = 1e6


def tell_experiment(experiment: Experiment, thrusters: Sequence[str] = ()) -> str:
    """Say what a flight is expected to tell, compared with usual manoeuvres, and its limits.

    Args:
        experiment: the designed flight.
        thrusters: names of the thrusters in the vehicle file.
    """
    lines = [
        "",
        f"A flight of {experiment.seconds:g} s ({experiment.manoeuvre}) is expected to give",
        "",
    ]
    lines += [_tell_odds(name, item) for name, item in experiment.expects.odds.items()]
    names = label_parameters(list(experiment.expects.std), thrusters)
    lines += map(_tell_std, names, experiment.expects.std.values())
    if experiment.expects.std:
        lines += ["", "± is the 95 % interval."]
    lines += ["", "of usual manoeuvres, on the same seconds and at their best amplitudes:", ""]
    lines += [f"  {name:<11}{tell_share(item)}" for name, item in experiment.baselines.items()]
    warnings = [line for item in experiment.warnings for line in ("", f"Warning: {item}")]
    return "\n".join([*lines, "", tell_limits(experiment), *warnings])


def tell_share(usual: UsualManoeuvre) -> str:
    """Say how much of the designed flight's information a usual manoeuvre gives."""
    if usual.designed_is_better is None:
        return "leaves the limits at any amplitude"
    return f"tells {significant(1.0 / usual.designed_is_better)} of it"


def _tell_odds(name: str, one: RivalOdds) -> str:
    return f"  {name}, if true: odds {size_of_odds(one.now)} now, {size_of_odds(one.then)} then"


def size_of_odds(odds: float) -> str:
    """Return odds as text; beyond a million to one without a number."""
    if odds > MAX_TOLD_ODDS:
        return "over a million"
    return significant(odds) if odds > 1.0 / MAX_TOLD_ODDS else "under one in a million"


def _tell_std(name: str, one: Surer) -> str:
    """Say how sure a parameter is now and after the flight: ± is its 95 % interval."""
    now, then = (
        f"± {significant(Z_95 * or_nan(x), 2)} {unit(one.unit)}".strip()
        for x in (one.now, one.then)
    )
    return f"  {name}: {then} (now {now})"


def tell_limits(experiment: Experiment) -> str:
    """Say how near the flight comes to walls, and its largest speed, turn rate and tilt."""
    limits = experiment.keeps
    wall = "" if limits.nearest_wall_m is None else f"{limits.nearest_wall_m:.2f} m from any wall, "
    return (
        f"It stays {wall}below {limits.speed_m_s:.2f} m/s, {limits.turn_rate_rad_s:.2f} rad/s and "
        f"{limits.tilt_rad:.2f} rad of tilt."
    )


def list_steps(instructions: Sequence[str]) -> list[tuple[str, list[str]]]:
    """Group instructions into steps, each with its parts.

    All lines after the first one that ends in a colon are parts of that step.
    """
    ends = next((k for k, line in enumerate(instructions) if line.endswith(":")), len(instructions))
    steps: list[tuple[str, list[str]]] = [(line, []) for line in instructions[: ends + 1]]
    if steps:
        steps[-1][1].extend(instructions[ends + 1 :])
    return steps
