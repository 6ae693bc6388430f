"""rovsim: find the physics your underwater-vehicle simulator is missing.

import rovsim
campaign = rovsim.open("my_campaign")     # a notebook's way in: docs/notebooks.md

core         errors, files, rotations, progress
results      what is written as JSON
dynamics     the equation of motion: vehicle, effects, engine
measurement  campaigns, readers of raw exports, signals
simulation   models driven by commands, and the synthetic tank
learning     trained residuals
evaluation   how far model and measurement are apart
reporting    figures, tables, pages
estimation   values of given effects, and how likely each hypothesis is
intake       files that nobody has described yet
diagnosis    which physical effects a model lacks
design       the next flight
application  settings, the pipeline, tracking
benchmarks   how right and how fast
apps         command line, workbench, notebook, other programs
"""

from importlib import import_module
from typing import Any

from rovsim.core.axes import AXES as AXES  # for effects of one's own

__version__ = "0.2.0"

NOTEBOOK = ("open", "tank")


def __getattr__(name: str) -> Any:
    """What notebooks use; loaded when asked for, so that `import rovsim` costs nothing."""
    if name in NOTEBOOK:
        return getattr(import_module("rovsim.apps.notebook"), name)
    raise AttributeError(f"module 'rovsim' has no attribute '{name}'")
