"""Words of the terminal, the report and the workbench: whole phrases, one name for one thing."""

import ast
import re
from pathlib import Path
from typing import get_args

import pytest
from pandas import DataFrame

from rovsim.apps import workbench
from rovsim.core.rounding import rounded
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.parameter_labels import label_parameter
from rovsim.reporting.figures import find_figure
from rovsim.reporting.figures.pooled import pool
from rovsim.reporting.html import report
from rovsim.reporting.report_data import ReportData
from rovsim.reporting.tables import Column, Table, tabulate_ladder
from rovsim.reporting.wording import (
    ERROR_MEANING,
    ERROR_NAME,
    LADDER_NOTE,
    listed,
    significant,
    tell_probability,
)
from rovsim.reporting.words import terminal
from rovsim.reporting.words.intervals import interval
from rovsim.reporting.words.sentences import ladder_sentences, residual_sentences
from rovsim.reporting.words.sureness import DOUBT_REASONS
from rovsim.reporting.words.symbols import explain_symbols
from rovsim.reporting.words.verdict import explain
from rovsim.results.diagnosis import DisturbedEnd
from rovsim.results.fitted import Doubt, FittedValue, SelectedEffect
from rovsim.results.ladder import Ladder, LadderStep
from synthetic_study import study

TURNED_OVER = re.compile(r"\b(dark|light|bright)er\b|\b(black|white|gr[ae]y|pale)\b", re.I)
FUNCTIONS = "exp|max|tanh|min|to|cdot|le|leftrightarrow|quad|sqrt|sim|pi|top"


@pytest.fixture(scope="module")
def content():
    return study()


def test_a_phrase_is_listed_as_a_whole():
    phrases = [f"cubic_damping instead of {name}" for name in ("quadratic_damping", "lift")]
    assert listed(phrases) == " and ".join(phrases)


def test_shares_of_several_effects_are_said_to_add_up(content):
    first, *others = explain(content["diagnosis"], built_in()).missing
    assert " of the error, " in first.worth
    assert others
    assert all(one.worth.startswith("removes another ") for one in others)
    told = " ".join(terminal.tell_diagnosis(content["diagnosis"], built_in()).split())
    assert "on top of those above it" in told


def test_an_effect_that_harms_is_not_said_to_remove_anything(content):
    harmful = content["diagnosis"].selected[0].model_copy(update={"error_reduction": -0.03})
    found = content["diagnosis"].model_copy(update={"selected": (harmful,)})
    (said,) = explain(found, built_in()).missing
    assert said.worth.startswith("raises the error by 3")


def test_thrusters_are_called_as_in_the_vehicle_file(content):
    gain = {"t3": FittedValue(value=0.5, std=0.01, unit="1"), "all": FittedValue(value=0.9)}
    swapped = {"first": FittedValue(value=1), "second": FittedValue(value=3)}
    selected = (
        SelectedEffect(effect="thruster_gain", parameters=gain),
        SelectedEffect(effect="thruster_order", parameters=swapped),
    )
    found = content["diagnosis"].model_copy(
        update={
            "selected": selected,
            "thrusters": ("port", "starboard", "bow"),
            "known_together": (("thruster_gain.t1", "added_mass.surge"),),
        }
    )
    told = " ".join(terminal.tell_diagnosis(found, built_in()).split())
    assert "bow (t3) 0.500 ± 0.020 all 0.9" in told
    assert "first 1 (port) second 3 (bow)" in told
    assert "thruster_gain.port (t1), added_mass.surge" in told
    assert label_parameter("thruster_gain", "t2", ("t1", "t2")) == "t2"


@pytest.mark.parametrize("effect", built_in().values(), ids=list(built_in()))
def test_every_symbol_of_an_equation_is_explained(effect):
    """What is left of it are numbers, functions, operators and words."""
    left = re.sub(r"(?<!_)\\(?:text|mathrm)\{[^}]*\}(_i)?", " ", effect.equation)
    left = re.sub(rf"\\({FUNCTIONS})(?![a-z])", " ", left).replace("e^", "^")
    for symbol, meaning in sorted(explain_symbols(effect), key=lambda one: -len(one[0])):
        assert meaning
        left = re.sub(rf"(?<![a-z\\]){re.escape(symbol)}(?![A-Za-z_])", " ", left)
    assert not re.findall("[A-Za-z]", left)


