"""Compiled engines survive between test sessions of one checkout."""

import os
from pathlib import Path

os.environ.setdefault("ROVSIM_CACHE", str(Path(__file__).parents[1] / ".pytest_cache" / "rovsim"))
