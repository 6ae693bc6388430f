"""From a case to a campaign of raw exports."""

from pathlib import Path

from rovsim.benchmarks.blind.case import Case
from rovsim.core.errors import BadInput
from rovsim.dynamics.catalogue import built_in
from rovsim.simulation.synthetic_tank.campaign import make_campaign
from rovsim.simulation.synthetic_tank.description import SEALED
from rovsim.simulation.synthetic_tank.true_run import LeftTank

TRIES = 12  # 0.8^12 = 0.07 of the size
PILOTS = 3


def fly(case: Case, out: Path) -> Case:
    """Write the campaign of a case to the folder `out`, its truth left out; the case as flown.

    A vehicle that leaves the tank is flown again with effects of 0.8 times the size, until the
    pilot can hold it; where not even that helps, by another pilot (the next seed). So a case is a
    function of its declaration alone.

    Raises:
        BadInput: no pilot keeps it inside.
    """
    for pilot in range(PILOTS):
        flown = _held(case.model_copy(update={"seed": case.seed + pilot}), out)
        if flown is not None:
            (out / SEALED).unlink()
            return flown
    raise BadInput(
        f"the vehicle left the tank with each of {PILOTS} pilots",
        where=f"case {case.id}",
        expected="effects that a pilot can hold against",
        remedy="Correct the recipe.",
    )


def _held(case: Case, out: Path) -> Case | None:
    """The case with effects as strong as this pilot can hold; None if there are none."""
    for _ in range(TRIES):
        try:
            unlisted = [one.build() for one in case.outside]
            make_campaign(case.settings(), out, built_in(), unlisted=unlisted)
            return case
        except LeftTank:
            case = case.weaker()
    return None
