"""Where a result came from: recordings, code, settings, versions, machine.

No clock: equal inputs, equal files.
"""

import hashlib
import platform
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from os.path import relpath
from pathlib import Path
from typing import Any, Sequence

import rovsim
from rovsim.core.schema import Section
from rovsim.dynamics.catalogue import Catalogue
from rovsim.measurement.campaign import Campaign

SOURCE = Path(rovsim.__file__).parent
MODEL = "rovsim.dynamics.model"
OF_MODELS = ("rovsim.dynamics.effects", "rovsim.dynamics.engine")
LOOKED_INTO = ("rovsim.measurement.recording", "rovsim.learning")
UNRELATED = ("command", "tracking", "timing", "blind", "bench", "output", "port", "open")
PACKAGES = ("numpy", "scipy", "numba", "scikit-learn", "gpytorch", "torch", "pysindy")


def digest(*names: str, effects: Sequence[Path] = ()) -> str:
    """Digest of modules of rovsim and of all they import, however deep.

    A package stands for all its modules: what is found by looking has no import to follow. So do
    files of `effects` from elsewhere, for modules that know models.
    """
    wanted = find_modules(*names)
    return _digest([*map(_file, sorted(wanted)), *(effects if MODEL in wanted else ())])


def find_modules(*names: str) -> set[str]:
    """These modules of rovsim and all they import, however deep, as `digest` takes them."""
    graph = _graph()
    wanted: set[str] = set()
    for name in names:
        wanted |= {name, *graph.find_descendants(name)}
    for name in list(wanted):
        wanted |= graph.find_upstream_modules(name)
    for package in _discovered(wanted):
        wanted |= graph.find_descendants(package)
    return wanted


def own_digest(package: str, effects: Sequence[Path] = ()) -> str:
    """Digest of a package's own modules, whatever they import, and of files of `effects`."""
    return _digest([*sorted(_file(package).parent.rglob("*.py")), *effects])


def _digest(files: Sequence[Path]) -> str:
    content = hashlib.sha256()
    for path in files:
        content.update(path.read_bytes())
    return content.hexdigest()[:16]


def _discovered(modules: set[str]) -> set[str]:
    """Packages found by looking into their folder; a model may hold any effect, and is compiled."""
    found = {package for package in LOOKED_INTO if package in modules}
    return found | (set(OF_MODELS) if MODEL in modules else set())


@cache
def _graph():
    import grimp

    return grimp.build_graph("rovsim", cache_dir=None)


def _file(module: str) -> Path:
    path = SOURCE.joinpath(*module.split(".")[1:])
    return path / "__init__.py" if path.is_dir() else path.with_suffix(".py")


def _version(package: str) -> str | None:
    """None where it is not installed: a learner's library is an extra."""
    try:
        return version(package)
    except PackageNotFoundError:
        return None


def describe_origin(catalogue: Catalogue) -> dict[str, Any]:
    """Code, with the user's own effects, and versions behind a result."""
    packages = {name: installed for name in PACKAGES if (installed := _version(name))}
    system = f"{platform.system()} {platform.machine()}"
    versions = {
        "rovsim": rovsim.__version__, "python": platform.python_version(), "system": system,
        **packages,
    }  # fmt: skip
    return {"code": own_digest("rovsim", catalogue.files), "versions": versions}


def provenance(
    settings: Section, catalogue: Catalogue, campaign: Campaign | None
) -> dict[str, Any]:
    """Recordings, settings, code and versions behind a result.

    Settings without influence are left out; so are recordings that these make (None).
    """
    chosen = settings.model_dump(mode="json", exclude=set(UNRELATED))
    files = {} if campaign is None else {"recordings": digest_files(campaign)}
    return {"settings": chosen, **describe_origin(catalogue), **files}


def digest_files(campaign: Campaign) -> dict[str, str]:
    """The first 16 digits of the SHA-256 of every file of a campaign, by its path from there."""
    files = (path for path in campaign.files if path.is_file())
    return {relpath(path, campaign.folder): _sha256(path)[:16] for path in files}


def _sha256(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
