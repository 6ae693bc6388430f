"""Long recordings and many runs: taken in piece by piece, they say the same."""

import weakref
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from threading import Barrier
from types import SimpleNamespace

import numpy as np
import pytest

from flown import observed
from rovsim.application.pipeline.replays import replay_and_score
from rovsim.core.array_files import read_arrays, write_arrays
from rovsim.core.bounded_cache import ReadAgain, Recent, Remade, size
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effects.clocks import ClockDrift
from rovsim.dynamics.effects.thrusters import VoltageSag
from rovsim.estimation.observer.train_runs import prepare_train
from rovsim.evaluation.error_metrics import ErrorSums, VelocityMoments, compute_metrics, subtract
from rovsim.evaluation.ladder import score_step
from rovsim.evaluation.score_collector import ScoreCollector, score_replay
from rovsim.measurement.runs import Runs
from rovsim.measurement.signals.motion import Poses
from rovsim.simulation import replay as replaying
from rovsim.simulation.drive import Drives
from rovsim.simulation.replay import replay
from rovsim.simulation.settings import ReplaySettings, SimulationSettings
from worlds import model


@pytest.fixture(scope="module")
def flown(tmp_path_factory):
    """One run of two minutes, as the observer sees it."""
    _, (run,) = observed(tmp_path_factory.mktemp("tank"), duration=120.0)
    return run


def test_the_last_values_are_kept_and_the_others_made_again():
    made = []

    def make(name):
        made.append(name)
        return np.full(100, ord(name), float)

    few = Remade("abc", make, most=2 * 800)
    assert [few[name][0] for name in "aabbccb"] == [97, 97, 98, 98, 99, 99, 98]
    assert made == ["a", "b", "c"]
    assert few["a"][0] == 97.0
    assert made == ["a", "b", "c", "a"]  # it was let go of for c
    assert (list(few), len(few), "d" in few) == (["a", "b", "c"], 3, False)
    with pytest.raises(KeyError):
        few["d"]


def test_one_value_stays_however_large_and_none_where_none_is_wanted():
    for most, again in ((1, 1), (0, 2)):
        made = []
        recent = Recent(most)
        for _ in range(2):
            recent.get("a", lambda made=made: made.append(1) or np.zeros(10))
        assert len(made) == again


def test_two_values_may_be_made_at_once_but_none_twice():
    both, recent, made = Barrier(2, timeout=20.0), Recent(1 << 20), []

    def make(name):
        made.append(name)
        both.wait()  # until the other one is being made, too
        return np.zeros(10)

    with ThreadPoolExecutor(8) as threads:
        list(threads.map(lambda name: recent.get(name, lambda: make(name)), "abababab"))
    assert sorted(made) == ["a", "b"]


