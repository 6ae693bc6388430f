"""Packages that only some commands need: `pip install rovsim[NAME]`."""

from importlib.util import find_spec

from rovsim.core.errors import BadInput

# Packages by which each extra is recognised (pyproject.toml lists what pip installs).
EXTRA_PACKAGES = {
    "learn": ("torch", "gpytorch", "sklearn"),
    "tracking": ("mlflow",),
    "workbench": ("nicegui",),
    "recordings": ("rosbags", "pymavlink"),
    "workflow": ("snakemake", "submitit"),
    "gym": ("gymnasium",),
    "fmi": ("pythonfmu",),
    "benchmark": ("pykdtree", "pysindy"),
}


def installed(extra: str) -> bool:
    """Whether all packages of an extra are installed."""
    return all(find_spec(name) is not None for name in EXTRA_PACKAGES[extra])


def require(*extras: str, by: str) -> None:
    """Make sure that these extras are installed; `by` says what needs them.

    Raises:
        BadInput: one is missing; the message says what to install.
    """
    missing = ",".join(extra for extra in extras if not installed(extra))
    if missing:
        raise BadInput(
            f"the packages of the extra {missing} are not installed",
            where=by,
            expected=f"rovsim[{missing}]",
            remedy=f"Install it: pip install 'rovsim[{missing}]'.",
        )
