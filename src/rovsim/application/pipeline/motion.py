"""Derive the motion of one run from its poses."""

from dataclasses import replace

import numpy as np

from rovsim.measurement.signals.chain import SignalSettings, Stage, differentiated
from rovsim.measurement.signals.motion import Motion
from rovsim.results.quality import Quality


def derive_motion(poses: Stage, quality: Quality, settings: SignalSettings) -> Motion:
    """Derive velocities and accelerations of filtered poses; no row of an unusable run counts."""
    motion = differentiated(poses, settings)
    if quality.unusable:
        return replace(motion, usable=np.zeros_like(motion.usable))
    return motion
