"""What every learned residual promises; learners are found, not listed."""

import hashlib
import io
import pickle
import zipfile
from pathlib import Path

import numpy as np
import pytest
import yaml

from rovsim.core.array_files import read_arrays, write_arrays
from rovsim.core.errors import BadInput
from rovsim.core.shipped import conf_names
from rovsim.dynamics.learned.checks import check_exported, posterior
from rovsim.dynamics.learned.layout import BLOCKS, COUNT, POINTS
from rovsim.dynamics.learned.predictor import evaluate, evaluate_many
from rovsim.dynamics.learned.residual import read_residual, write_residual
from rovsim.dynamics.learned.settings import MAX_FEATURES, FeatureSettings, feature_names
from rovsim.learning.export import Kernel, export_expansion
from rovsim.learning.gaussian import GaussianSettings
from rovsim.learning.learner import (
    learner,
    learner_settings,
    learners,
    library_of,
    spread_rows,
    train,
)
from rovsim.learning.learner import settings_of as stored_settings
from rovsim.learning.posterior_variance import EXACT_TOLERANCE, decompose_exact, rbf
from rovsim.learning.scaling import fit_scaling

# the fewest rounds with which a learner still learns: these tests are about promises, not skill
QUICK = {
    "knn": {},
    "gp": {"max_points": 90, "tuning_points": 60, "iterations": 15},
    "svgp": {"inducing": 20, "batch": 64, "iterations": 30},
}
VARIANTS = [(kind, {}) for kind in learners()] + [
    ("gp", {"kernel": "shared"}),
    ("knn", {"weights": "uniform"}),
    ("svgp", {"features": {"blocks": ["velocity", "acceleration", "gravity"], "scaling": "range"}}),
    ("gp", {"features": {"blocks": ["wrench"], "scaling": "none"}}),
]


def variants(chosen):
    """Only the learners of which this is true."""
    some = [variant for variant in VARIANTS if chosen(learner(variant[0]))]
    return pytest.mark.parametrize("trained", some, ids=name_of, indirect=True)


def name_of(variant):
    return "-".join([variant[0], *variant[1]])


def is_process(learner):
    return learner.posterior_from is not None


def has_library(learner):
    return learner.library_from is not None


def fades(learner):
    return issubclass(learner.settings, GaussianSettings)


def settings_of(kind, changes=None):
    return learner_settings({"kind": kind} | QUICK.get(kind, {}) | (changes or {}))


def pairs(settings, n=200, seed=0):
    """Features of unequal sizes, one of them constant, and targets of unequal sizes."""
    rng = np.random.default_rng(seed)
    d = len(feature_names(settings.features))
    X = rng.normal(size=(n, d)) * np.geomspace(0.1, 10.0, d)
    X[:, 2] = 3.0
    Y = np.sin(X[:, :1] / X[:, :1].std()) * np.geomspace(0.01, 10.0, 6)
    Y[:, 3] = 0.0
    return X, Y


@pytest.fixture(scope="module", params=VARIANTS, ids=name_of)
def trained(request):
    settings = settings_of(*request.param)
    X, Y = pairs(settings)
    return train(X, Y, settings, seed=3, control="6dof")


@pytest.fixture(scope="module")
def queries(trained):
    seen, _ = pairs(stored_settings(trained))
    new, _ = pairs(stored_settings(trained), n=100, seed=1)
    return np.concatenate([seen, new, 5.0 * new])


@variants(has_library)
def test_the_exported_prediction_is_the_library_s(trained, queries):
    expected = library_of(trained)(queries)
    process = is_process(learner(trained.kind))
    found = trained.posterior(queries)[0] if process else trained.predict(queries)
    assert np.abs(found - expected).max() < 1e-9


@variants(lambda one: not is_process(one))
def test_without_a_variance_none_is_given(trained, queries):
    with pytest.raises(BadInput, match="no variance"):
        trained.posterior(queries)


@variants(is_process)
def test_the_exported_variance_is_the_library_s(trained, queries):
    theirs = learner(trained.kind).posterior_from(trained.arrays, stored_settings(trained))
    X, Y = pairs(stored_settings(trained))
    prior = trained.posterior(far_from(X))[1].max(axis=0)
    # GPyTorch adds it to what svgp predicts
    jitter = 1e-6 * Y.var(axis=0) if trained.kind == "svgp" else 0.0
    found = trained.posterior(queries)[1]
    assert (np.abs(found + jitter - theirs(queries)[1]) <= 1.01 * EXACT_TOLERANCE * prior).all()


