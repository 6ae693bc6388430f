"""What every learner declares, and how learners are found: one module of this package each."""

import pkgutil
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any

import numpy as np
from numpy import ndarray as Array

import rovsim.learning
from rovsim.core.errors import BadInput, nearest
from rovsim.core.schema import Section, checked
from rovsim.dynamics.learned.features import FeatureSettings, feature_names
from rovsim.dynamics.learned.layout import EXPANSION, KIND
from rovsim.dynamics.learned.predictor import evaluate_many, posterior_many
from rovsim.learning.export import AXES

Predict = Callable[[Array], Array]  # features (n, d), unscaled -> acceleration (n, 6)
Posterior = Callable[[Array], tuple[Array, Array]]  # the same -> mean and variance, (n, 6) each
Progress = Callable[[int, int], None]  # rounds done, rounds in all


class LearnerSettings(Section):
    """Settings every learner has. Each adds its own `kind` and hyperparameters."""

    kind: str
    features: FeatureSettings = FeatureSettings()
    max_points: int | None = None  # training rows kept; null: all


@dataclass(frozen=True, eq=False)
class Trained:
    """A residual fresh from training.

    `data`: exported for the kernels. `arrays`: what the library's own model is rebuilt from.
    `library_predict`: the library's own prediction from unscaled features. `info`: numbers to
    report (points, seconds, hyperparameters, final loss).
    """

    settings: LearnerSettings
    data: Array
    arrays: dict[str, Array]
    library_predict: Predict
    info: dict[str, Any] = field(default_factory=dict)

    @property
    def kind(self) -> str:
        """Name of the learner."""
        return self.settings.kind

    @property
    def features(self) -> FeatureSettings:
        """Features it was trained on."""
        return self.settings.features

    def predict(self, X: Array) -> Array:
        """Residual acceleration (n, 6), m/s2 and rad/s2, at unscaled features X (n, d)."""
        return evaluate_many(self.data, checked_rows(X, self.features))

    def posterior(self, X: Array) -> tuple[Array, Array]:
        """Mean and variance of a process. See `posterior`."""
        return posterior(self.data, X, self.features)


@dataclass(frozen=True)
class Learner:
    """A way to learn a residual.

    `fit(X, Y, settings, seed, progress)` trains on features X (n, d) and residual accelerations
    Y (n, 6). `library_from(arrays, settings)` rebuilds the library's own prediction from
    `Trained.arrays`, without pickle; `posterior_from(arrays, settings, fast)` its mean and
    variance, where it has one.
    """

    settings: type[LearnerSettings]
    fit: Callable[..., Trained]
    library_from: Callable[[Mapping[str, Array], Any], Predict]
    posterior_from: Callable[..., Posterior] | None = None


def learners() -> dict[str, Learner]:
    """Every learner by kind: the modules of this package that declare a `LEARNER`."""
    names = [module.name for module in pkgutil.iter_modules(rovsim.learning.__path__)]
    modules = [import_module(f"{rovsim.learning.__name__}.{name}") for name in names]
    found = [module.LEARNER for module in modules if hasattr(module, "LEARNER")]
    return {learner.settings.model_fields["kind"].default: learner for learner in found}


def learner(kind: str, where: object = "residual") -> Learner:
    """The learner of that kind.

    Raises:
        BadInput: there is none; the nearest known kind is named.
    """
    known = learners()
    if kind in known:
        return known[kind]
    raise BadInput(
        f"unknown residual '{kind}'",
        where=where,
        expected=f"one of {', '.join(known)}",
        remedy=nearest(kind, known),
    )


def learner_settings(content: Any, where: Any = "residual") -> LearnerSettings:
    """Settings from plain values such as a file of `conf/residual`; `kind` names the learner.

    Raises:
        BadInput: unknown kind, unknown key or impossible value.
    """
    kind = content.get("kind") if isinstance(content, dict) else None
    return checked(learner(str(kind), where).settings, content, where)


def train(
    X: Array,
    Y: Array,
    settings: LearnerSettings,
    seed: int,
    progress: Progress = lambda done, total: None,
) -> Trained:
    """Train the residual that `settings` describe.

    Args:
        X: features (n, d), unscaled, rows in the order of time, run after run.
        Y: residual acceleration a_real - a_sim (n, 6), m/s2 and rad/s2.
        settings: a learner's settings.
        seed: same seed, same numbers.
        progress: called with rounds done and rounds in all.

    Raises:
        BadInput: rows that are not finite, do not fit together or are too few.
    """
    X, Y = checked_rows(X, settings.features, finite=True), np.asarray(Y, dtype=np.float64)
    if Y.shape != (len(X), AXES) or not np.isfinite(Y).all():
        raise BadInput(
            f"residual accelerations of shape {Y.shape}, {np.sum(~np.isfinite(Y))} not finite",
            where="training pairs",
            expected=f"finite numbers of shape {(len(X), AXES)}",
            remedy="Train on usable samples only.",
        )
    return learner(settings.kind).fit(X, Y, settings, seed, progress)


def posterior(data: Array, X: Array, features: FeatureSettings) -> tuple[Array, Array]:
    """Mean and variance (n, 6) of an exported process at unscaled features X (n, d); none fades.

    In m/s2 and rad/s2, and their squares; the variance is the process' own, without noise.

    Raises:
        BadInput: the residual is no process, or X has other columns.
    """
    if data[KIND] == EXPANSION:
        return posterior_many(data, checked_rows(X, features))
    raise BadInput(
        "nearest neighbours have no variance",
        where="posterior of a residual",
        expected="a residual of kind gp or svgp",
        remedy="Train one, or use predict.",
    )


def checked_rows(X: Array, features: FeatureSettings, finite: bool = False) -> Array:
    """Features as a contiguous float64 (n, d) with the columns that `features` name.

    Raises:
        BadInput: other shape; or, where `finite` is asked for, no rows or NaN.
    """
    X = np.ascontiguousarray(X, dtype=np.float64)
    d = len(feature_names(features))
    usable = not finite or (len(X) > 0 and np.isfinite(X).all())
    if X.ndim == 2 and X.shape[1] == d and usable:
        return X
    raise BadInput(
        f"features of shape {X.shape}, {np.sum(~np.isfinite(X))} not finite",
        where="features of the residual",
        expected=f"finite rows of {d} ({', '.join(features.blocks)})",
        remedy="Assemble them with the residual's own feature settings, from usable samples.",
    )


def spread_rows(rows: int, most: int | None, seed: int) -> Array:
    """Which of `rows` rows to keep, at most `most`, in order.

    Time is cut into `most` equally long stretches and one row is drawn from each, so that every
    manoeuvre is represented and no rhythm of the sampling is picked out.
    """
    if most is None or rows <= most:
        return np.arange(rows)
    edges = np.linspace(0, rows, most + 1).astype(np.int64)
    return np.random.default_rng(seed).integers(edges[:-1], edges[1:])
