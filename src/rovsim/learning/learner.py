"""What every learner declares, and how learners are found: one file of `learners/` each."""

import pkgutil
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any

import numpy as np
from numpy import ndarray as Array

import rovsim.learning.learners
from rovsim import AXES
from rovsim.core.errors import BadInput, unlisted
from rovsim.core.extras import require
from rovsim.core.schema import checked
from rovsim.dynamics.learned.checks import checked_rows, posterior
from rovsim.dynamics.learned.predictor import evaluate_many
from rovsim.dynamics.learned.residual import Residual
from rovsim.dynamics.learned.settings import Control, FeatureSettings
from rovsim.learning.settings import LearnerSettings

Predict = Callable[[Array], Array]  # features (n, d), unscaled -> acceleration (n, 6)
Posterior = Callable[[Array], tuple[Array, Array]]  # the same -> mean and variance, (n, 6) each
Progress = Callable[[int, int], None]  # rounds done, rounds in all


@dataclass(frozen=True, eq=False)
class Trained:
    """A residual fresh from training.

    `data`: exported for the kernels. `arrays`: what the library's own model is rebuilt from.
    `info`: numbers to report (points, hyperparameters, final loss). No times: equal inputs make
    equal files.
    """

    settings: LearnerSettings
    data: Array
    arrays: dict[str, Array]
    info: dict[str, Any] = field(default_factory=dict)

    @property
    def kind(self) -> str:
        """Name of the learner."""
        return self.settings.kind

    @property
    def features(self) -> FeatureSettings:
        """Features it was trained on."""
        return self.settings.features

    def residual(self, control: Control) -> Residual:
        """What a model holds of it; `control`: the runs it was trained on."""
        settings = self.settings.model_dump(mode="json", exclude={"kind", "features"})
        return Residual(
            control, self.kind, self.features, settings, self.data, self.arrays, self.info
        )

    def predict(self, X: Array) -> Array:
        """Residual acceleration (n, 6), m/s2 and rad/s2, at unscaled features X (n, d)."""
        return evaluate_many(self.data, checked_rows(X, self.features))

    def posterior(self, X: Array) -> tuple[Array, Array]:
        """Mean and variance of a process. See `posterior`."""
        return posterior(self.data, X, self.features)


@dataclass(frozen=True)
class Learner:
    """A way to learn a residual.

    `title` is what people call it, `meaning` the same in full ("a Gaussian process").
    `fit(X, Y, settings, seed, progress)` trains on features X (n, d) and residual accelerations
    Y (n, 6). `library_from(arrays, settings)` rebuilds the library's own prediction from
    `Trained.arrays`, without pickle; `posterior_from(arrays, settings, fast)` its mean and
    variance, where it has one. `shrinkage` is the largest share of a target that it leaves out
    where all rows agree: one that is regularised keeps away from what it was told.
    """

    title: str
    meaning: str
    settings: type[LearnerSettings]
    fit: Callable[..., Trained]
    library_from: Callable[[Mapping[str, Array], Any], Predict]
    posterior_from: Callable[..., Posterior] | None = None
    shrinkage: float = 0.0


def learners() -> Mapping[str, Learner]:
    """Every learner by kind: what the modules of `rovsim.learning.learners` declare."""
    package = rovsim.learning.learners
    names = [module.name for module in pkgutil.iter_modules(package.__path__)]
    found = [import_module(f"{package.__name__}.{name}").LEARNER for name in names]
    return {learner.settings.model_fields["kind"].default: learner for learner in found}


def learner(kind: str, where: object = "residual") -> Learner:
    """The learner of that kind.

    Raises:
        BadInput: there is none; the nearest known kind is named.
    """
    known = learners()
    if kind in known:
        return known[kind]
    raise unlisted(kind, known, found=f"unknown residual '{kind}'", where=where)


def learner_settings(content: Any, where: Any = "residual") -> LearnerSettings:
    """Settings from plain values such as a file of `conf/residual`; `kind` names the learner.

    Raises:
        BadInput: unknown kind, unknown key or impossible value.
    """
    kind = content.get("kind") if isinstance(content, dict) else None
    return checked(learner(str(kind), where).settings, content, where)


def settings_of(residual: Residual) -> LearnerSettings:
    """What a stored residual was trained with.

    Raises:
        BadInput: no learner here has these settings.
    """
    features = {"blocks": residual.features.blocks, "scaling": residual.features.scaling}
    return learner_settings(residual.settings | {"kind": residual.kind, "features": features})


def library_of(residual: Residual) -> Predict:
    """The library's own prediction, rebuilt from the stored arrays.

    Raises:
        BadInput: no learner here has these settings, or its library is not installed.
    """
    require("learn", by=f"residual={residual.kind}")
    return learner(residual.kind).library_from(residual.arrays, settings_of(residual))


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
    return learner(settings.kind).fit(X, Y, settings, seed, progress)


def spread_rows(rows: int, most: int | None, seed: int) -> Array:
    """Which of `rows` rows to keep, at most `most`, in order.

    Time is cut into `most` equally long stretches and one row is drawn from each, so that every
    manoeuvre is represented and no rhythm of the sampling is picked out.
    """
    if most is None or rows <= most:
        return np.arange(rows)
    edges = np.linspace(0, rows, most + 1).astype(np.int64)
    return np.random.default_rng(seed).integers(edges[:-1], edges[1:])
