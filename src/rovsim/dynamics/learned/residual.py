"""Write and read trained residuals: arrays as `.npz`, all else in the model file. No pickle."""

import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from numpy import ndarray as Array
from pydantic import AfterValidator

from rovsim.core.array_files import read_arrays, write_arrays
from rovsim.core.errors import BadInput
from rovsim.core.files import plain, sha256_of
from rovsim.core.schema import PathText, Section, checked
from rovsim.dynamics.learned.checks import check_exported, checked_rows, posterior
from rovsim.dynamics.learned.layout import POINTS
from rovsim.dynamics.learned.predictor import evaluate_many
from rovsim.dynamics.learned.settings import Block, Control, FeatureSettings

LIBRARY_PREFIX = "library."  # prefix of the arrays from which the library's own model is rebuilt
ARRAYS_FILE = "residual.npz"  # file of the arrays, beside the model file


def _beside(name: str) -> str:
    """Refuse a file name with folders."""
    if Path(name).name != name or "\\" in name:
        raise ValueError("the name of a file beside the model file, without folders")
    return name


class StoredResidual(Section):
    """The section of a model file that describes its residual."""

    kind: str
    control: Control  # runs it was trained on
    file: Annotated[PathText, AfterValidator(_beside)]  # arrays, beside the model file
    sha256: str  # of that file
    features: tuple[Block, ...]
    scaling: Literal["standard", "range", "none"]
    settings: dict[str, Any]  # hyperparameters
    info: dict[str, Any]  # what training reported


@dataclass(frozen=True, eq=False)
class Residual:
    """A trained residual, as a model holds it.

    Attributes:
        control: kind of the runs it was trained on.
        kind: name of the learner that trained it.
        features: its features, and how these were scaled.
        settings: hyperparameters of the learner.
        data: the exported residual that kernels evaluate, in the order of `layout`.
        arrays: from which, with `settings`, the model of the library that trained it is rebuilt
            (`rovsim.learning.learner`).
        info: numbers that training reported.
    """

    control: Control
    kind: str
    features: FeatureSettings
    settings: dict[str, Any]
    data: Array
    arrays: dict[str, Array]
    info: dict[str, Any]

    @property
    def points(self) -> int:
        """Number of training or inducing points that it holds."""
        return int(self.data[POINTS])

    def predict(self, X: Array) -> Array:
        """Evaluate the body acceleration (n, 6), m/s2 and rad/s2, at unscaled features X (n, d)."""
        return evaluate_many(self.data, checked_rows(X, self.features))

    def posterior(self, X: Array) -> tuple[Array, Array]:
        """Evaluate mean and variance of a Gaussian process; see `checks.posterior`."""
        return posterior(self.data, X, self.features)


def write_residual(folder: Path, residual: Residual) -> StoredResidual:
    """Write the arrays of a residual into a folder; returns the section for the model file."""
    library = {LIBRARY_PREFIX + key: array for key, array in residual.arrays.items()}
    write_arrays(folder / ARRAYS_FILE, data=residual.data, **library)
    return StoredResidual(
        kind=residual.kind,
        control=residual.control,
        file=ARRAYS_FILE,
        sha256=sha256_of(folder / ARRAYS_FILE),
        features=residual.features.blocks,
        scaling=residual.features.scaling,
        settings=plain(residual.settings),
        info=plain(residual.info),
    )


def read_residual(description: Any, folder: Path, where: object = "residual") -> Residual:
    """Read a residual that `write_residual` wrote.

    Args:
        description: the section of a model file that describes the residual.
        folder: folder of that model file.
        where: the model file, for messages.

    Raises:
        BadInput: unknown key, missing, damaged or altered file, arrays that do not fit.
    """
    entry = checked(StoredResidual, description, str(where))
    features = checked(
        FeatureSettings,
        {"blocks": entry.features, "scaling": entry.scaling},
        f"{where}, features",
    )
    path = folder / entry.file
    _refuse_altered(path, entry.sha256)
    arrays = read_arrays(path)
    data = check_exported(arrays.pop("data", None), features, path)
    library = {key.removeprefix(LIBRARY_PREFIX): _finite(a, key, path) for key, a in arrays.items()}
    return Residual(entry.control, entry.kind, features, entry.settings, data, library, entry.info)


def _refuse_altered(path: Path, digest: str) -> None:
    """Refuse a file that is missing, is not an archive or is not the one the model names."""
    if not path.is_file():
        fault = "no such file"
    elif sha256_of(path) != digest:
        fault = "not the file this model was saved with (its sha256 differs)"
    elif not zipfile.is_zipfile(path):
        fault = "not an .npz archive"
    else:
        return
    raise BadInput(
        fault,
        where=path,
        expected="the arrays of the trained residual",
        remedy="Keep the .npz beside its model file, unchanged, or train the residual again.",
    )


def _finite(array: Array, name: str, path: Path) -> Array:
    """Refuse an array that is not of finite float64."""
    if array.dtype == np.float64 and np.isfinite(array).all():
        return array
    raise BadInput(
        f"array '{name}' holds {array.dtype} or numbers that are not finite",
        where=path,
        expected="finite float64 numbers",
        remedy="Train the residual again.",
    )
