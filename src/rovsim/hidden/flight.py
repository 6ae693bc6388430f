"""From a case to a campaign of raw exports."""

from pathlib import Path

from rovsim.errors import BadInput
from rovsim.hidden.case import Case
from rovsim.tank.campaign import SEALED, make_campaign
from rovsim.tank.simulate import LeftTank

TRIES = 12  # 0.8^12 = 0.07 of the size


def fly(case: Case, out: Path) -> Case:
    """Write the campaign of a case to the folder `out`, its truth left out; the case as flown.

    A vehicle that leaves the tank is flown again with effects of 0.8 times the size, until the
    pilot can hold it. So a case is a function of its declaration alone.

    Raises:
        BadInput: not even weak effects keep it inside.
    """
    for _ in range(TRIES):
        try:
            unlisted = [one.build() for one in case.outside]
            make_campaign(case.settings(), out, unlisted=unlisted)
        except LeftTank:
            case = case.weaker()
            continue
        (out / SEALED).unlink()
        return case
    raise BadInput(
        f"the vehicle left the tank {TRIES} times",
        where=f"case {case.id}",
        expected="effects that the pilot can hold against",
        remedy="Correct the recipe.",
    )
