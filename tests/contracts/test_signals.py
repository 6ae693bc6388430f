"""What every option of the signal chain keeps to; options are found, not listed."""

from itertools import pairwise
from typing import get_args

import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from rovsim.core import rotations
from rovsim.core.errors import BadInput
from rovsim.core.run import Commands, RunInfo, Site
from rovsim.core.schema import checked
from rovsim.core.shipped import shipped
from rovsim.measurement.recording.recording import Recording
from rovsim.measurement.signals.chain import (
    SignalSettings,
    clean,
    differentiated,
    filter_and_differentiate,
    filtered,
    read_stage,
    resampled,
)
from rovsim.measurement.signals.differentiate import Differentiation
from rovsim.measurement.signals.filter import Filter, filter_eta
from rovsim.measurement.signals.motion import Motion, Poses
from rovsim.measurement.signals.outliers import KeepAll, Outliers, find_outliers
from rovsim.measurement.signals.resample import Resampling, resample

CONF = shipped("conf")


def options(group):
    """The settings classes of a group, from its type: Annotated[A | B | ..., discriminator]."""
    return get_args(get_args(group)[0])


GROUPS = {
    "outliers": options(Outliers),
    "resample": options(Resampling),
    "filter": options(Filter),
    "differentiate": options(Differentiation),
}
EVERY = [(group, kind) for group, kinds in GROUPS.items() for kind in kinds]
CHAINS = [
    SignalSettings(filter=f(), differentiate=d())
    for f in GROUPS["filter"]
    for d in GROUPS["differentiate"]
]


def name(x):
    if isinstance(x, SignalSettings):
        return f"{x.filter.kind}-{x.differentiate.kind}"
    return x if isinstance(x, str) else x.model_fields["kind"].default


def wandering(seed, n, batch=()):
    """Smooth random poses (*batch, n, 7), 0.01 s apart, below 1 Hz."""
    rng = np.random.default_rng(seed)
    t = 0.01 * np.arange(n)[:, None, None]
    pulse, phase = rng.uniform(0.5, 6, (*batch, 1, 6, 3)), rng.uniform(0, 6, (*batch, 1, 6, 3))
    x = np.sum(0.1 * np.sin(pulse * t + phase), axis=-1)
    return np.concatenate([x[..., :3], rotations.exp(x[..., 3:])], axis=-1)


def recording(eta, time=None, found=None, nu=None):
    time = 0.01 * np.arange(len(eta)) if time is None else time
    found = np.ones(len(eta), bool) if found is None else found
    eta = np.where(found[:, None], eta, np.nan)
    commands = Commands(time[:1], np.zeros((1, 8)), "thruster")
    run = RunInfo("6dof-1", "6dof", "train")
    return Recording(run, Site.unknown(), time, eta[:, :3], eta[:, 3:], found, commands, 100.0, nu)


@pytest.mark.parametrize("group", GROUPS)
def test_the_configuration_offers_every_kind_and_no_other(group):
    files = {path.stem for path in (CONF / group).glob("*.yaml")}
    assert files == {kind.model_fields["kind"].default for kind in GROUPS[group]}


@pytest.mark.parametrize(("group", "kind"), EVERY, ids=name)
def test_the_configuration_holds_the_keys_and_defaults_of_the_section(group, kind):
    content = yaml.safe_load((CONF / group / f"{name(kind)}.yaml").read_text())
    assert content == kind().model_dump()
    assert checked(SignalSettings, {group: content}, "conf").model_dump()[group] == content


def test_an_unknown_key_is_named():
    with pytest.raises(BadInput, match="cutof"):
        checked(SignalSettings, {"filter": {"kind": "butterworth", "cutof": 3.0}}, "conf")


@pytest.mark.parametrize("chain", CHAINS, ids=name)
def test_a_body_at_rest_has_no_velocity(chain):
    eta = np.tile(wandering(1, 1), (60, 1))
    for x in filter_and_differentiate(eta, 0.01, chain):
        np.testing.assert_allclose(x, 0.0, atol=1e-8)


