"""Make a campaign of raw exports from a case, with one of two simulators."""

from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Mapping

from rovsim.benchmarks.blind.case import Case
from rovsim.benchmarks.blind.independent.campaign import (
    SIMULATED_EFFECTS,
    OutOfTank,
    record_campaign,
)
from rovsim.core.errors import BadInput
from rovsim.dynamics.catalogue import built_in
from rovsim.simulation.synthetic_tank.campaign import make_campaign
from rovsim.simulation.synthetic_tank.description import TRUTH_FILE
from rovsim.simulation.synthetic_tank.true_run import LeftTank

MAX_TRIES = 12  # 0.8^12 = 0.07 of the size
PILOT_COUNT = 3


@dataclass(frozen=True)
class Simulator:
    """A simulator that can fly cases.

    Attributes:
        name: of the simulator.
        record: writes the campaign of a case to a folder; raises if the vehicle leaves the tank.
        states: whether it can fly a case.
        code: modules; when they change, answers have to be made again.
    """

    name: str
    record: Callable[[Case, Path], None]
    states: Callable[[Case], bool]
    code: tuple[str, ...]


def fly(case: Case, out: Path, simulator: str = "tank") -> Case:
    """Write the campaign of a case, without its truth.

    If the vehicle leaves the tank, it is flown again with effects of 0.8 times the size until the
    pilot can hold it, or else by another pilot (the next seed). So what is flown depends only on
    the declaration of the case.

    Args:
        case: to be flown.
        out: folder of the campaign.
        simulator: its name.

    Returns:
        The case as flown.

    Raises:
        BadInput: no pilot keeps the vehicle inside the tank.
    """
    record = SIMULATORS[simulator].record
    for pilot in range(PILOT_COUNT):
        flown = _weaken_until_held(case.model_copy(update={"seed": case.seed + pilot}), out, record)
        if flown is not None:
            return flown
    raise BadInput(
        f"the vehicle left the tank with each of {PILOT_COUNT} pilots",
        where=f"case {case.id}",
        expected="effects that a pilot can hold against",
        remedy="Correct the recipe.",
    )


def _weaken_until_held(case: Case, out: Path, record: Callable[[Case, Path], None]) -> Case | None:
    """Weaken a case until its pilot can hold the vehicle; None where that does not succeed."""
    for _ in range(MAX_TRIES):
        try:
            record(case, out)
            return case
        except (LeftTank, OutOfTank):
            case = case.weaker()
    return None


def _in_tank(case: Case, out: Path) -> None:
    unlisted = [physics.build() for physics in case.outside]
    make_campaign(case.settings(), out, built_in(), unlisted=unlisted)
    (out / TRUTH_FILE).unlink()


def _independently(case: Case, out: Path) -> None:
    record_campaign(case.settings().model_dump(), out)


def _is_stated(case: Case) -> bool:
    """Whether the second simulator has all hidden effects, and logs commands as the case needs."""
    stated = all(entry.effect in SIMULATED_EFFECTS for entry in case.hidden)
    return stated and not case.outside and case.settings().log.kind == "pwm"


SIMULATORS: Mapping[str, Simulator] = {
    "tank": Simulator(
        "tank",
        _in_tank,
        lambda case: True,
        ("rovsim.simulation.synthetic_tank", "rovsim.benchmarks.blind.outside"),
    ),
    "independent": Simulator(
        "independent",
        _independently,
        _is_stated,
        ("rovsim.benchmarks.blind.independent",),
    ),
}
