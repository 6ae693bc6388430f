"""Describe where a result came from: recordings, code, settings, versions, machine.

No time is recorded, so that equal inputs give equal files.
"""

import ast
import hashlib
import platform
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from os.path import relpath
from pathlib import Path
from typing import Any, Collection, Iterable, Mapping, Sequence

import rovsim
from rovsim.core.files import sha256_of
from rovsim.core.schema import Section
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.vehicle import vehicle_file
from rovsim.measurement.campaign import Campaign

SOURCE = Path(rovsim.__file__).parent
MODEL_MODULE, VEHICLE_MODULE = "rovsim.dynamics.model", "rovsim.dynamics.vehicle.load"
EFFECTS_PACKAGE = "rovsim.dynamics.effects"
# Packages that a module depends on without importing them: it looks into their folders. A model may
# hold any effect, and compiles its engine.
DISCOVERED_PACKAGES = {
    MODEL_MODULE: (EFFECTS_PACKAGE, "rovsim.dynamics.engine"),
    "rovsim.dynamics.catalogue": (EFFECTS_PACKAGE,),
    "rovsim.measurement.recording": ("rovsim.measurement.recording",),
    "rovsim.learning.learners": ("rovsim.learning.learners",),
}
UNRELATED_SECTIONS = (
    "command",
    "tracking",
    "timing",
    "blind",
    "bench",
    "out",
    "output",
    "port",
    "open",
)
RECORDED_PACKAGES = ("numpy", "scipy", "numba", "scikit-learn", "gpytorch", "torch", "pysindy")


def digest(
    *names: str,
    without: str = "",
    aside: Collection[str] = (),
    described: Sequence[Path] = (),
) -> str:
    """Digest modules of rovsim and all that they import, directly or indirectly.

    Args:
        names: of modules. A package stands for all its modules, since plug-ins that are found by
            looking into a folder have no import to follow.
        without: a package that is left out.
        aside: modules that are left out, with all that nothing else imports.
        described: files that describe a vehicle or a user's effects; included where one of the
            modules depends on models or vehicles.

    Returns:
        The first 16 hexadecimal digits of a SHA-256.
    """
    modules = find_modules(*names, aside=aside)
    if without:
        modules = {name for name in modules if not f"{name}.".startswith(f"{without}.")}
    files = (file for name in sorted(modules) for file in _files(name))
    return _digest(files, described if modules & {MODEL_MODULE, VEHICLE_MODULE} else ())


