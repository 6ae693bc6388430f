"""Compile the engines that a diagnosis needs later, in another process while it begins."""

import numpy as np

from rovsim.core.run import Site
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.compilation.cache import cache_folder
from rovsim.dynamics.model import Model, nominal
from rovsim.dynamics.vehicle.load import load_vehicle
from rovsim.simulation.batch import Batch, Starts
from rovsim.simulation.correction import Correction
from rovsim.simulation.drive import Drive
from rovsim.simulation.rest import rest_state

MARKER_FILE = "compiled_ahead"  # in the folder of what is kept, once it was done
EXAMPLE_VEHICLE = "bluerov2"  # types are those of any


def is_compiled() -> bool:
    """Whether `compile_ahead` was done before."""
    return (cache_folder() / MARKER_FILE).exists()


def compile_ahead() -> None:
    """Compile the engines in the order in which a diagnosis needs them, by calls of one step."""
    model = nominal(load_vehicle(EXAMPLE_VEHICLE))
    with_effects = Batch([model], Site.unknown(), candidates=built_in().wrenches, learned=False)
    with_effects.innovations([_drive(model)], _starts(), _correction())
    for batch in (with_effects, Batch([model], Site.unknown(), learned=False)):
        batch.trajectories([_drive(model)], _starts(), np.array([0.0, 0.01]))
    (cache_folder() / MARKER_FILE).touch()


def _starts() -> Starts:
    """One start at rest, for one step or reading."""
    state = rest_state(np.zeros(3), np.zeros((1, 1)))
    return Starts(state, np.zeros(1, np.int64), np.ones(1, np.int64))


def _drive(model: Model) -> Drive:
    """A drive of one step in which all thrusters stand still."""
    thrusters = model.body.B.shape[1]
    return Drive(np.zeros((1, 6)), np.zeros((1, thrusters)), np.full((1, 6), np.nan), 1.0)


def _correction() -> Correction:
    """A correction by two equal readings, 0.01 s apart."""
    readings = np.zeros((1, 2, 13))
    readings[..., 3] = 1.0
    return Correction(
        readings,
        np.zeros(1, np.int64),
        np.ones((2, 6)),
        np.ones(5),
        np.array([0.0, 0.01]),
        np.array([0, 1]),
        np.zeros((3, 6)),
        np.ones((1, 6)),
        False,
    )
