"""Controls of a screen, what is chosen with them, and the address that says it."""

import asyncio

import pytest
from starlette.datastructures import QueryParams

from rovsim.apps.workbench.choices import Choices
from rovsim.apps.workbench.place import Place

FIRST = {"run": "a", "axes": ["surge"], "seconds": 60}
POSSIBLE = {"run": ["a", "b"], "axes": ["surge", "sway"], "seconds": range(10, 601)}


class Control:
    """A control on no page."""

    value = None

    def classes(self, names):
        """Itself, as NiceGUI's."""
        return self

    props = classes

    def on_value_change(self, changed):
        """Keep what is to follow."""
        self.changed = changed

    def set(self, value):
        """Choose, as a user does."""
        self.value = value
        asyncio.run(self.changed())


class Screen:
    """Choices of a screen, how often it was drawn, and the last address."""

    def __init__(self, monkeypatch, asked="", zooms=True):
        self.addresses = []
        monkeypatch.setattr("nicegui.ui.navigate.history.replace", self.addresses.append)
        self.place = Place("models", QueryParams(asked))
        self.drawn = 0
        self.chosen = Choices(self.place, FIRST, POSSIBLE, self.draw, zooms)

    async def draw(self):
        """Count."""
        self.drawn += 1


def test_a_control_shows_what_the_address_asks_for_and_changes_it(monkeypatch):
    screen = Screen(monkeypatch, "run=b&seconds=20")
    run = screen.chosen.bind("run", Control())
    assert run.value == "b"
    run.set("a")
    seconds = screen.chosen.bind("seconds", Control(), convert=int)
    seconds.set(30.0)
    assert (screen.chosen["run"], screen.chosen["seconds"], screen.drawn) == ("a", 30, 2)
    assert screen.place.kept["models"]["run"] == "a"  # this tab comes back to it
    screen.chosen.tell()
    assert screen.addresses == ["/models?run=a&axes=surge&seconds=30"]


@pytest.mark.parametrize(("optional", "left"), [(False, ["surge"]), (True, [])])
def test_only_what_is_optional_may_be_empty(monkeypatch, optional, left):
    screen = Screen(monkeypatch)
    screen.chosen.bind("axes", Control(), optional).set([])
    assert (screen.chosen["axes"], screen.drawn) == (left, int(optional))


def test_another_run_is_shown_whole(monkeypatch):
    screen = Screen(monkeypatch, "from=1&to=2")
    assert screen.chosen.span == (1.0, 2.0)
    screen.chosen.zoom((3.0, 4.0))
    assert screen.addresses == ["/models?run=a&axes=surge&seconds=60&from=3.0&to=4.0"]
    screen.chosen.bind("axes", Control()).set(["sway"])
    assert screen.chosen.span == (3.0, 4.0)
    screen.chosen.bind("run", Control()).set("b")
    assert screen.chosen.span == (None, None)


def test_what_can_be_chosen_only_later_is_asked_of_the_same_address(monkeypatch):
    screen = Screen(monkeypatch, "know=lift&know=none&from=1", zooms=False)
    screen.chosen.add({"know": []}, {"know": ["lift", "drag"]})
    screen.chosen.put("run", "b")
    assert screen.addresses == ["/models?run=b&axes=surge&seconds=60&know=lift"]
