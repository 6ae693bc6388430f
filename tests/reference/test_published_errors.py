"""Marks of a tiny published table, worked out by hand."""

import numpy as np
import pytest

from rovsim.core.axes import AXES
from rovsim.core.errors import BadInput
from rovsim.core.run import Commands
from rovsim.evaluation.held_out.published_errors import (
    compare_published,
    find_demanded,
    read_published,
)
from rovsim.results.comparison import Comparison

HEAD = "run,control,variant,model,axis,acceleration_rmse,velocity_mae,velocity_rmse"
LINES = [
    HEAD,
    "one,3dof,small,zero_shot,surge,0.40,0.20,0.30",
    "one,3dof,small,knn,surge,0.20,0.30,0.50",
    "one,3dof,large,knn,surge,0.30,0.10,0.60",
    "one,3dof,small,zero_shot,roll,0.50,0.04,0.05",
    "two,6dof,small,zero_shot,surge,1.00,1.00,1.00",
]


@pytest.fixture
def published(tmp_path):
    path = tmp_path / "published.csv"
    path.write_text("\n".join(LINES) + "\n")
    return read_published(path)


def comparison(run, **models):
    """`comparison.json` of one run: by model its errors (acceleration RMSE, MAE, RMSE), by axis."""

    def metrics(axes):
        values = {axis: axes.get(axis, (None, None, None)) for axis in AXES}
        names = ("acceleration_rmse", "velocity_mae", "velocity_rmse")
        found = {name: {a: v[k] for a, v in values.items()} for k, name in enumerate(names)}
        return found | {"position_rmse_m": None, "attitude_rmse_rad": None}

    entry = {"split": "test", "control": "3dof", "windows": {}}
    runs = {n: {"runs": {run: entry | {"open_loop": metrics(a)}}} for n, a in models.items()}
    return Comparison.model_validate({"models": runs})


def example():
    """Run one with surge demanded and roll not, run three without published numbers."""
    still = {"surge": (0.8, 0.4, 0.5), "roll": (0.2, 0.06, 0.08)}
    ours = {"surge": (0.1, 0.15, 0.3), "roll": (0.25, 0.03, 0.04)}
    one = comparison("one", zero_acceleration=still, ours=ours, lost={"surge": (0.1, 0.05, 0.1)})
    return {"one": one, "three": comparison("three", zero_acceleration=still)}


MOVED = {"one": dict.fromkeys(AXES, False) | {"surge": True}, "three": dict.fromkeys(AXES, True)}


def test_the_mark_is_the_smallest_of_any_model_and_variant(published):
    found = compare_published(published, example(), MOVED).to_json()
    cells = {(c["axis"], c["metric"]): c for c in found["cells"]}
    assert len(cells) == len(found["cells"]) == 6
    surge = [cells["surge", m] for m in ("acceleration_rmse", "velocity_mae", "velocity_rmse")]
    assert [c["mark"] for c in surge] == [0.2, 0.1, 0.3]
    assert [(c["best"]["model"], c["best"]["variant"]) for c in surge] == [
        ("knn", "small"),
        ("knn", "large"),
        ("zero_shot", "small"),
    ]
    assert surge[1]["errors"]["published knn"] == 0.1
    assert surge[1]["ratios"]["published zero_shot"] == pytest.approx(2.0)
    assert found["runs"] == ["one"]
    assert found["without_published"] == ["three"]


def test_where_nobody_demanded_anything_staying_still_is_no_feat(published):
    found = compare_published(published, example(), MOVED).to_json()
    cells = {(c["axis"], c["metric"]): c for c in found["cells"]}
    assert cells["roll", "acceleration_rmse"]["mark"] == 0.5  # larger than 0.2 of zero acceleration
    assert cells["roll", "velocity_mae"]["mark"] == 0.06  # of zero acceleration
    assert not cells["roll", "velocity_mae"]["demanded"]


def test_standings(published):
    models = compare_published(published, example(), MOVED).to_json()["models"]
    ours = models["ours"]  # 0.1/0.2, 0.15/0.1, 0.25/0.5, 0.03/0.06
    assert (ours["cells"], ours["below"], ours["share_below"]) == (4, 3, 0.75)
    assert ours["geometric_mean"] == pytest.approx((0.5 * 1.5 * 0.5 * 0.5) ** 0.25)
    assert ours["by_axis"]["surge"] == pytest.approx(0.75**0.5)
    assert ours["by_axis"]["yaw"] is None
    assert ours["by_metric"]["velocity_rmse"]["geometric_mean"] == pytest.approx(0.5**0.5)
    assert ours["not_below"] == [
        {"run": "one", "axis": "surge", "metric": "velocity_mae", "ratio": pytest.approx(1.5)}
    ]


def test_a_model_that_diverged_is_not_below_and_has_no_mean(published):
    lost = compare_published(published, example(), MOVED).to_json()["models"]["lost"]
    assert (lost["cells"], lost["below"], lost["geometric_mean"]) == (4, 2, None)
    assert [c["ratio"] for c in lost["not_below"]] == [None, None]


def test_demand_that_never_moves_is_told_from_demand_that_does():
    value = np.zeros((3, 6))
    value[:, 0] = 0.25  # held all the time
    value[1, 5] = 0.1
    moved = find_demanded(Commands(np.arange(3.0), value, "demand"))
    assert moved == dict.fromkeys(AXES, False) | {"yaw": True}
    assert all(find_demanded(Commands(np.arange(3.0), np.zeros((3, 8)), "thruster")).values())


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ([HEAD.replace("axis", "axes")], "no column axis"),
        ([HEAD, "one,3dof,small,knn,surge,0.2,0.3"], "line 2: surge, 0.2, 0.3, None"),
        ([*LINES, "one,3dof,small,knn,surg,0.2,0.3,0.4"], "line 7: surg"),
        ([HEAD, "one,3dof,small,knn,surge,0.2,0,0.4"], "line 2"),
        ([HEAD, "one,3dof,small,knn,surge,0.2,nan,0.4"], "line 2"),
    ],
)
def test_a_bad_table_is_one_message(tmp_path, lines, message):
    path = tmp_path / "published.csv"
    path.write_text("\n".join(lines) + "\n")
    with pytest.raises(BadInput, match=message):
        read_published(path)


def test_nothing_published_for_any_run_is_an_error(published):
    with pytest.raises(BadInput, match=r"nothing is published for the runs three.*one, two"):
        compare_published(published, {"three": example()["three"]}, MOVED)