def test_a_value_that_was_not_found_is_said_where_the_equation_has_it():
    sag = built_in()["voltage_sag"]
    assert ("r", "rate, 0 here") in explain_symbols(sag, ["fraction"])
    assert ("r", "rate") in explain_symbols(sag, ["fraction", "rate"])
    assert ("d_i", "surge, sway") in explain_symbols(
        built_in()["quadratic_damping"], ["surge", "sway"]
    )


def test_the_report_explains_symbols(content):
    page = report.render(
        report.Report("x", ReportData(diagnosis=content["diagnosis"]), catalogue=built_in())
    )
    assert "velocity through the water along axis i" in page


def test_numbers_below_zero_have_a_minus_sign():
    assert significant(-3.9444) == "−3.94"
    assert significant(-2e-7, 2) == "−2.0e−07"
    assert interval(FittedValue(value=-0.03, std=3.0, unit="m")) == "0.0 ± 5.9 m"
    assert interval(FittedValue(value=-3.944, std=0.1, unit="N")) == "−3.94 ± 0.20 N"
    assert interval(FittedValue(value=-3.944, unit="N")) == "−3.944 N"
    assert rounded(-3.9444, 3) == -3.94
    assert (
        "{\\num{-2.00e-07}}"
        in Table(
            "x", "y", [Column("a", "a", "–")], DataFrame({"a": [-2e-7, -1.5]}, index=["p", "q"])
        ).latex()
    )


def test_a_finding_says_where_the_error_is_largest_and_what_explains_it(content):
    said = " ".join(s for model in content["where"].models.values() for s in model.sentences)
    assert "The error is largest, " in said
    assert re.search(r" explains \d+ % of the squared error[.,]", said)
    assert "varies with it" not in said


def test_the_error_that_ranks_has_one_name_and_one_meaning(content):
    ladder = tabulate_ladder(content["ladder"])
    told = terminal.tell_diagnosis(content["diagnosis"], built_in())
    compared = terminal.tell_comparison({"nominal": 0.3}, content["where"], tested=True)
    for said in (ladder.caption, told, compared):
        assert ERROR_MEANING in " ".join(said.split())
    assert ladder.columns[0].heading == ERROR_NAME
    assert f"the {ERROR_NAME} falls from" in told
    assert ERROR_NAME in find_figure("ladder").caption


@pytest.mark.parametrize(
    ("after", "told"),
    [(9.9, "rises from 0.179 to 9.90"), (0.1791, "stays at 0.179"), (0.1, "falls from 0.179")],
)
def test_what_became_of_the_error_is_told_as_far_as_its_digits_show(content, after, told):
    errors = {"nominal": 0.179, "with_effects": after}
    error = content["diagnosis"].error.model_copy(update=errors)
    found = content["diagnosis"].model_copy(update={"error": error})
    assert told in terminal.tell_diagnosis(found, built_in())


def test_ends_of_runs_that_hands_may_have_moved_are_told_with_what_leaves_them_out(content):
    end = DisturbedEnd(run="dive", from_s=33.2, to_s=40.0, times=6.39)
    given = {"disturbed_ends": (end,), "unlogged_s": {"dive": 6.0}}
    found = content["diagnosis"].model_copy(update=given)
    said = " ".join(terminal.tell_diagnosis(found, built_in()).split())
    assert "Run dive leaves 6.4 times as much from 33.2 to 40.0 s" in said
    assert "leave that out with `use`" in said
    assert "begins later or ends earlier: 6.0 s of dive." in said


@pytest.mark.parametrize(
    ("after", "verdict", "differ"),
    [
        (0.17, "adequate", True),
        (0.17, "missing_effects", True),
        (0.17, "unexplained", False),
        (0.17, "insufficient_data", False),
        (0.03, "adequate", False),
        (None, "adequate", False),
    ],
)
def test_test_runs_that_differ_from_the_train_runs_are_told(content, after, verdict, differ):
    times = after and after / 0.024
    errors = {"nominal": 0.3, "with_effects": after, "noise_floor": 0.024}
    error = content["diagnosis"].error.model_copy(update=errors)
    nothing = content["diagnosis"].unexplained.model_copy(update={"significant": False})
    given = {"verdict": verdict, "error": error, "unexplained": nothing, "times_floor": times}
    found = content["diagnosis"].model_copy(update=given)
    said = " ".join(terminal.tell_diagnosis(found, built_in()).split())
    assert ("The error is 7.1 times that" in said) == differ


