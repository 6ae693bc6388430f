"""Where a result came from: recordings, code, settings, versions, machine.

No clock: equal inputs, equal files.
"""

import ast
import hashlib
import platform
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from os.path import relpath
from pathlib import Path
from typing import Any, Iterable, Mapping, Sequence

import rovsim
from rovsim.core.schema import Section
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.vehicle import vehicle_file
from rovsim.measurement.campaign import Campaign

SOURCE = Path(rovsim.__file__).parent
MODEL, VEHICLE = "rovsim.dynamics.model", "rovsim.dynamics.vehicle.load"
OF_MODELS = ("rovsim.dynamics.effects", "rovsim.dynamics.engine")
LOOKED_INTO = ("rovsim.measurement.recording", "rovsim.learning.learners")
UNRELATED = ("command", "tracking", "timing", "blind", "bench", "out", "output", "port", "open")
PACKAGES = ("numpy", "scipy", "numba", "scikit-learn", "gpytorch", "torch", "pysindy")


def digest(*names: str, without: str = "", described: Sequence[Path] = ()) -> str:
    """Digest of modules of rovsim and of all they import, however deep, but for a package.

    A package stands for all its modules: what is found by looking has no import to follow. Files
    in which vehicles and effects are `described` count for modules that know either.
    """
    wanted = find_modules(*names)
    if without:
        wanted = {name for name in wanted if not f"{name}.".startswith(f"{without}.")}
    return _digest(map(_file, sorted(wanted)), described if wanted & {MODEL, VEHICLE} else ())


def imports_of(script: Path) -> list[str]:
    """Modules of rovsim that a script imports."""
    tree = ast.parse(script.read_text(encoding="utf-8"))
    found = [node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
    return sorted({name for name in found if name and name.startswith("rovsim")})


def find_modules(*names: str) -> set[str]:
    """These modules of rovsim and all they import, however deep, as `digest` takes them."""
    graph = _graph()

    def found(packages: Iterable[str]) -> set[str]:
        own = {name for package in packages for name in (package, *graph.find_descendants(package))}
        return own.union(*(graph.find_upstream_modules(name) for name in own))

    wanted = found(names)
    return wanted | found(_discovered(wanted))


def own_digest(package: str, described: Sequence[Path] = ()) -> str:
    """Digest of a package's own modules, whatever they import, and of `described` (`digest`)."""
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
    """What Python reads in an effect of somebody's own: a comment there changes no result."""
    try:
        return ast.dump(ast.parse(source)).encode()
    except (SyntaxError, ValueError):
        return source  # refused where it is read


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
    """Recordings, vehicle file, settings, code and versions behind a result.

    Settings without influence are left out; so are recordings that these make (None).
    `recordings`: their digests, where these are known (`digest_recordings`).
    """
    chosen = settings.model_dump(mode="json", exclude=set(UNRELATED))
    origin = {"settings": chosen, **describe_origin(catalogue)}
    if campaign is None:
        return origin
    vehicle = vehicle_file(campaign.vehicle, named_in=campaign.file)
    return origin | {
        "recordings": digest_files(campaign, recordings),
        "vehicle": _sha256(vehicle)[:16],
    }


def digest_files(campaign: Campaign, known: Mapping[str, str] | None = None) -> dict[str, str]:
    """The first 16 digits of the SHA-256 of every file of a campaign, by its path from there.

    Those that are `known` are not read again.
    """
    return _digest_each(campaign, campaign.files, known or {})


def digest_recordings(campaign: Campaign) -> dict[str, str]:
    """The same of the files of its runs alone, without the campaign file."""
    return _digest_each(campaign, [path for path in campaign.files if path != campaign.file], {})


def _digest_each(
    campaign: Campaign, files: Sequence[Path], known: Mapping[str, str]
) -> dict[str, str]:
    there = {relpath(path, campaign.folder): path for path in files if path.is_file()}
    return {name: known.get(name) or _sha256(path)[:16] for name, path in there.items()}


def _sha256(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
