"""Laws of marks and folds."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rovsim.core.axes import AXES
from rovsim.core.errors import BadInput
from rovsim.core.run import Commands, RunInfo, Site
from rovsim.evaluation.held_out.folds import relabel_split
from rovsim.evaluation.held_out.published_errors import METRICS, Published, compare_published, stand
from rovsim.learning.pairs import training_runs
from rovsim.measurement.signals.motion import Poses
from rovsim.results.base import ByAxis
from rovsim.results.comparison import Comparison, Metrics, ModelErrors, RunErrors

errors = st.floats(1e-3, 1e3)
six = st.lists(errors, min_size=6, max_size=6)


def compared(still, ours):
    """`comparison.json` of run r, its errors (6,) the same in every metric."""

    def entry(values):
        by_axis = ByAxis.of(np.array(values))
        errors = Metrics(
            **dict.fromkeys(METRICS, by_axis), position_rmse_m=None, attitude_rmse_rad=None
        )
        run = RunErrors(split="test", control="6dof", open_loop=errors, windows={})
        return ModelErrors(runs={"r": run})

    return {"r": Comparison(models={"zero_acceleration": entry(still), "ours": entry(ours)})}


def table(*models):
    """Published errors (6,) of models on run r."""
    return [
        Published("r", "", str(k), axis, dict.fromkeys(METRICS, value))
        for k, values in enumerate(models)
        for axis, value in zip(AXES, values, strict=True)
    ]


@given(six, six, six, six, st.lists(st.booleans(), min_size=6, max_size=6))
def test_no_mark_is_above_all_that_is_known(one, two, still, ours, moved):
    found = compare_published(
        table(one, two), compared(still, ours), {"r": dict(zip(AXES, moved, strict=True))}
    )
    for cell in found.cells:
        k = AXES.index(cell.axis)
        assert min(one[k], two[k]) <= cell.mark <= max(min(one[k], two[k]), still[k])
        assert moved[k] <= (cell.mark == min(one[k], two[k]))
        assert cell.ratios["ours"] * cell.mark == pytest.approx(ours[k])


@given(six, six, six, six, st.floats(0.1, 10.0))
def test_the_mean_scales_with_the_errors(one, two, still, ours, factor):
    moved = {"r": dict.fromkeys(AXES, True)}
    means = [
        compare_published(table(one, two), compared(still, [s * x for x in ours]), moved).models[
            "ours"
        ]
        for s in (1.0, factor)
    ]
    assert means[1].geometric_mean == pytest.approx(factor * means[0].geometric_mean)


@given(st.lists(st.one_of(st.none(), errors), min_size=1))
def test_below_and_not_below_are_all_cells(ratios):
    found = stand(ratios)
    assert found.cells == len(ratios)
    assert found.below == sum(r is not None and r < 1 for r in ratios)
    assert (found.geometric_mean is None) == (None in ratios)


def run(name, control, split):
    """A run too short for anything but its name."""
    commands = Commands(np.zeros(1), np.zeros((1, 6)), "demand")
    eta = np.eye(7)[3:4]
    info = RunInfo(name, control, split)
    return Poses(info, Site.unknown(), np.zeros(1), eta, np.ones(1, bool), commands)


splits = st.sampled_from(["train", "test"])
controls = st.sampled_from(["3dof", "6dof"])


@given(st.lists(st.tuples(controls, splits), min_size=2, max_size=6), st.data())
def test_whoever_learns_in_a_fold_never_sees_the_run_held_out(kinds, data):
    runs = [run(str(k), control, split) for k, (control, split) in enumerate(kinds)]
    test = data.draw(st.sampled_from([one.run.id for one in runs]))
    fold = [relabel_split(one, test) for one in runs]
    assert [one.run.id for one in fold if one.run.split == "test"] == [test]
    assert {one.run.id for one in training_runs(fold, "all")} == {r.run.id for r in runs} - {test}
    for control in ("3dof", "6dof"):
        wanted = {r.run.id for r in runs if r.run.control == control} - {test}
        if wanted:
            assert {one.run.id for one in training_runs(fold, control)} == wanted
        else:
            with pytest.raises(BadInput, match="no train run"):
                list(training_runs(fold, control))
    for before, after in zip(runs, fold, strict=True):
        assert after.eta is before.eta
        assert (after.run.id, after.run.control) == (before.run.id, before.run.control)
