"""Limits of a flight: a depth that is wanted never replaces floor, surface and clearance."""

from types import SimpleNamespace

import numpy as np
import pytest

from rovsim.core.errors import BadInput
from rovsim.core.run import Site
from rovsim.core.schema import checked
from rovsim.design.adequacy import warn_of_walls
from rovsim.design.envelope import Envelope
from rovsim.design.settings import FlightLimits

TANK = np.array([[0.0, 10.0], [-5.0, 0.0], [-3.0, 0.0]])  # NED: the surface at -3, the floor at 0
SWUM = np.array([[1.0, 3.0], [-4.0, -2.0], [np.nan, np.nan]])


def around(tank=TANK, floats=False, **limits) -> Envelope:
    """The envelope in a tank."""
    surroundings = SimpleNamespace(site=Site(tank, np.ones(3)), swum=SWUM)
    return Envelope.within(surroundings, FlightLimits(**limits), floats)


def test_a_depth_is_cut_by_what_the_tank_leaves():
    assert around().box[2] == pytest.approx([-2.6, -0.4])
    assert around(depth=(1.0, 2.0)).box[2] == pytest.approx([-2.0, -1.0])
    assert around(depth=(0.0, 9.0)).box[2] == pytest.approx([-2.6, -0.4])


@pytest.mark.parametrize("limits", [{"depth": (2.9, 9.0)}, {"clearance": 1.6}, {"clearance": 3.0}])
def test_no_room_is_said_once_and_clearly(limits):
    with pytest.raises(BadInput, match=r"(floor and surface|walls).* leave no room"):
        around(**limits)


@pytest.mark.parametrize("depth", [(2.0, 1.0), (-5.0, -1.0), (1.0, 1.0)])
def test_depths_lie_below_the_surface_the_lesser_first(depth):
    with pytest.raises(BadInput, match="depth"):
        checked(FlightLimits, {"depth": depth}, "command line")


def test_what_floats_is_at_the_surface():
    assert not np.isfinite(around(floats=True).box[2]).any()


def test_without_walls_a_flight_begins_where_the_runs_swam():
    found = around(np.full((3, 2), np.nan))
    assert found.middle == pytest.approx([2.0, -3.0, 0.0])
    paths = np.zeros((2, 5, 13))
    paths[:, :, :3] = found.middle
    paths[1, 3, 0] += 1.5
    (told,) = warn_of_walls(paths, found.middle, found)
    assert "1.5 m away" in told
    assert warn_of_walls(paths, found.middle, around()) == ()


def test_how_the_limits_are_left_is_told():
    found = around(speed=1.0, tilt=0.5)
    paths = np.zeros((2, 5, 13))
    paths[:, :, :3], paths[:, :, 3] = found.middle, 1.0
    assert found.excess(paths) == 0.0
    assert found.describe_excess(paths) == ""
    paths[:, 4, 2] -= 1.3  # from 1.5 m below the surface to 0.2 m: 0.2 m too near
    paths[:, 2, 7] = 1.2
    assert found.describe_excess(paths) == (
        "comes 0.2 m too near to a wall, the floor or the surface and moves 20 % more than it may"
    )
    assert found.excess(paths) == pytest.approx(0.4)
    paths[0, 0, 0] = np.inf
    assert found.excess(paths) == np.inf
    assert found.describe_excess(paths) == "moves beyond all numbers"