def test_a_value_that_could_not_be_made_may_be_asked_for_again():
    recent = Recent()
    with pytest.raises(ZeroDivisionError):
        recent.get("a", lambda: np.zeros(1 // 0))
    assert recent.get("a", lambda: np.ones(1)) == 1.0


def test_values_of_two_kinds_share_what_is_kept():
    made = []

    def makes(kind):
        return lambda name: made.append(kind + name) or np.full(100, len(made), float)

    recent = Recent(2 * 800)
    one, two = (Remade("abc", makes(kind), recent=recent) for kind in "12")
    assert [one["a"][0], two["a"][0], one["a"][0]] == [1, 2, 1]  # no name stands for both
    two["b"]
    assert made == ["1a", "2a", "2b"]
    assert [two["a"][0], two["b"][0]] == [4, 3]  # one's last value had to make room
    assert one["a"][0] == 5


def test_a_size_counts_all_arrays(flown):
    motion = flown.motion
    arrays = (motion.time, motion.eta, motion.nu, motion.nu_dot, motion.state_nu, motion.usable)
    beside = (motion.commands.time, motion.commands.value, motion.site.tank, motion.site.axes)
    assert size(motion) == sum(x.nbytes for x in (*arrays, *beside))


def test_files_are_read_when_they_are_asked_for(tmp_path: Path):
    paths = [tmp_path / f"{k}.npz" for k in range(3)]
    for k, path in enumerate(paths[:2]):
        write_arrays(path, x=np.array(k))
    read = ReadAgain(paths, lambda path: int(read_arrays(path)["x"]))  # the third is not there
    assert (len(read), read[1], list(read[:2])) == (3, 1, [0, 1])


def test_runs_taken_in_one_by_one_score_as_one_set():
    random = np.random.default_rng(1)
    parts = [random.normal(k, 1.0 + k, size=(n, 6)) for k, n in enumerate((50, 0, 7))]
    whole = np.concatenate(parts)
    motions = [SimpleNamespace(nu=x, usable=np.ones(len(x), bool), measured=None) for x in parts]
    together = sum(map(VelocityMoments.of, motions), VelocityMoments.nothing())
    np.testing.assert_allclose(together.std, whole.std(axis=0), rtol=1e-12)
    np.testing.assert_allclose(together.mean, whole.mean(axis=0), rtol=1e-12)


def test_a_step_of_two_runs_is_that_of_all_their_samples(flown):
    motion = replace(flown.motion, run=replace(flown.motion.run, split="test"))
    halves = [motion.part(slice(0, 5000)), motion.part(slice(5000, len(motion.time)))]
    found = [replay(model(), half, SimulationSettings()) for half in halves]
    step = score_step("nominal", zip(halves, found, strict=True))
    errors = [subtract(m, r.horizons["2"]) for m, r in zip(halves, found, strict=True)]
    nu = np.concatenate([e.nu for e in errors])
    rmse = np.sqrt(np.mean(nu**2, axis=0))
    spread = np.concatenate([m.nu[m.usable] for m in halves]).std(axis=0)
    assert step.windows_2s == pytest.approx(np.mean(rmse / spread), rel=1e-12)
    assert compute_metrics(errors[0]) == ErrorSums.of(errors[0]).metrics()


def test_of_the_horizons_of_a_replay_one_is_held_and_those_that_are_kept(flown, monkeypatch):
    motion = replace(flown.motion, run=replace(flown.motion.run, split="test"))
    settings = SimulationSettings()
    whole = replay(model(), motion, settings)
    made, held, predict = [], [], replaying.predict

    def watched(*given):
        held.append(sum(one() is not None for one in made))
        found = predict(*given)
        made.append(weakref.ref(found))
        return found

    monkeypatch.setattr(replaying, "predict", watched)
    scored = ScoreCollector(["nominal"], settings.replay.longest)
    kept = replay_and_score(scored, model(), motion, settings, "2")
    assert held == [0, 0, 0, 1]  # when the open loop, 0.5, 2 and 5 s are made
    np.testing.assert_array_equal(kept.horizons["2"].nu, whole.horizons["2"].nu)
    assert scored.comparison.models["nominal"].runs["a"] == score_replay(motion, whole)


@pytest.mark.parametrize(
    "effect", [ClockDrift(rate=2e-3), VoltageSag(fraction=0.2), VoltageSag(rate=1e-3)]
)
def test_a_part_knows_where_in_the_recording_it_lies(flown, effect):
    """Clocks drift and batteries sag since the start of the recording, not of the part."""
    motion, grid = flown.motion, flown.grid
    part = motion.part(slice(6000, 9000))
    of_part = Drives(part.commands, grid[6000:9000], "held").of([model(effect)])[0]
    whole = Drives(motion.commands, grid, "held").of([model(effect)])[0]
    settled = slice(100, 2999)  # of what the propellers remember
    np.testing.assert_allclose(of_part.wrench[settled], whole.wrench[6000:8999][settled], atol=1e-9)
    assert of_part.duration == pytest.approx(whole.duration)


def test_a_part_of_a_part_is_a_part(flown):
    twice = flown.motion.part(slice(2000, 9000)).part(slice(1000, 3000))
    once = flown.motion.part(slice(3000, 5000))
    assert twice.commands.before == pytest.approx(once.commands.before)
    assert twice.commands.after == pytest.approx(once.commands.after)
    np.testing.assert_array_equal(twice.eta, once.eta)


def _runs(**motions):
    made = {name: replace(m, run=replace(m.run, id=name)) for name, m in motions.items()}
    stages = {
        name: Poses(m.run, m.site, m.time, m.eta, m.usable, m.commands) for name, m in made.items()
    }
    return Runs(made, stages, dict.fromkeys(made, "train"))


def test_of_too_much_data_the_parts_are_chosen_that_tell_something(flown):
    moving = flown.motion
    still = replace(
        moving,
        nu=0 * moving.nu,
        nu_dot=0 * moving.nu_dot,
        state_nu=0 * moving.nu,
        commands=replace(moving.commands, value=0 * moving.commands.value),
    )
    runs = _runs(still=still, moving=moving, again=still)
    all_of_it = prepare_train(runs, ReplaySettings(), built_in(), np.ones(6, bool))
    assert [r.motion for r in all_of_it.runs] == list(runs.motions.values())
    assert all_of_it.looked_at.wider == 1.0
    some = prepare_train(runs, ReplaySettings(), built_in(), np.ones(6, bool), most=125.0)
    assert [r.motion.run.id for r in some.runs] == ["moving", "moving"]
    assert some.looked_at.of == pytest.approx(360.0, abs=0.2)
    assert some.looked_at.wider == pytest.approx(np.sqrt(3.0), abs=0.01)
    used = np.concatenate([r.motion.time[r.motion.usable] for r in some.runs])
    np.testing.assert_array_equal(used, moving.time[moving.usable])
    assert some.runs[1].motion.time[0] == pytest.approx(moving.time[6000] - 5.0, abs=0.02)


def test_what_nobody_logged_is_left_out(flown):
    moving = flown.motion
    lines = (moving.commands.time < 20.0) | (moving.commands.time > 22.0)
    log = replace(
        moving.commands, time=moving.commands.time[lines], value=moving.commands.value[lines]
    )
    runs = _runs(holed=replace(moving, commands=log))
    train = prepare_train(runs, ReplaySettings(), built_in(), np.ones(6, bool))
    (run,) = train.runs
    assert train.unlogged == {"holed": pytest.approx(2.5, abs=0.05)}
    left_out = moving.time[moving.usable & ~run.motion.usable]
    assert left_out[[0, -1]] == pytest.approx([20.0, 22.5], abs=0.05)
    np.testing.assert_array_equal(np.diff(np.flatnonzero(moving.usable & ~run.motion.usable)), 1)


def test_a_part_keeps_the_line_that_holds_when_it_begins(flown):
    """A log may have a line only where commands change."""
    motion = flown.motion
    few = replace(
        motion.commands, time=np.array([0.0, 100.0]), value=motion.commands.value[[50, 90]]
    )
    part = replace(motion, commands=few).part(slice(6000, 7000))
    held = part.commands.value[np.searchsorted(part.commands.time, part.time, side="right") - 1]
    np.testing.assert_array_equal(held, np.tile(few.value[0], (1000, 1)))
