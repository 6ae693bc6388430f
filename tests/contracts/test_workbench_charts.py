"""What the curves and the tank of the workbench show."""

import csv
from io import StringIO

import numpy as np

from rovsim.apps.workbench import charts, divergence, ladder, path
from rovsim.apps.workbench.charts import Panel
from rovsim.apps.workbench.draft import Draft
from rovsim.apps.workbench.traces import beside, panels
from rovsim.core.rotations import short_way, to_euler
from rovsim.dynamics.catalogue import built_in
from rovsim.results.ladder import Ladder, LadderStep
from rovsim.simulation.bands import Band


def test_a_replay_that_diverges_is_told_and_cut_beside_the_measurement(bench):
    draft = Draft(bench.base, None, built_in())
    draft.tick("quadratic_damping", True)
    draft.move("quadratic_damping", "surge", -230.0)
    motion = bench.data.motions["3dof-1"]
    wild = bench.replays.prediction(draft.model(), "3dof-1", 2.0)
    at = divergence.find_divergence(motion.time, wild)
    assert 0.0 < at < motion.time[-1] - motion.time[0]
    said = divergence.tell_divergence(motion.time, {"new": wild})
    assert said.startswith(f"The replay of new diverges after {at:.1f} s;")
    for quantity in ("nu", "nu_dot", "eta"):
        shown = panels(motion, {"new": wild}, ["surge", "yaw"], quantity)
        size = np.nanmax(np.abs(shown[0].curves["measured"]))
        assert np.nanmax(np.abs(shown[0].curves["new"])) < 5.0 * size
    lost = bench.replays.prediction(draft.model(), "3dof-1", None)
    assert "nothing of it can be shown" in divergence.tell_divergence(motion.time, {"new": lost})
    calm = bench.replays.prediction(bench.base, "3dof-1", 2.0)
    assert divergence.tell_divergence(motion.time, {"nominal": calm}) == ""


def test_a_pose_is_shown_in_the_tank_and_turns_the_short_way(bench):
    motion = bench.data.motions["6dof-1"]
    shown = panels(
        motion, {"m": bench.replays.prediction(bench.base, "6dof-1", 2.0)}, ["heave", "yaw"], "eta"
    )
    titles = ["down", "down: measured − model", "yaw", "yaw: measured − model"]
    assert [panel.title for panel in shown] == titles
    usable = motion.usable
    np.testing.assert_allclose(shown[0].curves["measured"][usable], motion.eta[usable, 2])
    missed = shown[3].curves["m"]
    assert np.nanmax(np.abs(missed)) <= np.pi


def test_under_each_axis_is_what_the_commands_push_along_it(bench):
    motion = bench.data.motions["6dof-1"]
    thrust = bench.replays.thrust(bench.base, "6dof-1")
    assert thrust.shape == (len(motion.time), 6)
    shown = panels(motion, {}, ["sway", "yaw"], "nu", thrust)
    assert [(panel.title, panel.unit) for panel in shown[2::3]] == [
        ("sway: thrust by the commands", "N"),
        ("yaw: thrust by the commands", "N m"),
    ]
    np.testing.assert_array_equal(shown[5].curves["commanded"], thrust[:, 5])


def test_a_band_lies_about_its_curve_and_about_the_difference(bench):
    motion, predicted = (
        bench.data.motions["6dof-1"],
        bench.replays.prediction(bench.base, "6dof-1", 2.0),
    )
    nu, angle = predicted.nu, to_euler(predicted.eta[:, 3:])
    place = np.hstack([predicted.eta[:, :3], angle])
    band = Band(np.stack([nu - 0.1, nu + 0.3]), np.stack([place - 0.1, place + 0.3]))
    for quantity in ("nu", "eta"):
        shown = panels(motion, {"m": predicted}, ["yaw"], quantity, bands={"m": band})
        low, high = shown[1].bands["m"]
        known = np.isfinite(low)
        assert known.sum() > 100
        np.testing.assert_allclose(short_way(low[known]), -0.1, atol=1e-9)
        np.testing.assert_allclose(high - low, np.where(known, 0.4, np.nan), atol=1e-9)
    low, wide = charts.series_data(motion.time, shown[:1], ("measured", "m"))
    assert (low["id"], wide["id"]) == (
        "0/m/low end of the band",
        "0/m/width of the band",
    )
    options = charts.time_series(motion.time, shown, charts.styles(["measured", "m"]))
    drawn = {one["id"]: one for one in options["series"]}
    assert drawn[low["id"]]["stack"] == drawn[wide["id"]]["stack"] != drawn["0/m"].get("stack")
    assert (
        drawn[low["id"]]["areaStyle"]["opacity"] == 0.0 < drawn[wide["id"]]["areaStyle"]["opacity"]
    )


