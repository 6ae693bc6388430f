"""A planted cause is found and named; noise, however long its memory, is not."""

import re
from dataclasses import replace

import numpy as np
import pytest

from rovsim.core.axes import AXES
from rovsim.core.run import Site
from rovsim.evaluation.error_conditions.bins import bin_errors, cut_bins, number_stretches
from rovsim.evaluation.error_conditions.conditions import average_blocks
from rovsim.evaluation.error_conditions.findings import explain_errors
from rovsim.evaluation.error_conditions.search import ConditionSearch
from rovsim.evaluation.error_conditions.sentences import say_findings
from rovsim.results.error_conditions import BLOCK_S
from rovsim.simulation.samples import sample_run
from rovsim.simulation.settings import SimulationSettings
from synthetic_study import driven
from worlds import at_rest, model, motion, sticks

SECONDS = 60.0
COUNT = 2 * int(SECONDS / BLOCK_S)


def noise(memory: float, seed: int) -> np.ndarray:
    """Errors (n, 6) of unit variance with that memory in s, new at the start of the second run."""
    rng = np.random.default_rng(1000 + seed)
    keep, push = np.exp(-BLOCK_S / memory) if memory else 0.0, rng.standard_normal((COUNT, 6))
    error = push.copy()
    for k in range(1, COUNT):
        if 2 * k != COUNT:
            error[k] = keep * error[k - 1] + np.sqrt(1 - keep**2) * push[k]
    return error


def named(found, name):
    return next(x for c, x in found.values.items() if c.name == name)


def planted(shape, axis="surge", seed=0, size=1.0):
    """Blocks whose error on one axis is `shape` of that axis' speed and thrust, with noise."""
    empty, k = driven(SECONDS, np.zeros((COUNT, 6)), seed), AXES.index(axis)
    speed = {"surge": "surge speed", "yaw": "yaw rate"}[axis]
    error = 0.05 * noise(1.0, seed)
    error[:, k] += size * shape(named(empty, speed), named(empty, f"{axis} thrust"))
    return replace(empty, error=error)


CAUSES = {
    "too much damping": (lambda u, t: u * np.abs(u), "surge speed", "brakes too much"),
    "too little damping": (lambda u, t: -u * np.abs(u), "surge speed", "brakes too little"),
    "weak thrusters": (lambda u, t: -0.02 * t, "surge thrust", "too strongly to its thrust"),
    "a push": (lambda u, t: 0.2 + 0 * u, "throughout", "more forward than the model"),
}


@pytest.mark.parametrize("cause", CAUSES)
@pytest.mark.parametrize("seed", range(3))
def test_a_planted_cause_is_the_first_finding(cause, seed):
    shape, condition, words = CAUSES[cause]
    world = planted(shape, seed=seed)
    found = explain_errors(world)
    first = found.findings[0]
    assert (first.axis, first.condition) == ("surge", condition)
    explained = 1 - np.mean((0.05 * noise(1.0, seed)[:, 0]) ** 2) / np.mean(world.error[:, 0] ** 2)
    # bins are steps, and seldom visited ones are not judged, so the share errs to the low side
    low = 0.3 if first.table.binning.judged.all() else 0.8
    assert explained - low < first.share_of_error < explained + 0.05
    assert words in say_findings(found)[0]
    assert f"{100 * first.share_of_error:.0f} %" in say_findings(found)[0]
    assert first.share().share_of_error == pytest.approx(first.share_of_error, abs=1e-3)


def test_what_a_constant_alone_would_explain_is_told_beside_it():
    """The figure takes a constant out: the sentence must hold both numbers."""
    explanation = explain_errors(planted(lambda u, t: 0.1 + 0.6 * u * np.abs(u)))
    first, said = explanation.findings[0], say_findings(explanation)[0]
    assert first.condition == "surge speed"
    throughout = explanation.tables["surge"]["throughout"].share
    assert throughout > 0.1
    assert f", a constant alone {100 * throughout:.0f} %." in said
    pure = say_findings(explain_errors(planted(lambda u, t: u - u.mean())))[0]
    assert "a constant alone" not in pure


def test_two_causes_are_told_one_after_the_other():
    world = planted(lambda u, t: u * np.abs(u) - 0.02 * t)
    conditions = [f.condition for f in explain_errors(world).findings]
    assert set(conditions) == {"surge speed", "surge thrust"}


@pytest.mark.parametrize("memory", [pytest.param(0.0, marks=pytest.mark.thorough), 1.0])
def test_noise_gives_no_finding_in_95_of_100_campaigns(memory):
    seeds = range(60)
    alarms = sum(bool(explain_errors(driven(SECONDS, noise(memory, s), s)).findings) for s in seeds)
    assert alarms <= 0.05 * len(seeds)


