"""A learner is one file: with it alone, everything that takes a residual takes the new kind."""

import json
import sys

import numpy as np
import pytest
from hydra.core.config_store import ConfigStore

import rovsim.learning.learners as own
from rovsim.application.configuration import compose
from rovsim.apps.cli.completion import suggest
from rovsim.apps.cli.main import main
from rovsim.apps.cli.sweep import check_sweep
from rovsim.core.errors import BadInput
from rovsim.dynamics.learned.residual import read_residual, write_residual
from rovsim.evaluation.latency import time_both_ways
from rovsim.learning.learner import learner_settings, learners, library_of, settings_of, train
from rovsim.reporting.figures import find_figure
from rovsim.reporting.figures.palette import is_learned, looks
from rovsim.reporting.wording import explain_model, title
from rovsim.reporting.words.speed import timing_sentences
from rovsim.results.timing import Timing

RIDGE = '''
"""Kernel ridge regression: an expansion without a variance, and regularised."""

from typing import Literal

import numpy as np

from rovsim.learning.export import Kernel, export_expansion
from rovsim.learning.learner import Learner, Trained
from rovsim.learning.posterior_variance import rbf
from rovsim.learning.scaling import fit_scaling
from rovsim.learning.settings import LearnerSettings


class RidgeSettings(LearnerSettings):
    """Kernel ridge regression."""

    kind: Literal["ridge"] = "ridge"
    alpha: float = 0.1


def fit(X, Y, settings, seed, progress):
    """Solve for the weights."""
    scaling = fit_scaling(settings.features.scaling, X)
    Z, length = scaling.apply(X), np.full(X.shape[1], 3.0)
    weights = np.linalg.solve(rbf(Z, Z, length) + settings.alpha * np.eye(len(Z)), Y)
    data = export_expansion(
        settings.features, scaling, np.zeros(6), [Kernel(Z, length, weights)], fades=True
    )
    progress(1, 1)
    return Trained(settings, data, info={"points": len(Z)})


LEARNER = Learner("ridge", "a ridge", RidgeSettings, fit, shrinkage=0.1)
'''


@pytest.fixture(autouse=True)
def ridge(tmp_path, monkeypatch):
    """A learner of somebody's own: one file, put into the folder of the learners."""
    folder = tmp_path / "more_learners"
    folder.mkdir()
    (folder / "ridge.py").write_text(RIDGE)
    monkeypatch.setattr(own, "__path__", [*own.__path__, str(folder)])
    monkeypatch.setattr(ConfigStore.instance(), "repo", {**ConfigStore.instance().repo})
    yield learner_settings({"kind": "ridge"})
    sys.modules.pop(f"{own.__name__}.ridge", None)


@pytest.fixture
def trained(ridge):
    """A residual of that learner."""
    X = np.random.default_rng(0).normal(size=(150, 12))
    return train(X, np.sin(X[:, :6]), ridge, seed=0, control="6dof")


def test_it_is_chosen_and_set_as_those_with_a_file(ridge):
    assert set(learners()) == {"gp", "knn", "svgp", "ridge"}
    assert compose(["residual=ridge"]).learner == ridge
    assert compose(["residual=ridge", "residual.alpha=0.5"]).learner.alpha == 0.5
    check_sweep(["residual=knn,ridge", "control=3dof,6dof"])
    with pytest.raises(BadInput, match=r"one of gp, knn, ridge, svgp.* 'ridge'\?"):
        compose(["residual=rigde"])
    with pytest.raises(BadInput, match=r"Did you mean 'residual\.alpha'"):
        compose(["residual=ridge", "residual.alhpa=0.5"])
    assert "residual=ridge" in suggest(["train"], "residual=r")


def test_without_library_and_variance_none_is_given(trained, ridge, tmp_path):
    assert settings_of(trained) == ridge
    description = write_residual(tmp_path, trained).model_dump(mode="json")
    read, X = read_residual(description, tmp_path), np.ones((3, 12))
    assert read.predict(X).tobytes() == trained.predict(X).tobytes()
    with pytest.raises(BadInput, match="no variance"):
        read.posterior(X)
    with pytest.raises(BadInput, match="no library"):
        library_of(read)


def test_it_is_timed_without_a_library(trained):
    times = time_both_ways(trained, np.ones((3, 12)), calls=5, warmup=1, seconds=0.1)
    assert list(times.measured) == ["exported"]
    timing = Timing.model_validate_json(Timing(inference={"ridge_6dof": times}).model_dump_json())
    assert "library" not in " ".join(timing_sentences(timing))
    assert find_figure("inference_time").draw(timing=timing).axes


def test_it_is_called_and_drawn_by_its_own_name_and_look():
    assert title("effects+ridge_6dof") == "effects + ridge (6-DoF)"
    assert "a ridge that learned the rest" in explain_model("ridge_3dof")
    assert is_learned("ridge_3dof")
    assert len({look.color for look in looks(["ridge_3dof", "effects", "gp_3dof"]).values()}) == 3


@pytest.mark.usefixtures("few_figures")
def test_it_is_trained_and_compared(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    main(["tank", "tank=tiny", "tank.duration=8", "out=tank", "-q"])
    main(["train", "campaign=tank", "residual=ridge", "residual.alpha=0.5", "out=o"])
    assert "ridge (6-DoF)" in capsys.readouterr().out
    main(["compare", "campaign=tank", "model=[nominal,o/model.yaml]", "out=c", "-q"])
    found = json.loads((tmp_path / "c" / "comparison.json").read_text())
    assert set(found["models"]) == {"nominal", "model"}