@pytest.mark.parametrize("chain", CHAINS, ids=name)
@pytest.mark.parametrize("n", [50, 201])
def test_a_film_run_backwards(chain, n):
    eta = wandering(2, n)
    nu, nu_dot = filter_and_differentiate(eta, 0.01, chain)
    back_nu, back_nu_dot = filter_and_differentiate(eta[::-1], 0.01, chain)
    # nu_dot = d/dt nu keeps its sign; the tolerance is the filter's remaining transient
    np.testing.assert_allclose(back_nu[::-1], -nu, atol=1e-4)
    np.testing.assert_allclose(back_nu_dot[::-1], nu_dot, atol=5e-3)


@pytest.mark.parametrize("chain", CHAINS, ids=name)
def test_a_batch_is_a_loop(chain):
    eta = wandering(3, 50, batch=(2, 3))
    nu, nu_dot = filter_and_differentiate(eta, 0.01, chain)
    for i in np.ndindex(2, 3):
        one_nu, one_nu_dot = filter_and_differentiate(eta[i], 0.01, chain)
        np.testing.assert_allclose(nu[i], one_nu, atol=1e-12)
        np.testing.assert_allclose(nu_dot[i], one_nu_dot, atol=1e-9)


@pytest.mark.parametrize("chain", CHAINS, ids=name)
@pytest.mark.parametrize("n", [1, 2, 3, 4, 7, 20])
def test_short_series_give_numbers_or_say_that_they_cannot(chain, n):
    nu, nu_dot = filter_and_differentiate(wandering(4, n), 0.01, chain)
    assert nu.shape == nu_dot.shape == (n, 6)
    assert (np.isfinite(nu) == (n >= 3)).all()
    assert (np.isfinite(nu_dot) == (n >= 3)).all()


@pytest.mark.parametrize("kind", GROUPS["differentiate"], ids=name)
@pytest.mark.parametrize("dt", [0.005, 0.05, 1.0])
def test_a_steady_motion_has_its_velocity_at_any_rate(kind, dt):
    x = 0.3 * dt * np.arange(40)[:, None]
    first, second = kind().derivatives(x, dt)
    np.testing.assert_allclose(first, 0.3, atol=1e-9)
    np.testing.assert_allclose(second, 0.0, atol=1e-6)


@pytest.mark.parametrize("kind", GROUPS["filter"], ids=name)
def test_filters_leave_unit_quaternions_and_their_input_alone(kind):
    eta = wandering(5, 300)
    before = eta.copy()
    out = filter_eta(eta, 0.01, kind())
    np.testing.assert_array_equal(eta, before)
    np.testing.assert_allclose(np.linalg.norm(out[:, 3:], axis=1), 1.0, atol=1e-12)


@pytest.mark.parametrize("kind", GROUPS["resample"], ids=name)
@settings(deadline=None, max_examples=25)
@given(seed=st.integers(0, 2**32 - 1))
def test_long_gaps_stay_gaps_and_the_clock_is_uniform(kind, seed):
    rng = np.random.default_rng(seed)
    n, eta = 800, wandering(seed, 800)
    found = np.ones(n, bool)
    for start, length in zip(rng.integers(0, n, 6), rng.integers(1, 40, 6), strict=True):
        found[start : start + length] = False
    time = 0.01 * np.arange(n) + 3.0 + rng.uniform(-0.004, 0.004, n)
    chosen = kind(rate=rng.choice([None, 50.0, 137.0]), min_segment=0.0)
    poses = resample(recording(eta, time, found), chosen, KeepAll())
    seen = time[found]
    np.testing.assert_allclose(np.diff(poses.time), 1 / (chosen.rate or 100.0), atol=1e-9)
    assert seen[0] <= poses.time[0]
    assert poses.time[-1] <= seen[-1] + 1e-9
    for first, last in pairwise(seen):
        inside = (poses.time > first + 1e-4) & (poses.time < last - 1e-4)
        assert (poses.usable[inside] == (last - first <= chosen.max_gap)).all() or np.isclose(
            last - first, chosen.max_gap, atol=1e-4
        )
    # accelerations stay below 0.1 x 3 x 6^2 = 11 /s2 an axis: h^2 / 8 of it over a gap of 0.1 s
    between = np.stack([np.interp(poses.time, 3.0 + 0.01 * np.arange(n), x) for x in eta.T], axis=1)
    between[:, 3:] = rotations.normalized(between[:, 3:])
    # 4 ms of jitter at up to 0.1 x 3 x 6 = 1.8 /s
    off = np.abs(poses.eta - between)[poses.usable]
    assert off.max() < 11 * 0.1**2 / 8 + 0.004 * 1.8
    np.testing.assert_allclose(np.linalg.norm(poses.eta[:, 3:], axis=1), 1.0, atol=1e-12)