def far_from(X):
    """Features that are like none of these."""
    return X * np.where(np.ptp(X, axis=0) > 0, 1e4, 1.0)


@variants(fades)
def test_a_process_fades_where_it_has_seen_nothing(trained):
    """Full at almost all training rows, exactly nothing far away, never more than the mean."""
    X, _ = pairs(stored_settings(trained))
    far = far_from(X)
    assert (trained.predict(far) == 0.0).all()
    mean, faded = trained.posterior(X)[0], trained.predict(X)
    whole = np.isclose(faded, mean, rtol=1e-12)
    assert (whole | (np.abs(faded) < np.abs(mean))).all()
    assert whole.mean() > 0.95
    plain = settings_of(
        trained.kind, stored_settings(trained).model_dump() | {"extrapolation_quantile": None}
    )
    never = train(*pairs(plain), plain, seed=3, control="6dof")
    assert never.predict(far) == pytest.approx(never.posterior(far)[0], rel=1e-12)


def test_one_sample_and_many_give_the_same_bits(trained, queries):
    many = evaluate_many(trained.data, queries)
    x, one = np.full(MAX_FEATURES, np.nan), np.empty((len(queries), 6))
    for i, query in enumerate(queries):
        x[: len(query)] = query  # a longer vector: the rest is not read
        evaluate(trained.data, x, one[i])
    assert one.tobytes() == many.tobytes()


def test_saved_and_read_it_predicts_the_same_bits(trained, queries, tmp_path):
    description = yaml.safe_load(
        yaml.safe_dump(write_residual(tmp_path, trained).model_dump(mode="json"))
    )
    read = read_residual(description, tmp_path)
    assert read.predict(queries).tobytes() == trained.predict(queries).tobytes()
    if has_library(learner(trained.kind)):
        assert np.abs(library_of(read)(queries) - library_of(trained)(queries)).max() < 1e-9
    assert (stored_settings(read), read.control, read.kind) == (
        stored_settings(trained),
        "6dof",
        trained.kind,
    )
    assert read.points == trained.info["points"]


def test_same_seed_same_numbers(trained):
    X, Y = pairs(stored_settings(trained))
    again = train(X, Y, stored_settings(trained), seed=3, control="6dof")
    assert again.data.tobytes() == trained.data.tobytes()
    assert again.info == trained.info


def test_training_leaves_the_global_random_numbers_alone(trained):
    import torch

    X, Y = pairs(stored_settings(trained), n=80)
    torch.manual_seed(1)
    np.random.seed(1)  # noqa: NPY002
    before = torch.random.get_rng_state(), np.random.get_state()[1].tobytes()  # noqa: NPY002
    threads = torch.get_num_threads()
    train(X, Y, stored_settings(trained), seed=3, control="6dof")
    assert torch.equal(torch.random.get_rng_state(), before[0])
    assert np.random.get_state()[1].tobytes() == before[1]  # noqa: NPY002
    assert (torch.get_num_threads(), torch.get_default_dtype()) == (threads, torch.float32)


def test_a_constant_target_stays_constant(trained, queries):
    assert np.abs(trained.predict(queries)[:, 3]).max() < 1e-12


def test_no_number_comes_of_not_a_number(trained, queries):
    assert np.isnan(trained.predict(np.full((1, queries.shape[1]), np.nan))).all()


def test_progress_ends_at_the_end(trained):
    X, Y = pairs(stored_settings(trained), n=80)
    seen = []

    def note(done, total):
        seen.append((done, total))

    train(X, Y, stored_settings(trained), 0, note, control="6dof")
    assert [done for done, _ in seen] == list(range(1, seen[-1][1] + 1))


