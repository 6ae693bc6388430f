"""What every figure promises; a new figure is found here by itself."""

import copy
import inspect
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from dataclasses import fields, replace
from itertools import pairwise
from multiprocessing import get_context
from threading import Event, Timer

import numpy as np
import pytest
from matplotlib.patches import Rectangle

from rovsim.core.errors import BadInput
from rovsim.reporting.charts import chart_conditions, chart_ladder, find_varying_shares
from rovsim.reporting.figures import SECTIONS, find_figure, list_figures, read_kind, refuse_unknown
from rovsim.reporting.figures.palette import FAMILIES
from rovsim.reporting.figures.series import averaged
from rovsim.reporting.figures.style import save, styled
from rovsim.reporting.html.folder import draw
from rovsim.reporting.report_data import (
    ReportData,
    RunData,
    list_run_figures,
    list_study_figures,
    read_by,
)
from rovsim.results.comparison import Comparison
from rovsim.results.error_conditions import ErrorConditions
from rovsim.results.growth import Growth
from rovsim.results.ladder import Ladder
from rovsim.results.published_errors import PublishedErrors
from rovsim.results.timing import Timing
from synthetic_study import study

EVERY = pytest.mark.parametrize("name", sorted(list_figures()))


def drawn(name, content):
    """The figure, from the parts of a study that its `draw` asks for."""
    wanted = find_figure(name)
    return wanted.draw(**{key: value for key, value in content.items() if key in wanted.takes})


def unfolded(content):
    """The same with all arrays in sight."""
    return {**content, "budget": vars(content["budget"])}


@styled()
def show(figure):
    """Lay it out and draw it, into no file."""
    figure.draw_without_rendering()


@EVERY
def test_it_is_drawn_the_same_every_time_and_changes_nothing(name, tmp_path):
    content = study()
    before = copy.deepcopy(unfolded(content))
    for folder in ("one", "two"):
        save(drawn(name, content), tmp_path / folder, name)
    for ending in ("pdf", "png"):
        one, two = (tmp_path / folder / f"{name}.{ending}" for folder in ("one", "two"))
        assert len(one.read_bytes()) > 3000
        assert one.read_bytes() == two.read_bytes()
    np.testing.assert_equal(unfolded(content), before)


@EVERY
def test_it_says_where_it_belongs_and_what_it_shows(name):
    found = find_figure(name)
    assert found.section in SECTIONS
    assert found.caption.endswith(".")
    assert (found in list_study_figures()) != (found in list_run_figures())
    known = {field.name for field in fields(ReportData)}
    of_study = found in list_study_figures()
    assert set(found.needs) <= ({*known, *vars(ReportData)} if of_study else vars(RunData).keys())
    # else the workflow would not know what to read for it
    assert not of_study or known & set(read_by(found))


@EVERY
def test_what_is_read_of_it_is_what_it_declares(name):
    found, module = find_figure(name), sys.modules[find_figure(name).draw.__module__]
    assert (found.section, found.caption) == (module.SECTION, module.CAPTION)
    assert found.place == getattr(module, "PLACE", 1)
    parameters = inspect.signature(found.draw).parameters.values()
    assert found.takes == tuple(one.name for one in parameters)
    assert found.needs == tuple(one.name for one in parameters if one.default is one.empty)


FIGURE = """
SECTION = "ladder"
CAPTION = "What it shows."

def draw(*, ladder):
    pass
"""
MISTAKES = {  # what is replaced, by what: what the message says
    ('SECTION = "ladder"', ""): "there is no SECTION.*one of verdict",
    ('"ladder"', '"latter"'): "SECTION is 'latter'",
    ('"What it shows."', "words()"): "CAPTION is no plain constant",
    ('CAPTION = "What it shows."', ""): "there is no CAPTION",
    ('CAPTION = "What', 'PLACE = "1"; CAPTION = "What'): "PLACE is '1'",
    ("*, ladder", "ladder"): "by place",
    ("def draw", "draw = 1 +"): "line 5",
    ("def draw(*, ladder):\n    pass", "draw = dict"): "CAPTION and SECTION without a 'draw'",
    ('SECTION = "ladder"', "SECTION: str"): "SECTION is no plain constant",
    ("What it shows", "\ufeffWhat\0"): "null bytes",
}