def test_a_constant_error_is_told_as_the_push_that_it_stands_for():
    M = np.diag([15.0, 20.0, 25.0, 1.0, 1.0, 2.0])
    found = explain_errors(planted(lambda u, t: 0.2 + 0 * u, size=-1.0), inertia=M)
    assert found.findings[0].push == pytest.approx(-3.0, rel=0.05)
    assert found.findings[0].share().push == pytest.approx(-3.0, rel=0.05)
    assert re.search(
        r"more backward than the model, as a push of (2\.9|3\.0|3\.1) N would make it",
        say_findings(found)[0],
    )
    found = explain_errors(planted(lambda u, t: 0.2 + 0 * u, axis="yaw"), inertia=M)
    assert re.search(r"as a push of 0\.(39|4|40|41) N m would", say_findings(found)[0])
    beside = explain_errors(planted(lambda u, t: 0.1 + 0.6 * u * np.abs(u)), inertia=M)
    assert beside.findings[0].share().push is None
    assert re.search(r"a constant alone \d+ % \(a push of [12]\.\d N\)\.", say_findings(beside)[0])


def test_a_push_holds_what_other_axes_of_the_inertia_add():
    M = np.diag([15.0, 20.0, 25.0, 1.0, 1.0, 2.0])
    M[0, 4] = M[4, 0] = 5.0
    world = planted(lambda u, t: 0.2 + 0 * u)
    error = world.error.copy()
    error[:, 4] = 0.1
    pushed = explain_errors(replace(world, error=error), inertia=M)
    surge = next(f for f in pushed.findings if f.axis == "surge")
    assert surge.push == pytest.approx(3.5, rel=0.05)
    unseen = replace(world, error=error, axes=np.array([True] * 3 + [False] * 3))
    surge = next(f for f in explain_errors(unseen, inertia=M).findings if f.axis == "surge")
    assert surge.push == pytest.approx(3.0, rel=0.05)


def test_an_adequate_model_is_told_to_be_one():
    assert (
        "No condition explains"
        in say_findings(explain_errors(driven(SECONDS, noise(1.0, 3), 3)))[0]
    )


def test_too_little_is_said_to_be_too_little():
    short = driven(2.0, noise(0.0, 0)[:8])
    assert "Too little" in say_findings(explain_errors(short))[0]


def test_an_error_too_small_to_matter_is_not_a_finding():
    world = planted(lambda u, t: 0.02 * u)
    world = replace(world, error=1e-3 * world.error)
    assert explain_errors(world).findings == []


@pytest.mark.parametrize("memory", [0.0, 1.0])
def test_standard_errors_are_true(memory):
    """Two of them hold the true mean, zero, in about 95 % of judged bins."""
    inside = []
    for seed in range(30):
        world = driven(SECONDS, noise(memory, seed), seed)
        stretch = number_stretches(world, world.error[:, 0])
        for condition, values in world.values.items():
            t = bin_errors(cut_bins(condition, values, stretch), world.error[:, 0], stretch)
            inside += (np.abs(t.mean) <= 2 * t.error)[t.binning.judged].tolist()
            assert t.binning.count.sum() == COUNT
            assert np.all(t.effective <= t.binning.count)
    assert 0.87 < np.mean(inside) < 0.98


def test_blocks_are_means_over_half_a_second():
    measured = motion(sticks(), seconds=3.0)
    measured = replace(measured, site=Site(np.array([[0, 4.0], [0, 3], [-1, 2]]), np.ones(3)))
    found = sample_run(model(), measured, SimulationSettings())
    made = average_blocks(measured, found)
    mine = found.index // 50 == 2
    np.testing.assert_allclose(made.error[2], found.a_res[mine].mean(axis=0))
    assert np.allclose(named(made, "depth below the surface"), 1.0)
    assert np.allclose(named(made, "distance to the nearest wall"), 0.0)


@pytest.mark.parametrize("force", [np.nan, np.inf, 1e300])
def test_blocks_with_an_impossible_error_are_left_out(force):
    measured = motion(sticks(), seconds=3.0)
    found = sample_run(model(), measured, SimulationSettings())
    broken, nowhere = found.a_res.copy(), np.full_like(found.a_res, force)
    broken[found.index // 50 == 2, 1] = force
    before, after, none = (
        average_blocks(measured, replace(found, a_res=error))
        for error in (found.a_res, broken, nowhere)
    )
    np.testing.assert_array_equal(after.error, np.delete(before.error, 2, axis=0))
    np.testing.assert_array_equal(after.time, np.delete(before.time, 2))
    assert explain_errors(none).blocks is None


def test_models_are_searched_on_train_runs():
    run = motion(sticks(), seconds=3.0, start=at_rest())
    train = replace(run, run=replace(run.run, id="t", split="train"))
    search = ConditionSearch(model(), ["test", "train"], SimulationSettings())
    for one in (run, train):
        search.add_run(one)
    assert search.result.runs == ("t",)
    assert ConditionSearch(model(), ["test"], SimulationSettings()).split == "test"


def test_forces_of_a_search_are_those_of_the_model():
    run = motion(np.zeros((1, 8)), seconds=40.0, start=at_rest())
    lifted = model().body.M_inv @ [0.0, 0.0, -60.0, 0.0, 0.0, 0.0]
    run = replace(run, nu_dot=run.nu_dot + lifted)
    search = ConditionSearch(model(), ["test"], SimulationSettings())
    search.add_run(run)
    heave = next(f for f in search.result.explanation.findings if f.axis == "heave")
    assert heave.condition == "throughout"
    samples = sample_run(model(), run, SimulationSettings())
    mean = average_blocks(run, samples).error.mean(axis=0)
    assert heave.push == pytest.approx(model().M[2] @ mean)
    assert heave.push < -50.0