def test_an_error_at_the_start_of_logs_is_no_difference(content):
    errors = {"nominal": 0.3, "with_effects": 0.05, "noise_floor": 0.024}
    error = content["diagnosis"].error.model_copy(update=errors)
    nothing = content["diagnosis"].unexplained.model_copy(update={"significant": False})
    given = {"verdict": "missing_effects", "error": error, "times_floor": 1.02}
    found = content["diagnosis"].model_copy(update={**given, "unexplained": nothing})
    said = " ".join(terminal.tell_diagnosis(found, built_in()).split())
    assert "differ from them" not in said
    assert "nobody knows what the thrusters were told before" in said


@pytest.mark.parametrize(
    ("probability", "told"),
    [
        (0.0, "below 0.001"),
        (1.84e-128, "below 0.001"),
        (0.03, "0.030"),
        (0.9995, "above 0.999"),
        (None, "–"),
    ],
)
def test_a_probability_is_told_as_people_write_it(probability, told):
    assert tell_probability(probability) == told


@pytest.mark.parametrize("probability", [1e-9, 0.5, 0.9999])
def test_a_verdict_tells_a_probability_as_tables_do(content, probability):
    (first, *_) = content["diagnosis"].selected
    one = first.model_copy(update={"probability": probability})
    found = content["diagnosis"].model_copy(update={"selected": (one,)})
    (said,) = explain(found, built_in()).missing
    assert said.worth.endswith(f"probability {tell_probability(probability)}")


def test_a_sure_effect_whose_values_may_each_be_absent_is_told(content):
    def said(effect, values, probability=0.9999):
        given = {name: FittedValue(value=v, std=s, unit="1") for name, (v, s) in values.items()}
        one = SelectedEffect(effect=effect, parameters=given, probability=probability)
        selected = {"selected": (one,), "thrusters": ("port", "starboard")}
        found = content["diagnosis"].model_copy(update=selected)
        told = explain(found, built_in()).remarks
        assert set(told) <= set(explain(found, built_in()).sentences)
        return " ".join(one for one in told if "is sure" in one)

    wrench = {"surge": (1.0, 0.9), "sway": (2.0, 0.1), "yaw": (-0.1, 0.2)}
    assert said("constant_wrench", wrench) == (
        "constant_wrench is sure, but not each of its values: the 95 % intervals of surge and yaw "
        "hold 0, which changes nothing."
    )
    assert said("constant_wrench", wrench, probability=0.99) == ""
    assert said("constant_wrench", wrench, probability=None) == ""
    assert said("constant_wrench", {"surge": (1.0, None), "sway": (2.0, 0.1)}) == ""
    gains = {"t1": (1.02, 0.1), "t2": (0.1, 0.1)}  # it is one, not zero, where nothing is wrong
    assert said("thruster_gain", gains).endswith(
        "interval of port (t1) holds 1, which changes nothing."
    )


def test_the_ladder_says_which_rows_build_on_each_other(content):
    steps = (LadderStep(model="nominal", windows_2s=0.2), LadderStep(model="+lift", windows_2s=0.1))
    assert LADDER_NOTE in tabulate_ladder(Ladder(steps=steps)).caption
    assert LADDER_NOTE not in tabulate_ladder(Ladder(steps=steps[:1])).caption