@pytest.mark.parametrize("change", MISTAKES)
def test_a_mistake_in_a_new_one_names_its_file(change, tmp_path):
    path = tmp_path / "new.py"
    path.write_text(FIGURE)
    assert read_kind(path).needs == ("ladder",)
    assert change[0] in FIGURE
    path.write_text(FIGURE.replace(*change))
    with pytest.raises(BadInput, match=f"new.py.*{MISTAKES[change]}"):
        read_kind(path)
    with pytest.raises(BadInput, match=r"ladder.py: 'draw' asks for latter\. Expected .*ladder"):
        refuse_unknown(replace(find_figure("ladder"), needs=("latter",)), ["ladder"])


def test_a_list_of_them_takes_no_matplotlib():
    read = "import sys, rovsim.reporting.figures as f; f.list_figures()"
    look = f"{read}; print('matplotlib' in sys.modules)"
    assert subprocess.check_output([sys.executable, "-c", look], text=True).split() == ["False"]


@EVERY
@pytest.mark.parametrize("models", [("nominal",), ("nominal", "a_model of mine")])
def test_it_takes_any_models(name, models):
    show(drawn(name, study(models=models)))


EMPTY = {
    "comparison": Comparison(models={}),
    "growth": Growth(models={}),
    "ladder": Ladder(steps=()),
    "timing": Timing(inference={}),
    "quality": {},
    "where": ErrorConditions(models={}),
    "disturbance": None,
    "published_errors": PublishedErrors(runs=(), without_published=(), models={}, cells=()),
    "diagnosis": study()["diagnosis"].model_copy(update={"selected": (), "ranking": ()}),
}


@EVERY
def test_nothing_measured_is_said_not_crashed(name):
    content = study()
    content |= EMPTY
    for key in ("nu", "nu_dot", "position"):
        content[key] = np.full_like(content[key], np.nan)
    budget = content["budget"]
    content["budget"] = replace(budget, parts={}, missing=np.full_like(budget.missing, np.nan))
    show(drawn(name, content))


def test_of_many_runs_those_are_shown_that_lack_most():
    one = next(iter(study()["quality"].values()))
    found = {f"r{k}": one.model_copy(update={"not_found": k}) for k in range(100)}
    found["r3"] = one.model_copy(update={"unusable": "it does not move"})
    shown = [
        text.get_text()
        for text in drawn("excitation", {"quality": found}).axes[0].get_yticklabels()
    ]
    assert shown[::-1] == ["r3", *(f"r{k}" for k in range(61, 100))]


def test_the_bars_of_the_ladder_are_its_numbers():
    content = study()
    steps = {s.model: s.windows_2s for s in content["ladder"].models}
    bars = [p for p in drawn("ladder", content).axes[0].patches if isinstance(p, Rectangle)]
    assert [bar.get_width() for bar in bars] == pytest.approx(list(steps.values()))
    assert all(bar.get_x() == 0 for bar in bars)


def test_a_baseline_far_above_all_models_is_cut_so_that_they_can_be_told_apart():
    content = study()
    far = {"zero_acceleration": {"windows_2s": 50.0}}
    steps = [s.model_copy(update=far.get(s.model, {})) for s in content["ladder"].steps]
    axes = drawn("ladder", {"ladder": Ladder(steps=steps)}).axes[0]
    assert axes.get_xlim()[1] < 2.0
    assert "50.0 →" in [text.get_text() for text in axes.texts]


def test_the_ranking_shows_each_share_and_what_the_selected_add():
    found = study()["diagnosis"]
    axes = drawn("ranking", {"diagnosis": found}).axes[0]
    names = [label.get_text() for label in axes.get_yticklabels()]
    assert names[:2] == ["thruster_lag", "quadratic_damping"]
    widths = [bar.get_width() for bar in axes.patches]
    assert widths == pytest.approx([0.0, 38.0, 36.0, 18.0])  # less than 1 % is left out
    assert [line.get_xdata()[0] for line in axes.lines] == pytest.approx([42.0, 36.0])
    assert 42.0 < axes.get_xlim()[1] < 60.0


def test_a_ranking_of_effects_that_remove_nothing_says_so():
    found = study()["diagnosis"]
    useless = [r.model_copy(update={"error_reduction": 0.002}) for r in found.ranking]
    none = found.model_copy(update={"selected": (), "ranking": tuple(useless)})
    axes = drawn("ranking", {"diagnosis": none}).axes[0]
    assert not axes.patches
    assert [text.get_text() for text in axes.texts] == ["no effect removes 1 % by itself"]