def test_a_path_is_drawn_through_its_points_and_keeps_its_gaps():
    time = np.linspace(0.0, 10.0, 1001)
    points = np.stack([np.cos(time), np.sin(time), 0.1 * time], axis=1)
    curves = np.array(path.bends(np.where(time[:, None] > 5.0, np.nan, points)))
    assert 0.4 * path.MAX_CURVES < len(curves) <= 0.5 * path.MAX_CURVES
    middle = 0.25 * curves[:, 0] + 0.5 * curves[:, 1] + 0.25 * curves[:, 2]
    for drawn in (curves[:, 0], middle, curves[:, 2]):
        away = np.linalg.norm(drawn[:, None] - points, axis=2).min(axis=1)
        np.testing.assert_allclose(away, 0.0, atol=1e-12)
    np.testing.assert_array_equal(curves[1:, 0], curves[:-1, 2])


def test_the_tank_is_named_north_east_and_down_in_metres():
    tank = np.array([[0.0, 10.0], [-5.0, 0.5], [0.0, 3.0]])  # NED
    low, high = path.room(np.zeros((1, 3)), tank)
    assert path.directions(low, high) == {
        "north 0 to 10 m": [10.0, 5.0, 0.0],
        "east −5 to 0.5 m": [0.0, -0.5, 0.0],
        "down 0 to 3 m": [0.0, -0.5, -3.0],
    }


def test_a_replay_that_leaves_the_tank_is_told():
    time = np.linspace(100.0, 110.0, 11)
    tank = np.array([[0.0, 10.0], [np.nan, np.nan], [0.0, 3.0]])
    still = np.tile([5.0, 0.0, 1.0], (11, 1))
    flown = still + np.outer(time - 100.0, [0.0, -9.0, 0.5])  # no wall is known in the west
    paths = {"measured": flown, "lost": flown, "good": still}
    assert path.tell_leaving(time, paths, tank) == [
        "The replay of lost leaves the tank after 5.0 s."
    ]


def test_a_path_is_saved_by_run_model_and_direction():
    time = np.array([0.0, 0.5])
    paths = {"measured": np.array([[1.0, 2.0, 3.0], [np.nan] * 3]), "a, b": np.ones((2, 3))}
    head, *rows = csv.reader(StringIO(path.path_table("6dof-1", time, paths)))
    assert head[:2] == ["time (s)", "6dof-1 measured, north (m)"]
    assert head[-1] == "6dof-1 a, b, down (m)"
    assert rows == [["0", "1", "2", "3", "1", "1", "1"], ["0.5", "", "", "", "1", "1", "1"]]


def test_columns_of_a_table_say_run_axis_quantity_and_unit(bench):
    predicted = bench.replays.prediction(bench.base, "6dof-1", 2.0)
    band = Band(np.stack([predicted.nu, predicted.nu]), np.zeros((2, len(predicted.nu), 6)))
    motion = bench.data.motions["6dof-1"]
    thrust = bench.replays.thrust(bench.base, "6dof-1")
    shown = panels(motion, {"m": predicted}, ["yaw"], "nu", thrust, {"m": band})
    push = bench.replays.thrust(bench.base, "3dof-1")
    other = panels(bench.data.motions["3dof-1"], {}, ["yaw"], "nu", push)
    both = beside((motion, shown), [(bench.data.motions["3dof-1"], other)])
    named = charts.columns(both)
    assert named["x"] == "time (s)"
    assert {
        "0/m": "6dof-1 yaw velocity, m (rad/s)",
        "0/m/width of the band": "6dof-1 yaw velocity, m, width of the band (rad/s)",
        "0/measured, 3dof-1": "3dof-1 yaw velocity, measured (rad/s)",
        "1/m": "6dof-1 yaw velocity, measured − m (rad/s)",
        "2/commanded": "6dof-1 yaw thrust, commanded (N m)",
    }.items() <= named["curves"].items()
    ids = {one["id"] for one in charts.series_data(motion.time, both)}
    assert set(named["curves"]) == ids


def test_the_room_is_the_tank_and_where_that_is_unknown_what_was_seen():
    seen = np.array([[0.5, 1.0, -1.0], [np.nan] * 3, [1.5, 2.0, -2.0]])
    tank = np.array([[0.0, 3.0], [np.nan, np.nan], [0.0, 4.0]])  # NED
    low, high = path.room(seen, tank)
    np.testing.assert_array_equal(low, [0.0, 1.0, -4.0])
    np.testing.assert_array_equal(high, [3.0, 2.0, 0.0])


def test_whatever_a_model_is_called_its_new_curve_travels_and_the_measured_one_stays():
    time = np.arange(3.0)
    shown = [Panel("surge", "m/s", {"measured": time, "m": time, "sure": time})]
    sent = [one["id"] for one in charts.series_data(time, shown, ("measured",))]
    assert sent == ["0/m", "0/sure"]