def imports_of(script: Path) -> list[str]:
    """List the modules of rovsim that a script imports."""
    tree = ast.parse(script.read_text(encoding="utf-8"))
    modules = [node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
    return sorted({name for name in modules if name and name.startswith("rovsim")})


def find_modules(*names: str, aside: Collection[str] = ()) -> set[str]:
    """Find modules of rovsim and all that they import, directly or indirectly.

    Args:
        names: of modules; a package stands for all its modules.
        aside: modules that are left out, with all that nothing else imports.
    """
    graph = _graph(frozenset(aside))

    def expand(packages: Iterable[str]) -> set[str]:
        members = {
            name for package in packages for name in (package, *graph.find_descendants(package))
        }
        return members.union(*(graph.find_upstream_modules(name) for name in members))

    modules = expand(name for name in names if name not in aside)
    return modules.union(
        *(expand(DISCOVERED_PACKAGES[name]) for name in DISCOVERED_PACKAGES.keys() & modules)
    )


def own_digest(package: str, described: Sequence[Path] = ()) -> str:
    """Digest a package's own modules without their imports, and the files of `described`."""
    return _digest(sorted(_file(package).parent.rglob("*.py")), described)


def _digest(modules: Iterable[Path], described: Iterable[Path]) -> str:
    content = hashlib.sha256()
    for path in modules:
        content.update(path.read_bytes())
    for path in described:
        text = path.read_bytes()
        content.update(_without_comments(text) if path.suffix == ".py" else text)
    return content.hexdigest()[:16]


def _without_comments(source: bytes) -> bytes:
    """Reduce the source of a user's effect to its syntax tree: comments change no result."""
    try:
        return ast.dump(ast.parse(source)).encode()
    except (SyntaxError, ValueError):
        return source  # raises where the effect is loaded


@cache
def _graph(aside: frozenset[str]):
    import grimp

    graph = grimp.build_graph("rovsim", cache_dir=None)
    for name in aside:
        graph.remove_module(name)
    return graph


def _file(module: str) -> Path:
    path = SOURCE.joinpath(*module.split(".")[1:])
    return path / "__init__.py" if path.is_dir() else path.with_suffix(".py")


def _files(module: str) -> list[Path]:
    """Return the file of a module, and those that bear its name: the templates it fills in."""
    path = _file(module)
    return sorted(path.parent.glob(f"{path.stem}.*"))


def _version(package: str) -> str | None:
    """Return a package's version; None where it is not installed, as learners are extras."""
    try:
        return version(package)
    except PackageNotFoundError:
        return None


def describe_origin(catalogue: Catalogue) -> dict[str, Any]:
    """Describe the code, with the user's own effects, and the versions behind a result."""
    packages = {name: installed for name in RECORDED_PACKAGES if (installed := _version(name))}
    system = f"{platform.system()} {platform.machine()}"
    versions = {
        "rovsim": rovsim.__version__,
        "python": platform.python_version(),
        "system": system,
        **packages,
    }
    return {"code": own_digest("rovsim", catalogue.files), "versions": versions}


def provenance(
    settings: Section,
    catalogue: Catalogue,
    campaign: Campaign | None,
    recordings: Mapping[str, str] | None = None,
) -> dict[str, Any]:
    """Describe recordings, vehicle file, settings, code and versions behind a result.

    Args:
        settings: of the command; those that do not influence a result are left out.
        catalogue: all effects, with those of the user's own files.
        campaign: that was used; None where the settings create it (a synthetic one).
        recordings: digests of its files that are known (`digest_recordings`).
    """
    return add_origin(describe_given(settings, campaign, recordings), catalogue)


def describe_given(
    settings: Section, campaign: Campaign | None, recordings: Mapping[str, str] | None = None
) -> dict[str, Any]:
    """Describe settings, recordings and vehicle file as `provenance` does, without the code."""
    given: dict[str, Any] = {
        "settings": settings.model_dump(mode="json", exclude=set(UNRELATED_SECTIONS))
    }
    if campaign is None:
        return given
    vehicle = vehicle_file(campaign.vehicle, named_in=campaign.file)
    recorded = digest_files(campaign, recordings)
    return given | {"recordings": recorded, "vehicle": sha256_of(vehicle)[:16]}


def add_origin(given: Mapping[str, Any], catalogue: Catalogue) -> dict[str, Any]:
    """Add the code and the versions that run now to what `describe_given` returned."""
    return {"settings": given["settings"], **describe_origin(catalogue), **given}


def digest_files(campaign: Campaign, computed: Mapping[str, str] | None = None) -> dict[str, str]:
    """Digest every file of a campaign: the first 16 hexadecimal digits of its SHA-256.

    Args:
        campaign: whose files are read.
        computed: digests that are not computed again.

    Returns:
        Digests by path relative to the campaign's folder.
    """
    return _digest_each(campaign, campaign.files, computed or {})


def digest_recordings(campaign: Campaign) -> dict[str, str]:
    """As `digest_files`, for the files of the runs alone, without the campaign file."""
    return _digest_each(campaign, [path for path in campaign.files if path != campaign.file], {})


def _digest_each(
    campaign: Campaign, files: Sequence[Path], computed: Mapping[str, str]
) -> dict[str, str]:
    present = {relpath(path, campaign.folder): path for path in files if path.is_file()}
    return {name: computed.get(name) or sha256_of(path)[:16] for name, path in present.items()}