def test_the_ranking_shows_a_share_beyond_its_ends_as_an_arrow_there():
    found = study()["diagnosis"]
    first, *rest = found.selected
    far = found.model_copy(
        update={"selected": (first.model_copy(update={"error_reduction": -2.0}), *rest)}
    )
    figure = drawn("ranking", {"diagnosis": far})
    mark = next(line for line in figure.axes[0].lines if line.get_marker() == "<")
    assert mark.get_xdata()[0] == -20.0
    assert any(text.get_text().startswith("−200") for text in figure.axes[0].texts)
    show(figure)  # the layout finds room


def test_the_measured_line_is_the_measurement():
    content = study()
    figure = drawn("velocities", content)
    for k, axes in enumerate(figure.axes[:6]):
        shown = np.concatenate([line.get_ydata() for line in axes.lines])
        known = content["nu"][content.get("usable", slice(None)), k]
        known = known[np.isfinite(known)]
        assert np.isin(np.round(known, 12), np.round(shown, 12)).mean() > 0.99


def test_curves_of_the_error_by_condition_are_the_bin_means():
    content = study(models=("nominal",))
    table = content["where"].models["nominal"].axes["surge"]["surge speed"]
    panel = drawn("where", content).axes[0]
    assert panel.get_title().startswith("surge speed")
    judged = np.array(table.judged)
    curve = max(panel.lines, key=lambda line: len(line.get_ydata()))
    assert list(curve.get_ydata()) == pytest.approx(np.array(table.mean)[judged].tolist())


def wandering(content):
    """Conditions of models of which the one before the last moved three times as far in surge."""
    models = dict(content["where"].models)
    name = list(models)[-2]
    wider = {
        condition: one.model_copy(
            update={key: [3.0 * x for x in getattr(one, key)] for key in ("center", "edges")}
        )
        for condition, one in models[name].axes["surge"].items()
    }
    models[name] = models[name].model_copy(update={"axes": models[name].axes | {"surge": wider}})
    return ErrorConditions(models=models)


def test_curves_of_all_models_are_inside_their_panels():
    for axes in drawn("where", {"where": wandering(study(duration=120.0))}).axes[:3]:
        curves = [line.get_xdata() for line in axes.lines if len(line.get_xdata()) > 2]
        assert axes.get_xlim()[0] < min(map(min, curves))
        assert max(map(max, curves)) < axes.get_xlim()[1]


@styled()
def test_titles_of_panels_do_not_meet_however_many_models_there_are():
    models = {
        name: one.model_copy(
            update={
                "axes": {
                    axis: {
                        condition.replace("yaw rate", "distance to the nearest wall").replace(
                            "surge thrust", "change of surge thrust"
                        ): table
                        for condition, table in tables.items()
                    }
                    for axis, tables in one.axes.items()
                }
            }
        )
        for name, one in study()["where"].models.items()
    }
    figure = drawn("where", {"where": ErrorConditions(models=models)})
    figure.draw_without_rendering()
    for row in np.reshape(figure.axes, (-1, 3)):
        boxes = [axes.title.get_window_extent() for axes in row]
        assert all(one.x1 < other.x0 for one, other in pairwise(boxes))


def test_a_model_alone_is_not_divided_by_itself():
    comparison = study()["comparison"]
    alone = comparison.model_copy(update={"models": {"nominal": comparison.models["nominal"]}})
    labels = [
        [axes.get_ylabel() for axes in find_figure("error_by_axis").draw(comparison=one).axes]
        for one in (alone, comparison)
    ]
    assert [len(one) for one in labels] == [4, 8]
    assert "error / nominal (–)" not in labels[0]


def test_a_constant_error_is_in_its_own_row_and_varies_with_nothing():
    """As a vehicle that is too light: it errs at every speed and depth."""
    one = study()["where"].models["nominal"]
    table = next(iter(one.axes["surge"].values()))
    shares = {"throughout": 0.6, "surge speed": 0.62, "depth below the surface": 0.58}
    tables = {n: table.model_copy(update={"share_of_error": v}) for n, v in shares.items()}
    found = find_varying_shares(tables)
    assert found == pytest.approx(
        {"throughout": 0.6, "surge speed": 0.02, "depth below the surface": 0.0}
    )
    chart = chart_conditions(one.model_copy(update={"axes": {"heave": tables}}))
    assert chart.conditions[0] == "throughout"
    assert chart.share[:, 0].tolist() == pytest.approx([0.6, 0.02, 0.0])


