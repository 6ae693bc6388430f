"""Packages that only some commands need: `pip install rovsim[NAME]`."""

from importlib.util import find_spec

from rovsim.core.errors import BadInput

# The packages of each extra that rovsim imports (pyproject.toml holds what pip installs).
PACKAGES = {
    "learn": ("torch", "gpytorch", "sklearn"),
    "tracking": ("mlflow",),
    "workbench": ("nicegui",),
    "fmi": ("pythonfmu",),
    "benchmark": ("pykdtree", "pysindy", "threadpoolctl"),
}


def require(*extras: str, by: str) -> None:
    """Make sure that the packages of these extras are installed; `by` says what needs them.

    Raises:
        BadInput: one is missing; the message says what to install.
    """
    missing = {
        extra: packages
        for extra in extras
        if (packages := [name for name in PACKAGES[extra] if find_spec(name) is None])
    }
    if missing:
        raise BadInput(
            f"{', '.join(name for names in missing.values() for name in names)} not installed",
            where=by,
            expected=f"the extra packages of rovsim[{','.join(missing)}]",
            remedy=f"Install them: pip install 'rovsim[{','.join(missing)}]'.",
        )