@pytest.mark.parametrize("kind", GROUPS["resample"], ids=name)
def test_frames_on_the_clock_pass_unchanged(kind):
    eta = wandering(6, 200)
    poses = resample(recording(eta), kind(), KeepAll())
    assert poses.usable.all()
    np.testing.assert_allclose(poses.eta, eta, atol=1e-9)


@pytest.mark.parametrize("kind", GROUPS["outliers"], ids=name)
@settings(deadline=None, max_examples=25)
@given(seed=st.integers(0, 2**32 - 1), share=st.floats(0, 0.6))
def test_outliers_are_found_frames_and_found_only_once(kind, seed, share):
    """Run again without what it rejected, the search rejects nothing, however bad the run."""
    rng = np.random.default_rng(seed)
    n = 300
    eta = wandering(seed, n)
    bad = rng.random(n) < share
    eta[bad, :3] += rng.normal(size=(bad.sum(), 3)) * 0.2
    found = rng.random(n) < 0.9
    mask = find_outliers(recording(eta, found=found), kind())
    assert not (mask & ~found).any()
    again = find_outliers(recording(eta, found=found & ~mask), kind())
    assert not again.any()


@pytest.mark.parametrize("kind", GROUPS["outliers"], ids=name)
@pytest.mark.parametrize("seen", [0, 1, 2, 5])
def test_a_run_with_hardly_a_frame_is_not_usable_and_not_an_error(kind, seen):
    found = np.arange(100) < seen
    chain = SignalSettings(outliers=kind())
    motion = clean(recording(wandering(7, 100), found=found), chain)
    assert not motion.usable.any()


def test_the_stages_written_and_read_are_the_chain(tmp_path):
    found = np.ones(400, bool)
    found[200:230] = False
    run, chain = recording(wandering(8, 400), found=found), SignalSettings()
    resampled(run, chain).write(tmp_path / "a.npz")
    filtered(read_stage(tmp_path / "a.npz"), chain).write(tmp_path / "b.npz")
    assert isinstance(read_stage(tmp_path / "b.npz"), Poses)
    differentiated(read_stage(tmp_path / "b.npz"), chain).write(tmp_path / "c.npz")
    motion, whole = Motion.read(tmp_path / "c.npz"), clean(run, chain)
    np.testing.assert_array_equal(motion.nu_dot, whole.nu_dot)
    # 0.1 s of margin at all four ends
    assert motion.segments() == [(10, 190), (240, 390)]
    assert np.isfinite(motion.state[motion.usable]).all()


def test_bin_means_pass_the_first_stages_unchanged(tmp_path):
    nu = np.random.default_rng(9).normal(size=(30, 6))
    run, chain = recording(wandering(9, 30), time=0.15 * np.arange(30), nu=nu), SignalSettings()
    resampled(run, chain).write(tmp_path / "a.npz")
    filtered(read_stage(tmp_path / "a.npz"), chain).write(tmp_path / "b.npz")
    motion = differentiated(read_stage(tmp_path / "b.npz"), chain)
    assert motion.binned
    np.testing.assert_array_equal(motion.nu, nu)