def test_bars_of_a_ladder_have_the_colour_of_their_kind_and_no_hatch():
    models = ("nominal", "+thruster_lag", "+current", "+current + knn_6dof")
    looks = {bar.model: bar.look for bar in chart_ladder(study(models=models)["ladder"]).bars}
    assert set(looks.values()) <= set(FAMILIES.values())
    assert looks["+thruster_lag"] == looks["+current"] == FAMILIES["effects"]
    assert looks["+current + knn_6dof"] == FAMILIES["knn"]


def test_the_map_frames_the_findings():
    content = study(duration=120.0)
    model = list(content["where"].models.values())[-1]
    framed = [p for p in drawn("where_map", content).axes[0].patches if isinstance(p, Rectangle)]
    assert len(framed) == len(model.findings) > 0


def test_forces_and_moments_have_spectra_of_their_own():
    force = study()["disturbance"]
    density = np.array(force.spectrum.density)
    density[:, [2, 5]] = density[:, [1]] * [2.0, 3.0]
    louder = force.spectrum.model_copy(update={"density": tuple(map(tuple, density))})
    more = force.model_copy(update={"axes": ("sway", "heave", "yaw"), "spectrum": louder})
    axes = drawn("disturbance", {"disturbance": more}).axes
    below = [one for one in axes if one.get_xlabel() == "frequency (Hz)"]
    assert [one.get_ylabel() for one in below] == ["power (N²/Hz)", "power (N² m²/Hz)"]
    lines = [line for one in below for line in one.get_lines()]
    assert [line.get_label() for line in lines] == ["sway", "heave", "yaw"]
    for line, i in zip(lines, (1, 2, 5), strict=True):
        np.testing.assert_array_equal(line.get_xdata(), force.spectrum.frequency_hz[1:])
        np.testing.assert_array_equal(line.get_ydata(), density[1:, i])


def test_runs_without_strong_moments_leave_the_panels_their_room():
    force = study()["disturbance"]
    calm = [force.runs[0].model_copy(update={"run": name}) for name in ("calm", "calmer")]
    quiet = force.model_copy(update={"runs": (*force.runs, *calm)})
    show(drawn("disturbance", {"disturbance": quiet}))  # it would warn of panels without room


def test_a_disturbance_of_an_earlier_version_is_drawn_without_a_spectrum():
    force = study()["disturbance"].model_copy(update={"spectrum": None})
    axes = drawn("disturbance", {"disturbance": force}).axes
    assert [one.get_xlabel() for one in axes[:2]] == ["x (m)", "time (s)"]
    assert not any(one.get_xlabel() == "frequency (Hz)" for one in axes)


def test_each_cell_of_the_published_figure_is_error_over_mark():
    found = study()["published_errors"]
    cells = [cell for cell in found.cells if cell.metric == "velocity_mae"]
    axes = drawn("against_published", {"published_errors": found}).axes[1]
    name = next(iter(found.models))
    expected = [min(cell.errors[name] / cell.mark, 4.0) for cell in cells]
    assert list(axes.lines[0].get_ydata()) == pytest.approx(expected)
    labels = [label.get_text() for label in axes.get_xticklabels()]
    assert labels[:6] == ["surge", "sway", "heave", "(roll)", "pitch", "yaw"]


def test_the_published_figure_shows_what_is_in_every_fold_and_stands_on_effects():
    names = ["nominal", "effects", "knn_6dof", "gp_3dof", "effects+knn_6dof", "effects+gp_3dof"]
    known = study()["published_errors"]
    cells = [
        known.cells[0].model_copy(
            update={
                "run": run,
                "metric": metric,
                "ratios": {n: 1.0 for n in names if "3dof" not in n or run == "b"},
            }
        )
        for run in "ab"
        for metric in ("acceleration_rmse", "velocity_mae")
    ]
    models = dict.fromkeys(names, known.models["nominal"])
    found = known.model_copy(update={"models": models, "cells": tuple(cells)})
    figure = drawn("against_published", {"published_errors": found})
    (legend,) = figure.legends
    shown = [text.get_text() for text in legend.get_texts()]
    assert shown == ["nominal", "nominal + effects", "effects + KNN (6-DoF)"]