@pytest.mark.parametrize("kind", learners())
@pytest.mark.parametrize(
    "spoil", ["nan X", "nan Y", "infinite X", "short Y", "narrow X", "no rows"]
)
def test_unusable_pairs_are_refused(kind, spoil):
    settings = settings_of(kind)
    X, Y = pairs(settings)
    if spoil == "nan X":
        X[7, 1] = np.nan
    elif spoil == "infinite X":
        X[7, 1], X[8, 1] = np.inf, -np.inf
    elif spoil == "nan Y":
        Y[7, 1] = np.nan
    elif spoil == "short Y":
        Y = Y[1:]
    elif spoil == "narrow X":
        X = X[:, 1:]
    else:
        X, Y = X[:0], Y[:0]
    with pytest.raises(BadInput):
        train(X, Y, settings, seed=0, control="6dof")


@pytest.mark.parametrize("kind", learners())
def test_identical_rows_are_learnt(kind):
    settings = settings_of(kind)
    X, Y = np.ones((6, 12)), np.ones((6, 6))
    near = learner(kind).shrinkage + 1e-6
    assert train(X, Y, settings, seed=0, control="6dof").predict(X) == pytest.approx(Y, rel=near)


def test_fewer_rows_than_neighbours_are_refused():
    settings = settings_of("knn", {"k": 5})
    X, Y = pairs(settings, n=4)
    with pytest.raises(BadInput, match="4 training rows"):
        train(X, Y, settings, seed=0, control="6dof")


@pytest.mark.parametrize("kind", learners())
def test_a_learner_is_called_after_its_kind(kind):
    assert learner(kind).settings().kind == kind


@pytest.mark.parametrize("kind", conf_names("residual"))
def test_conf_states_the_defaults(kind):
    path = Path(__file__).parents[2] / "conf" / "residual" / f"{kind}.yaml"
    content = yaml.safe_load(path.read_text())
    assert learner_settings(content, path) == learner_settings({"kind": kind})
    assert set(content) == set(learner(kind).settings.model_fields)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ({"kind": "kn"}, "Did you mean 'knn'"),
        ({"kind": "knn", "kk": 3}, "unknown key 'kk'"),
        ({"kind": "knn", "k": 0}, "'k' is 0"),
        ({"kind": "knn", "features": {"blocks": []}}, "at least one of"),
        ({"kind": "knn", "features": {"blocks": ["velocity", "velocity"]}}, "each once"),
        ({}, "unknown residual"),
    ],
)
def test_unusable_settings_are_refused(content, message):
    with pytest.raises(BadInput, match=message):
        learner_settings(content)


@pytest.fixture(scope="module")
def saved(tmp_path_factory):
    folder = tmp_path_factory.mktemp("saved")
    settings = settings_of("knn")
    trained = train(*pairs(settings), settings, 0, control="6dof")
    return write_residual(folder, trained).model_dump(mode="json"), folder


@pytest.mark.parametrize(
    "place", ["../residual.npz", "arrays/residual.npz", "/residual.npz", "a\\b"]
)
def test_arrays_in_another_folder_are_refused(saved, place):
    description, folder = saved
    with pytest.raises(BadInput, match="without folders"):
        read_residual(description | {"file": place}, folder)


def copied(saved, tmp_path, change, resign=True):
    """A copy of the saved residual whose bytes went through `change`, its digest renewed."""
    description, folder = saved
    content = change((folder / description["file"]).read_bytes())
    (tmp_path / description["file"]).write_bytes(content)
    digest = hashlib.sha256(content).hexdigest() if resign else description["sha256"]
    return description | {"sha256": digest}


def with_array(name, change):
    """Rewrite one array of an `.npz`."""

    def rewrite(content):
        with np.load(io.BytesIO(content)) as archive:
            arrays = {key: archive[key].copy() for key in archive.files}
        arrays[name] = change(arrays[name])
        if arrays[name] is None:
            del arrays[name]
        buffer = io.BytesIO()
        np.savez(buffer, **arrays)
        return buffer.getvalue()

    return rewrite


def put(slot, value):
    def change(data):
        data[slot] = value
        return data

    return change


class Trap:
    """Would leave a mark if it were unpickled."""

    def __reduce__(self):
        return (Path.touch, (Path("sprung"),))


def pickled_member(content):
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        array = io.BytesIO()
        np.lib.format.write_array(array, np.array([Trap()], dtype=object), allow_pickle=True)
        archive.writestr("data.npy", array.getvalue())
    return buffer.getvalue()


