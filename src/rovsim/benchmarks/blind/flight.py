"""From a case to a campaign of raw exports, by one of two simulators."""

from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Mapping

from rovsim.benchmarks.blind.case import Case
from rovsim.benchmarks.blind.independent.campaign import STATED, OutOfTank, record_campaign
from rovsim.core.errors import BadInput
from rovsim.dynamics.catalogue import built_in
from rovsim.simulation.synthetic_tank.campaign import make_campaign
from rovsim.simulation.synthetic_tank.description import SEALED
from rovsim.simulation.synthetic_tank.true_run import LeftTank

TRIES = 12  # 0.8^12 = 0.07 of the size
PILOTS = 3


@dataclass(frozen=True)
class Simulator:
    """Who flies a case.

    `record(case, folder)` writes the campaign or says that the vehicle left the tank; `states` what
    it can fly; `code` modules whose change makes old answers void.
    """

    name: str
    record: Callable[[Case, Path], None]
    states: Callable[[Case], bool]
    code: tuple[str, ...]


def fly(case: Case, out: Path, simulator: str = "tank") -> Case:
    """Write the campaign of a case to the folder `out`, its truth left out; the case as flown.

    A vehicle that leaves the tank is flown again with effects of 0.8 times the size, until the
    pilot can hold it; where not even that helps, by another pilot (the next seed). So a case is a
    function of its declaration alone.

    Raises:
        BadInput: no pilot keeps it inside.
    """
    record = SIMULATORS[simulator].record
    for pilot in range(PILOTS):
        flown = _held(case.model_copy(update={"seed": case.seed + pilot}), out, record)
        if flown is not None:
            return flown
    raise BadInput(
        f"the vehicle left the tank with each of {PILOTS} pilots",
        where=f"case {case.id}",
        expected="effects that a pilot can hold against",
        remedy="Correct the recipe.",
    )


def _held(case: Case, out: Path, record: Callable[[Case, Path], None]) -> Case | None:
    """The case with effects as strong as this pilot can hold; None if there are none."""
    for _ in range(TRIES):
        try:
            record(case, out)
            return case
        except (LeftTank, OutOfTank):
            case = case.weaker()
    return None


def _in_tank(case: Case, out: Path) -> None:
    unlisted = [physics.build() for physics in case.outside]
    make_campaign(case.settings(), out, built_in(), unlisted=unlisted)
    (out / SEALED).unlink()


def _independently(case: Case, out: Path) -> None:
    record_campaign(case.settings().model_dump(), out)


def _is_stated(case: Case) -> bool:
    """Whether the second simulator knows all that is hidden, and how it is logged."""
    stated = all(entry.effect in STATED for entry in case.hidden)
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