def test_an_unknown_figure_names_the_nearest():
    with pytest.raises(BadInput, match="Did you mean 'ladder'"):
        find_figure("lader")


def test_lines_reach_from_the_lowest_to_the_highest_run():
    content = study()
    model = content["comparison"].models["knn_6dof"]
    tests = [run for run in model.runs.values() if run.split == "test"]
    sway = [run.windows["2"].velocity_rmse["sway"] for run in tests]
    axes = drawn("error_by_axis", content).axes[0]
    ends = axes.collections[list(content["comparison"].models).index("knn_6dof")].get_segments()
    np.testing.assert_allclose(ends[1][:, 1], [min(sway), max(sway)])
    assert min(sway) < max(sway)


def test_the_whole_of_these_lines_is_inside_the_axes():
    content = study()
    for model in content["comparison"].models.values():
        run = next(run for run in model.runs.values() if run.split == "test")
        far = run.windows["2"].velocity_rmse.model_copy(update={"sway": 0.4, "yaw": 0.9})
        run.windows["2"] = run.windows["2"].model_copy(update={"velocity_rmse": far})
    for axes in drawn("error_by_axis", content).axes:
        ends = [x for lines in axes.collections for one in lines.get_segments() for x in one[:, 1]]
        assert max(ends, default=0.0) < axes.get_ylim()[1]


def test_noise_does_not_hide_the_residual():
    content = study()
    noise = np.random.default_rng(0).normal(0.0, 3.0, content["nu_dot"].shape)
    content["predicted_nu_dot"] = {"nominal": content["nu_dot"] - 1.0}
    content["nu_dot"] = content["nu_dot"] + noise
    (line,) = [
        one for one in drawn("residual_series", content).axes[0].lines if len(one.get_ydata()) > 99
    ]
    shown = np.asarray(line.get_ydata(), float)
    step = np.median(np.diff(content["time"]))
    assert np.nanstd(shown) < 1.5 * 3.0 / np.sqrt(0.5 / step)
    assert np.nanmean(shown) == pytest.approx(1.0, abs=0.2)


def test_a_mean_over_time_is_that_of_its_neighbours_and_gaps_stay_gaps():
    time = np.arange(8.0)
    values = np.array([1.0, 2.0, 3.0, np.nan, 5.0, 6.0, 7.0, 9.0])[:, None]
    found = averaged(time, values, 2.0)[:, 0]
    np.testing.assert_allclose(found, [1.5, 2.0, 2.5, np.nan, 5.5, 6.0, 22 / 3, 8.0])


@pytest.mark.parametrize("name", ["residual_series", "budget"])
def test_noise_on_an_axis_at_rest_is_as_small_as_it_is(name):
    figure = drawn(name, study())
    scales = [axes.get_ylim() for axes in figure.axes]
    assert len(set(scales[:3])) == len(set(scales[3:])) == 1
    assert "share their scale" in figure._supxlabel.get_text()


def test_two_processes_draw_what_one_does(tmp_path):
    content = study()
    known = ReportData(**{name: content[name] for name in ("where", "quality", "comparison")})
    alone = draw(tmp_path / "alone", known)
    with ProcessPoolExecutor(1, get_context("spawn")) as other:
        together = draw(tmp_path / "together", known, other=other)
    assert len(alone) > 2
    assert [one.wanted for one in together] == [one.wanted for one in alone]
    assert [one.picture.png for one in together] == [one.picture.png for one in alone]


def test_a_folder_that_an_error_takes_away_stays_away(tmp_path, monkeypatch):
    content = study()
    known = ReportData(**{name: content[name] for name in ("where", "quality", "comparison")})
    first, *others = known.figures
    slow = Event()

    def draw_selected(out, figure, *rest):
        if figure == others[0]:
            slow.wait(5)
            (out / "late").write_text("")
        elif figure != first:
            Timer(0.2, slow.set).start()
            raise BadInput("none", where="a figure", expected="one", remedy="")
        return figure

    monkeypatch.setattr("rovsim.reporting.html.folder.draw_selected", draw_selected)
    with ThreadPoolExecutor(1) as other:
        with pytest.raises(BadInput):
            draw(tmp_path, known, other=other)
        assert (tmp_path / "late").exists()  # written before the error was told
