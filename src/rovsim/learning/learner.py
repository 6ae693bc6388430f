"""What every learner declares, how learners are found (one file each in `learners/`), training."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any

import numpy as np
from numpy import ndarray as Array

from rovsim.core.axes import AXES
from rovsim.core.errors import BadInput, unlisted
from rovsim.core.extras import require
from rovsim.core.schema import checked
from rovsim.dynamics.learned.checks import checked_rows
from rovsim.dynamics.learned.residual import Residual
from rovsim.dynamics.learned.settings import Control
from rovsim.learning import learners as package
from rovsim.learning.learners import list_kinds
from rovsim.learning.settings import LearnerSettings

Predict = Callable[[Array], Array]  # features (n, d), unscaled -> acceleration (n, 6)
Posterior = Callable[[Array], tuple[Array, Array]]  # the same -> mean and variance, (n, 6) each
Progress = Callable[[int, int], None]  # rounds done, rounds in all


@dataclass(frozen=True, eq=False)
class Trained:
    """What the `fit` of a learner returns; `train` makes a `Residual` of it.

    Attributes:
        settings: of the learner, with what the training chose.
        data: the exported residual that kernels evaluate.
        arrays: from which the model of the library that trained it is rebuilt, if there is one.
        info: numbers to report (points, hyperparameters, final loss), but no times, so that equal
            inputs make equal files.
    """

    settings: LearnerSettings
    data: Array
    arrays: dict[str, Array] = field(default_factory=dict)
    info: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Learner:
    """A way to learn a residual.

    Attributes:
        title: what people call it ("GP").
        meaning: the same in full ("a Gaussian process").
        settings: class of its settings.
        fit: `fit(X, Y, settings, seed, progress)` trains on features X (n, d) and residual
            accelerations Y (n, 6).
        library_from: `library_from(arrays, settings)` rebuilds the prediction of the library
            itself from the stored arrays, without pickle; None where no library has this model.
        posterior_from: `posterior_from(arrays, settings, fast)` rebuilds mean and variance of the
            library itself; None for learners without a variance.
        shrinkage: largest share of a target by which a prediction may fall short of it where all
            training rows agree, because the learner is regularised.
    """

    title: str
    meaning: str
    settings: type[LearnerSettings]
    fit: Callable[..., Trained]
    library_from: Callable[[Mapping[str, Array], Any], Predict] | None = None
    posterior_from: Callable[..., Posterior] | None = None
    shrinkage: float = 0.0


def learners() -> Mapping[str, Learner]:
    """Find every learner that a module of `rovsim.learning.learners` declares, by its kind."""
    return {kind: import_module(f"{package.__name__}.{kind}").LEARNER for kind in list_kinds()}


def learner(kind: str, where: object = "residual") -> Learner:
    """Look up a learner by its kind.

    Raises:
        BadInput: there is no learner of this kind; the nearest known kind is named.
    """
    by_kind = learners()
    if kind in by_kind:
        return by_kind[kind]
    raise unlisted(kind, by_kind, found=f"unknown residual '{kind}'", where=where)


def learner_settings(content: Any, where: Any = "residual") -> LearnerSettings:
    """Make settings from plain values such as those of a file in `conf/residual`.

    The value of `kind` says which learner they are for.

    Raises:
        BadInput: unknown kind, unknown key or impossible value.
    """
    kind = content.get("kind") if isinstance(content, dict) else None
    return checked(learner(str(kind), where).settings, content, where)


def settings_of(residual: Residual) -> LearnerSettings:
    """The settings that a residual was trained with.

    Raises:
        BadInput: no known learner has these settings.
    """
    features = {"blocks": residual.features.blocks, "scaling": residual.features.scaling}
    return learner_settings(residual.settings | {"kind": residual.kind, "features": features})


def library_of(residual: Residual) -> Predict:
    """Rebuild the prediction of the library that trained a residual, from the stored arrays.

    Raises:
        BadInput: no known learner has these settings, no library has such a model, or the library
            is not installed.
    """
    require("learn", by=f"residual={residual.kind}")
    if (rebuild := learner(residual.kind).library_from) is not None:
        return rebuild(residual.arrays, settings_of(residual))
    raise BadInput(
        f"no library has the model of '{residual.kind}'",
        where="library of a residual",
        expected="a residual that a library trained, such as knn or gp",
        remedy="Use predict.",
    )


def train(
    X: Array,
    Y: Array,
    settings: LearnerSettings,
    seed: int,
    progress: Progress = lambda done, total: None,
    *,
    control: Control,
) -> Residual:
    """Train the residual that `settings` describe.

    Args:
        X: features (n, d), unscaled, rows in the order of time, run after run.
        Y: residual acceleration a_real - a_sim (n, 6), m/s2 and rad/s2.
        settings: a learner's settings.
        seed: same seed, same numbers.
        progress: called with rounds done and rounds in all.
        control: of the runs that the rows are from.

    Raises:
        BadInput: rows that are not finite, do not fit together or are too few; or the learner's
            library is not installed.
    """
    require("learn", by=f"residual={settings.kind}")
    X, Y = checked_rows(X, settings.features, finite=True), np.asarray(Y, dtype=np.float64)
    if Y.shape != (len(X), len(AXES)) or not np.isfinite(Y).all():
        raise BadInput(
            f"residual accelerations of shape {Y.shape}, {np.sum(~np.isfinite(Y))} not finite",
            where="training pairs",
            expected=f"finite numbers of shape {(len(X), len(AXES))}",
            remedy="Train on usable samples only.",
        )
    trained = learner(settings.kind).fit(X, Y, settings, seed, progress)
    chosen = trained.settings.model_dump(mode="json", exclude={"kind", "features"})
    return Residual(
        control,
        settings.kind,
        settings.features,
        chosen,
        trained.data,
        trained.arrays,
        trained.info,
    )


def spread_rows(rows: int, most: int | None, seed: int) -> Array:
    """Choose at most `most` of some rows, spread over all of them.

    The rows are cut into `most` equally long stretches, and one row is drawn from each. So every
    manoeuvre is represented, and no regular subsampling can alias a periodic motion.

    Args:
        rows: number of rows, in the order of time.
        most: largest number of rows to keep; None: all.
        seed: of the draws.

    Returns:
        Indices of the kept rows, rising.
    """
    if most is None or rows <= most:
        return np.arange(rows)
    edges = np.linspace(0, rows, most + 1).astype(np.int64)
    return np.random.default_rng(seed).integers(edges[:-1], edges[1:])