DAMAGE = {
    "cut": lambda content: content[: len(content) // 2],
    "empty": lambda content: b"",
    "text": lambda content: b"not an archive",
    "pickle": lambda content: pickle.dumps(Trap()),
    "pickled member": pickled_member,
    "no data": with_array("data", lambda data: None),
    "shorter": with_array("data", lambda data: data[:-1]),
    "header only": with_array("data", lambda data: data[:3]),
    "single precision": with_array("data", lambda data: data.astype(np.float32)),
    "not finite": with_array("data", put(40, np.nan)),
    "more points": with_array("data", put(POINTS, 1e9)),
    "fractional points": with_array("data", put(POINTS, 200.5)),
    "too many neighbours": with_array("data", put(COUNT, 1000)),
    "other features": with_array("data", put(BLOCKS, 5)),
    "library not finite": with_array("library.points", put((3, 1), np.inf)),
}


@pytest.mark.parametrize("damage", DAMAGE)
def test_damaged_files_are_refused(saved, tmp_path, monkeypatch, damage):
    monkeypatch.chdir(tmp_path)
    description = copied(saved, tmp_path, DAMAGE[damage])
    with pytest.raises(BadInput, match=r"residual\.npz"):
        read_residual(description, tmp_path)
    assert not Path("sprung").exists()


def test_a_copy_is_accepted(saved, tmp_path):
    assert read_residual(copied(saved, tmp_path, lambda content: content), tmp_path).kind == "knn"


def test_an_altered_file_is_refused(saved, tmp_path):
    description = copied(saved, tmp_path, with_array("data", put(40, 0.5)), resign=False)
    with pytest.raises(BadInput, match="sha256"):
        read_residual(description, tmp_path)


@pytest.mark.parametrize(
    "change",
    [{"features": ["velocity"]}, {"extra": 1}, {"file": "absent.npz"}, {"control": "9dof"}],
    ids=lambda change: next(iter(change)),
)
def test_unusable_descriptions_are_refused(saved, change):
    description, folder = saved
    with pytest.raises(BadInput):
        read_residual(description | change, folder)


@pytest.mark.parametrize("change", [{"kind": "magic"}, {"settings": {"k": "many"}}], ids=str)
def test_a_library_is_rebuilt_only_from_what_its_learner_knows(saved, change):
    description, folder = saved
    with pytest.raises(BadInput):
        library_of(read_residual(description | change, folder))


def test_written_files_depend_on_the_residual_alone(saved, tmp_path):
    description, folder = saved
    write_arrays(tmp_path / "again.npz", **read_arrays(folder / description["file"]))
    again = (tmp_path / "again.npz").read_bytes()
    assert hashlib.sha256(again).hexdigest() == description["sha256"]


@pytest.mark.parametrize(("rows", "most"), [(1000, 100), (101, 100), (100, 100), (7, None)])
def test_kept_rows_are_spread_over_time(rows, most):
    kept = spread_rows(rows, most, seed=2)
    assert len(kept) == min(rows, most or rows)
    assert (np.diff(kept) > 0).all()
    assert np.diff(np.concatenate([[0], kept, [rows]])).max() <= 2 * -(-rows // len(kept))


def test_features_default_to_the_small_set_of_the_thesis():
    assert len(feature_names(FeatureSettings())) == 12
    large = FeatureSettings(blocks=("velocity", "wrench", "acceleration"))
    assert len(feature_names(large)) == 18


def test_however_noisy_a_process_has_a_variance():
    """Nothing of the prior is known then, and that is what it says."""
    Z = np.random.default_rng(0).normal(size=(5, 12))
    vague = decompose_exact(*np.linalg.eigh(rbf(Z, Z, np.ones(12))), noise=1e6)
    kernel = Kernel(Z, np.ones(12), np.zeros((5, 6)), np.full(6, 2.0), vague)
    scaling = fit_scaling("none", Z)
    data = export_expansion(FeatureSettings(), scaling, np.zeros(6), [kernel], fades=True)
    check_exported(data, FeatureSettings(), "test")
    assert posterior(data, Z, FeatureSettings())[1] == pytest.approx(
        2.0 * np.ones((5, 6)), rel=1e-5
    )
