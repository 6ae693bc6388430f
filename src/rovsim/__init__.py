"""rovsim: find the physics your underwater-vehicle simulator is missing."""

__version__ = "0.1.0"

AXES = ("surge", "sway", "heave", "roll", "pitch", "yaw")