def test_curves_are_thinned_and_keep_their_gaps():
    time = np.linspace(0, 60, 6001)
    values = np.where(time > 30, np.nan, time)
    found = np.array(charts.points(time, values))
    assert len(found) <= 2 * charts.MAX_POINTS
    np.testing.assert_array_equal(np.isnan(found[:, 1]), found[:, 0] > 30)


STEPS = {"zero_acceleration": 1.0, "nominal": 0.2, "+thruster_lag": 0.05, "noise_floor": 0.0442}


def a_ladder(**errors):
    steps = (STEPS | errors).items()
    return Ladder(steps=tuple(LadderStep(model=name, windows_2s=error) for name, error in steps))


def test_the_line_of_the_noise_floor_stands_where_its_number_says():
    line = ladder.chart_of(a_ladder())["series"][0]["markLine"]
    assert line["data"] == [{"xAxis": 0.0442}]
    assert line["precision"] == -1  # ECharts' own would draw it at 0.04
    assert line["label"]["formatter"] == "noise floor 0.0442"


def test_a_baseline_far_above_all_models_is_cut_on_the_screen_as_on_paper():
    shown = ladder.chart_of(a_ladder())
    assert 0.2 < shown["xAxis"]["max"] < 0.25
    first, second, _ = shown["series"][0]["data"]
    assert first["value"] == 1.0  # so says the CSV
    assert (first["label"]["formatter"], first["label"]["position"]) == ("1.00 →", "insideRight")
    assert (second["label"]["formatter"], second["label"]["position"]) == ("0.200", "right")
    near = ladder.chart_of(a_ladder(zero_acceleration=0.3))
    assert near["xAxis"]["max"] > 0.3
    assert near["series"][0]["data"][0]["label"]["position"] == "right"


def test_measures_of_the_ladder_stand_under_headings_of_their_own(monkeypatch):
    told = []
    monkeypatch.setattr(ladder, "table", lambda *given: told.extend(given))
    ladder._table(a_ladder())
    _, heads, rows, groups = told
    assert groups == [("in standard deviations", 1), ("mean absolute error of the velocity", 6)]
    assert heads[:3] == ["model", "2 s error", "surge (m/s)"]
    assert [len(cells) for _, cells in rows] == [len(heads) - 1] * 4


def test_curves_are_called_as_their_models_are_elsewhere_and_keep_the_file_s_name_in_tables():
    time = np.arange(3.0)
    curves = ("measured", "knn_6dof", "knn_6dof, 3dof-1", "a, b", "effects+gp_3dof")
    shown = [Panel("surge", "m/s", dict.fromkeys(curves, time), about=dict.fromkeys(curves, "x"))]
    series = charts.time_series(time, shown, charts.styles(curves))["series"]
    assert {one["id"]: one["name"] for one in series if "name" in one} == {
        "0/measured": "measured",
        "0/knn_6dof": "KNN (6-DoF)",
        "0/knn_6dof, 3dof-1": "KNN (6-DoF), 3dof-1",
        "0/a, b": "a, b",
        "0/effects+gp_3dof": "effects + GP (3-DoF)",
    }
    assert set(charts.columns(shown)["curves"]) == {f"0/{name}" for name in curves}


def test_a_replay_is_told_of_under_the_name_that_its_model_has_elsewhere():
    time, tank = np.arange(3.0), np.array([[0.0, 1.0]] * 3)
    out = np.tile([5.0, 0.5, 0.5], (3, 1))
    (told,) = path.tell_leaving(time, {"measured": out, "knn_6dof": out}, tank)
    assert told.startswith("The replay of KNN (6-DoF) leaves")


def test_a_room_is_seen_whole_whatever_its_shape():
    for size in ([10.0, 5.0, 3.0], [1.6, 1.6, 1.5], [1.0, 1.0, 8.0], [0.5, 20.0, 1.0]):
        low, high = np.array([2.0, -3.0, -1.0]), np.array([2.0, -3.0, -1.0]) + size
        eye = path.far_enough(low, high)
        ahead = -eye / np.linalg.norm(eye)
        right = np.cross(ahead, [0.0, 0.0, 1.0]) / np.linalg.norm(np.cross(ahead, [0.0, 0.0, 1.0]))
        above = np.cross(right, ahead)
        corners = np.array(
            np.meshgrid(*np.stack([-0.5 * high + 0.5 * low, 0.5 * high - 0.5 * low], 1))
        )
        seen = corners.reshape(3, -1).T - eye
        depth = seen @ ahead
        slope = np.tan(np.radians(0.5 * path.EYE_ANGLE_DEG))
        up, aside = np.abs(seen @ above) / depth, np.abs(seen @ right) / depth / path.ASPECT_RATIO
        assert depth.min() > 0.0
        assert 0.8 * slope < max(up.max(), aside.max()) < 0.9 * slope


def test_names_of_the_tank_hide_the_edges_behind_them():
    assert f"background: {path.PAPER_COLOR}" in path.NAME_STYLE
