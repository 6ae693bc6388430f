"""The catalogue page says what the effects declare, and shows each of them."""

from pathlib import Path

import pytest

from rovsim.core.axes import AXES
from rovsim.core.errors import BadInput
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.model import nominal
from rovsim.dynamics.vehicle import load_vehicle
from rovsim.evaluation.error_conditions.conditions import average_blocks
from rovsim.reporting.catalogue.entries import PAGE, PICTURES, entry, page
from rovsim.reporting.catalogue.flight import find_condition, fly, seen, settings
from rovsim.reporting.figures.signature import draw_signature, write
from rovsim.simulation.samples import sample_run
from rovsim.simulation.settings import SimulationSettings

DOCS = Path(__file__).parents[2] / "docs"
EVERY = pytest.mark.parametrize("cls", built_in().values(), ids=list(built_in()))
LARGEST = 25_000  # bytes: thirty of them on one page


def short(cls):
    return settings(cls, cls.signature).model_copy(update={"duration": 12.0})


@pytest.fixture(scope="module")
def conditions():
    motion = fly(short(built_in()["thruster_gain"]), built_in())
    model = nominal(load_vehicle("bluerov2_heavy"))
    return average_blocks(motion, sample_run(model, motion, SimulationSettings()))


@EVERY
def test_it_declares_a_signature_that_can_be_drawn(cls, conditions):
    assert cls.signature.axis in AXES
    assert cls(**cls.signature.values).given()
    find_condition(cls.signature.condition, conditions)


@EVERY
def test_its_picture_is_there_and_small(cls):
    picture = DOCS / PICTURES / f"{cls.id}.png"
    assert 3000 < picture.stat().st_size < LARGEST
    assert f"({PICTURES}/{cls.id}.png)" in entry(cls)


def test_no_picture_is_left_over():
    assert {p.stem for p in (DOCS / PICTURES).iterdir()} == set(built_in())


def test_the_page_is_what_the_effects_declare():
    """After a change of a declaration: `make catalogue`."""
    assert (DOCS / PAGE).read_text(encoding="utf-8") == page(built_in())


def test_the_page_does_not_depend_on_the_order_of_imports():
    assert page(dict(reversed(list(built_in().items())))) == page(built_in())


def test_a_condition_that_does_not_exist_is_refused(conditions):
    with pytest.raises(BadInput, match="Did you mean 'surge thrust'"):
        find_condition("surge trust", conditions)


def test_a_picture_is_the_same_every_time(tmp_path):
    cls = built_in()["thruster_gain"]
    for name in ("one", "two"):
        write(draw_signature(seen(cls.signature, short(cls), built_in())), tmp_path / name)
    assert (tmp_path / "one").read_bytes() == (tmp_path / "two").read_bytes()


def test_black_and_orange_agree():
    """The effect is what the nominal model misses, apart from what the water does by itself."""
    cls = built_in()["thruster_gain"]
    look = seen(cls.signature, short(cls), built_in())
    assert abs(look.error - look.added).max() < 0.15 * abs(look.error).max()