def test_a_residual_is_not_praised_where_the_effects_alone_do_better(content):
    errors = pool(content["comparison"], "velocity_rmse")
    steps = {"nominal": 1.0, "+lift": 0.5, "+current": 0.23, "effects+gp_6dof": 0.24}
    said = residual_sentences(errors, steps)
    assert "But the effects alone lower it by 77\u202f%." in said
    said = residual_sentences(errors, steps | {"knn_6dof": float("nan")})
    assert "KNN (6-DoF) has no value: a replay came to no end." in said
    said = residual_sentences(errors, steps | {"effects+gp_6dof": 0.22})
    assert not any("effects alone" in sentence for sentence in said)
    law = {"nominal": 1.0, "+lift": 0.75, "+proposed_effect": 0.25, "effects+gp_6dof": 0.8}
    assert "But the effects alone lower it by 25\u202f%." in residual_sentences(errors, law)
    own = {"nominal": 1.0, "my_tether": 0.5, "knn_6dof": 0.9}
    told = "But my tether, which has no residual, lowers it by 50\u202f%."
    assert told in " ".join(residual_sentences(errors, own)).replace("_", " ")


def test_a_comparison_shows_the_error_that_ranks_without_a_ladder(content):
    steps = (LadderStep(model="nominal", windows_2s=0.2), LadderStep(model="mine", windows_2s=0.1))
    data = ReportData(comparison=content["comparison"], steps=steps)
    page = report.render(report.Report("x", data))
    assert "<h2>2 s error</h2>" in page
    assert "The lowest 2 s error is 0.100, that of mine; nominal has 0.200." in page
    assert "noise floor is a bound" not in page


@pytest.mark.parametrize("doubt", [None, *get_args(Doubt)])
def test_why_a_name_has_no_probability_is_said(content, doubt):
    one = SelectedEffect(effect="lift", parameters={}, doubt=doubt)
    found = content["diagnosis"].model_copy(update={"selected": (one,), "rivals": ()})
    said = explain(found, built_in()).missing[0]
    assert said.worth.endswith(f", no probability: {DOUBT_REASONS[doubt]}")


def test_what_is_unexplained_is_not_said_to_be_all_that_a_perfect_model_leaves(content):
    found = content["diagnosis"]
    left = found.unexplained.model_copy(update={"significant": True, "proposal": None})
    said = explain(found.model_copy(update={"unexplained": left}), built_in()).error
    assert "counts what is unexplained as noise" in said
    assert "perfect model" not in said
    steps = {"nominal": 0.2, "zero_acceleration": 0.9, "noise_floor": 0.19}
    assert "counts what is unexplained as noise" in ladder_sentences(steps, True)[-1]
    assert "reaches the noise floor" in ladder_sentences(steps | {"noise_floor": 0.2}, False)[-1]


def test_effects_that_remove_nothing_are_not_ranked_on_the_terminal(content):
    useless = [
        r.model_copy(update={"error_reduction": 0.004}) for r in content["diagnosis"].ranking
    ]
    found = content["diagnosis"].model_copy(update={"ranking": tuple(useless)})
    assert "removes alone" not in terminal.tell_diagnosis(found, built_in())


def test_the_noise_of_recordings_is_in_mm_and_mrad_and_lost_frames_are_counted(content):
    page = report.render(report.Report("x", ReportData(quality=content["quality"])))
    (one, *_) = content["quality"].values()
    assert f'data-value="{1e3 * one.noise.position_m}"' in page
    assert '<span class="unit">mm</span>' in page
    assert "frames<br>without pose" in page
    assert f'data-value="{one.not_found}">{one.not_found}' in page


def test_the_report_says_once_which_way_heave_is_positive(content):
    page = report.render(report.Report("x", ReportData(where=content["where"])))
    assert page.count("heave down") == 1


def said_by(module: Path) -> list[str]:
    """Sentences in a module's code, which users read; docstrings are for others."""
    tree = ast.parse(module.read_text(encoding="utf-8"))
    loose = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    texts = (n for n in ast.walk(tree) if isinstance(n, ast.Constant) and id(n) not in loose)
    said = (node.value for node in texts if isinstance(node.value, str))
    return [one for one in said if re.search(r"\w[.:,;]? \w+ \w", one) and "{" not in one]


def test_the_workbench_says_nothing_that_is_wrong_in_the_dark():
    """There charts and pictures are turned over: what is black on paper is white."""
    modules = Path(workbench.__file__).parent.glob("*.py")
    said = [one for module in modules for one in said_by(module)]
    assert len(said) > 200
    assert [one for one in said if TURNED_OVER.search(one)] == []
