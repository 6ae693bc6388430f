"""Small builders shared by tests: models, motions and starts."""

import os
from pathlib import Path

import numpy as np
import pytest

from rovsim.core.run import Commands, RunInfo, Site
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effects.base import Autopilot, Effect, Wrench
from rovsim.dynamics.model import Model, nominal
from rovsim.dynamics.user_effects.effects_file import read_effects
from rovsim.dynamics.vehicle import load_vehicle
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.synthetic_tank.settings import SUITABLE_TANKS

SHARED = Path(os.environ.get("ROVSIM_DATA", Path(__file__).parents[2] / "shared" / "data")).parent


def needed(path: Path) -> Path:
    """A file or folder of the recordings; the test is skipped where it is absent."""
    if not path.exists():
        pytest.skip(f"{path.name} is not here; set ROVSIM_DATA to the folder of the recordings")
    return path


def model(*effects: Effect) -> Model:
    """The nominal BlueROV2 with some effects added."""
    found = nominal(load_vehicle("bluerov2_heavy"))
    for effect in effects:
        found = found + effect
    return found


def beside_others(effect: Effect | None, cls: type[Effect] | None = None) -> Model:
    """A vehicle that can show an effect, with it, and every other wrench effect at its defaults.

    They change nothing, and one engine serves all such models; loops need a log of their own.
    """
    suits = SUITABLE_TANKS.get((cls or type(effect)).requires, {})
    if "vehicle" in suits:
        found = nominal(load_vehicle(suits["vehicle"]))
        return found if effect is None else found + effect
    if effect is None:
        return model()
    known = built_in().values()
    shared = [c for c in known if issubclass(c, Wrench) and not issubclass(c, Autopilot)]
    if type(effect) not in shared:
        return model(effect)
    return model(*(effect if type(effect) is cls else cls() for cls in shared))


def some(cls: type[Effect]) -> Effect:
    """An effect whose values differ from the defaults, inside every range."""
    known = [p for p in cls.parameters if np.isfinite(p.default) and p.fitted]
    more = {p.name: p.default + 0.1 for p in known if p.default + 0.1 <= p.high}
    return cls(**cls.starts[0] | more)


def motion(
    value: np.ndarray,
    kind: str = "thruster",
    seconds: float = 2.0,
    start: np.ndarray | None = None,
    site: Site | None = None,
) -> Motion:
    """A run whose commands (m, c) are spread evenly over its length; measured as standing still."""
    time = np.round(np.arange(0.0, seconds + 1e-9, 0.01), 6)
    state = at_rest() if start is None else start
    rows = np.repeat(state[None], len(time), axis=0)
    commands = Commands(np.linspace(0, seconds, len(value), endpoint=False), value, kind)
    return Motion(
        RunInfo("r", "6dof", "test"),
        site or Site.unknown(),
        time,
        rows[:, :7],
        rows[:, 7:],
        0 * rows[:, 7:],
        rows[:, 7:],
        np.ones(len(time), bool),
        commands,
        False,
        float(time[-1]),
    )


def tank() -> Site:
    """A tank of 4 x 3 x 2 m about the origin, seen by a motion capture with z up."""
    return Site(np.array([[-2.0, 2.0], [-1.5, 1.5], [-1.0, 1.0]]), np.array([1.0, -1.0, -1.0]))


def at_rest() -> np.ndarray:
    """State (13,): level, still, at the origin."""
    state = np.zeros(13)
    state[3] = 1.0
    return state


def sticks(seed: int = 0, rows: int = 20) -> np.ndarray:
    """Thruster commands (rows, 8), within what a pilot uses."""
    return np.random.default_rng(seed).uniform(-0.5, 0.5, (rows, 8))


def write_and_read(form, law, folder):
    """The file of a law that is proposed as a class, and that with the law's values."""
    numbers = form.list_numbers(law, dict.fromkeys(law.free, 0.1))
    path = folder / "proposed_effect.py"
    path.write_text(form.write("proposed_effect", law, numbers, "A test."), "utf-8")
    cls = read_effects(path, built_in())["proposed_effect"]
    return cls, cls(**{n.name: n.value for n in numbers})
