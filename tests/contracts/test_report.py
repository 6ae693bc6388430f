"""Tables and the report: the numbers of the JSON files, nothing more."""

import csv
import io
import re
from dataclasses import replace
from html import unescape
from html.parser import HTMLParser
from statistics import geometric_mean

import pytest

from rovsim.core.axes import AXES
from rovsim.dynamics.catalogue import built_in
from rovsim.reporting.figures import find_figure
from rovsim.reporting.figures.style import save
from rovsim.reporting.formula import mathml
from rovsim.reporting.html import report
from rovsim.reporting.html.picture import Picture
from rovsim.reporting.pages import against_published, leave_one_run_out
from rovsim.reporting.pages.marked import BEGIN, END
from rovsim.reporting.report_data import ReportData, describe_figure
from rovsim.reporting.tables import tabulate_errors, tabulate_ladder
from rovsim.reporting.wording import explain_model, several, significant, title
from rovsim.reporting.words import published_errors, terminal
from rovsim.reporting.words.apart import apart_sentences
from rovsim.reporting.words.shown import part_sentences
from rovsim.reporting.words.speed import timing_sentences
from rovsim.reporting.words.verdict import explain
from rovsim.results.comparison import Comparison
from rovsim.results.diagnosis import DiagnosisErrors, LookedAt, RivalEffect, Unexplained
from rovsim.results.error_conditions import ErrorConditions
from rovsim.results.fitted import FittedEffect, FittedValue, SelectedEffect
from rovsim.results.pitfalls import Pitfalls
from rovsim.results.published_errors import MissedCell
from synthetic_study import study

JOINT = ("linear_damping.surge", "added_mass.surge")


@pytest.fixture(scope="module")
def content():
    return study()


@pytest.fixture(scope="module")
def html(content, tmp_path_factory):
    folder = tmp_path_factory.mktemp("report")
    save(find_figure("ladder").draw(ladder=content["ladder"]), folder, "ladder")
    picture = Picture.read(folder / "ladder.png", "ladder")
    known = {k: content[k] for k in ("comparison", "ladder", "timing", "quality", "where")}
    data = ReportData(**known, diagnosis=_rude(content["diagnosis"]))
    return report.render(report.Report("tank <b>&", data, [picture], {"settings": {"seed": 0}}))


def rendered(**results):
    """The page of these results alone."""
    return report.render(report.Report("x", ReportData(**results)))


def test_a_report_says_what_it_is_about(content):
    asked = ("comparison",), ("diagnosis",), ("comparison", "diagnosis")
    pages = [rendered(**{name: content[name] for name in names}) for names in asked]
    told = [re.search(r'class="subtitle">(.*?)<', page)[1] for page in pages]
    assert len(set(told)) == 3


def _rude(found):
    """A diagnosis whose texts would be markup, were they not escaped."""
    unexplained = found.unexplained.model_copy(update={"hint": "<script>alert(1)</script>"})
    rude = {"unexplained": unexplained, "next_experiment": "Run <i>6dof & co</i>"}
    return found.model_copy(update=rude)


@pytest.mark.parametrize(
    "latex",
    [
        r"\text{<img src=x onerror=alert(1)>}",
        r"\href{javascript:alert(1)}{x}",
        r"\style{x:y}{z}",
        r"\frac{a}",
        "}{",
        "",
        r"\color{a\" onload=\"x}{y}",
    ],
)
def test_an_equation_is_shown_and_never_run(latex):
    parser = Tags()
    parser.feed(mathml(latex))
    for tag, attributes in parser.found:
        assert tag in ("code", "math", "mrow", "mi", "mo", "mn", "mtext", "mfrac", "mstyle")
        assert not {"href", "style", "onload"} & set(attributes)


class Tags(HTMLParser):
    def __init__(self):
        super().__init__()
        self.found = []

    def handle_starttag(self, tag, attributes):
        self.found.append((tag, dict(attributes)))


def test_the_page_needs_nothing_but_itself(html):
    parser = Tags()
    parser.feed(html)
    names = [tag for tag, _ in parser.found]
    assert "script" not in names
    assert "link" not in names
    for _, attributes in parser.found:
        for key in ("src", "href"):
            assert not re.match(r"(https?:)?//", attributes.get(key) or "")
    images = [attributes for tag, attributes in parser.found if tag == "img"]
    assert images
    assert all(a["src"].startswith("data:image/png;base64,") and a["alt"] for a in images)


def test_names_are_escaped_and_every_section_is_there(html):
    assert "tank &lt;b&gt;&amp;" in html
    assert "<script>" not in html
    assert "&lt;script&gt;alert(1)" in html
    assert "Run &lt;i&gt;6dof &amp; co&lt;/i&gt;" in html
    assert html.index(">Verdict<") < html.index("<h2>Summary<")
    for heading in (
        "Verdict",
        "Summary",
        "Where the models fail",
        "Compare",
        "Ladder",
        "Timing",
        "Data quality",
        "Provenance",
    ):
        assert f">{heading}<" in html


def test_the_page_shows_the_numbers_of_the_ladder(html, content):
    table = html[html.index('id="table-ladder"') :]
    rows = dict(re.findall(r'<th scope="row">(.*?)</th>\s*<td[^>]*data-value="(.*?)"', table))
    for step in content["ladder"].steps:
        assert float(rows[title(step.model)]) == step.windows_2s


def test_the_findings_of_every_model_are_sentences_on_the_page(html, content):
    for model in content["where"].models.values():
        for sentence in model.sentences:
            assert sentence in html


def test_the_verdict_says_what_how_much_how_sure_and_what_is_open(html):
    for words in (
        "79.5 ± 1.5 N s²/m²",
        "0.1500 ± 0.0078 s",
        "removes 42\u202f% of the error, probability 0.970",
        "These runs cannot tell input_delay and thruster_lag apart.",
        "The next best explanation instead of quadratic_damping is linear_damping: 90 times less "
        "likely.",
        "falls from 0.190 to 0.0440",
        "noise floor",
        "Nothing can be said about roll and pitch",
    ):
        assert words in html


def test_what_nobody_would_argue_about_is_said_once(content):
    found = content["diagnosis"]
    first, second, *_ = (one.effect for one in found.selected)
    rivals = tuple(
        RivalEffect(effect=name, instead_of=instead, deficit=deficit)
        for name, instead, deficit in (
            ("lift", first, 90.0),
            ("current", first, 300.0),
            ("payload", second, 100.0),
        )
    )
    said = apart_sentences(found.model_copy(update={"rivals": rivals, "indistinguishable": ()}))
    told = [sentence for sentence in said if "next best" in sentence]
    assert told == [
        "The next best explanations are each more than a million times less likely: lift instead "
        f"of {first} and payload instead of {second}."
    ]


def test_terminal_and_page_say_the_same(content):
    found = content["diagnosis"]
    text = " ".join(terminal.tell_diagnosis(found, built_in()).split())
    for remark in explain(found, built_in()).sentences:
        assert " ".join(remark.split()) in text


def test_the_ranking_in_the_terminal_falls(content):
    ranking = [
        FittedEffect(effect=f"effect_{k}", parameters={}, error_reduction=share)
        for k, share in enumerate((0.2, 0.5, 0.0, 0.01, 0.3, 0.1, 0.4))
    ]
    found = content["diagnosis"].model_copy(update={"ranking": tuple(ranking)})
    said = terminal.tell_diagnosis(found, built_in()).partition("removes alone")[2]
    assert re.findall(r"effect_(\d)", said) == ["1", "6", "4", "0", "5"]


def test_a_campaign_without_a_test_run_is_told_so(content):
    none = ErrorConditions(models={})
    said = terminal.tell_comparison({"nominal": None}, none, tested=False)
    assert "No test run" in said
    assert "split: test" in said
    assert "nan" not in said
    assert "No test run" not in terminal.tell_comparison({"nominal": 0.1}, none, tested=True)


@pytest.mark.parametrize(
    ("without", "corrected", "told"),
    [
        (0.10, 0.08, "the residual lowers the error by 20\u202f%."),
        (
            0.0428,
            0.0717,
            "the residual raises the error by 68\u202f%: the model is better without it.",
        ),
        (None, 0.1, ""),
        (0.1, None, ""),
    ],
)
def test_a_residual_that_does_not_help_is_told_so(without, corrected, told):
    said = terminal.tell_residual(without, corrected).replace("\n", " ")
    assert said.strip().endswith(told)
    assert bool(said.strip()) == bool(told)


def test_sections_without_content_are_left_out(content):
    found = rendered(diagnosis=content["diagnosis"], ladder=content["ladder"])
    assert re.findall(r"<h2>(.*?)</h2>", found) == ["Verdict", "Ladder"]
    assert re.findall(r"<a href=\"#(\w+)\"", found) == ["verdict", "ladder"]


def test_too_little_data_is_a_verdict_without_an_error(content):
    nothing = {"fraction": 0.0, "significant": False, "hint": "Nothing is left but noise."}
    found = {
        "verdict": "insufficient_data",
        "selected": (),
        "ranking": (),
        "indistinguishable": (),
        "unexplained": Unexplained(**nothing),
        "next_experiment": "Record more.",
        "error": DiagnosisErrors(nominal=None, with_effects=None, noise_floor=None),
    }
    said = explain(content["diagnosis"].model_copy(update=found), built_in())
    assert said.error.startswith("No test run could be used")
    assert not any("noise" in remark for remark in said.remarks)


def _write_folds(folder, content):
    """What a study of folds leaves in its results; one fold knows two values only together."""
    content["published_errors"].write(folder / "published_errors.json")
    content["timing"].write(folder / "timing.json")
    for run, groups in zip(content["published_errors"].runs, ((), (JOINT,)), strict=True):
        diagnosis = content["diagnosis"].model_copy(update={"known_together": groups})
        diagnosis.write(folder / "folds" / run / "diagnosis.json")


def test_published_numbers_have_a_section_and_a_page(content, tmp_path):
    found = content["published_errors"]
    html = rendered(published_errors=found)
    assert re.findall(r"<h2>(.*?)</h2>", html) == ["Against the published numbers"]
    one = found.models["gp_6dof"]
    assert f'data-value="{one.geometric_mean}"' in html
    path = tmp_path / "page.md"
    _write_folds(tmp_path, content)
    path.write_text(f"# Words\n\n{BEGIN}\nbefore\n{END}\nmore words\n")
    leave_one_run_out.main([str(tmp_path), str(path)])
    text = path.read_text()
    assert "pitfalls" not in text
    runs = " | ".join(f"without {run}" for run in found.runs)
    assert f"| parameter | {runs} |" in text
    assert "| thruster_lag time_constant | 0.1500 ± 0.0078 s | 0.1500 ± 0.0078 s |" in text
    assert "| linear_damping.surge, added_mass.surge | 1 of 2 |" in text
    assert all(sentence in text for sentence in timing_sentences(content["timing"]))
    assert "before" not in text
    assert "more words" in text
    row = next(line for line in text.splitlines() if line.startswith("| gp_6dof |"))
    assert f"{one.below} of {one.cells}" in row
    cells = [c for c in found.cells if c.metric == "velocity_mae"]
    assert text.split("### Velocity MAE")[1].split("###")[0].count("| 3dof-2 |") == len(cells) / 2


def test_theirs_and_ours_are_set_against_one_simulator(content):
    found = content["published_errors"]
    text = "\n".join(against_published.write_markdown(found)).split("### On one baseline")[1]
    rows = {line.split(" | ")[0].strip("| "): line for line in text.split("###")[0].splitlines()}
    assert rows["published zero_shot"] == "| published zero_shot | 1.00 | 1.00 | 1.00 |"
    ratios = [
        cell.errors["gp_6dof"] / cell.errors["published zero_shot"]
        for cell in found.cells
        if cell.metric == "velocity_mae"
    ]
    assert rows["gp_6dof"].split(" | ")[2] == significant(geometric_mean(ratios))
    ours = {name: one for name, one in found.models.items() if "zero_shot" not in name}
    alone = against_published.write_markdown(found.model_copy(update={"models": ours}))
    assert "baseline" not in "\n".join(alone)


def test_a_fitted_number_is_known_where_its_interval_leaves_zero_out(content):
    def fold(**values):
        fitted = {name: FittedValue(value=v, std=s) for name, (v, s) in values.items()}
        selected = (SelectedEffect(effect="current", parameters=fitted),)
        return content["diagnosis"].model_copy(update={"selected": selected})

    folds = {
        "a": fold(north=(-0.2, 0.1), east=(0.1, 0.1), down=(0.3, None)),
        "b": fold(north=(0.2, 0.1), east=(0.1, 0.01)),
    }
    said = leave_one_run_out.tell_known(folds)
    assert "leaves zero out: 1 of 3 without a, 2 of 2 without b;" in said
    assert "in every fold current north." in said


def test_effects_and_residual_are_said_cell_by_cell(content):
    known = content["published_errors"]
    missed = (
        MissedCell(run="a", axis="yaw", metric="velocity_mae", ratio=1.25),
        MissedCell(run="b", axis="yaw", metric="acceleration_rmse", ratio=None),
    )
    two = {"cells": 24, "below": 22, "geometric_mean": None, "not_below": missed}
    one = known.models["nominal"].model_copy(update=two)
    models = {"effects+knn_6dof": one, "nominal": one}
    (sentence,) = published_errors.tell_standings(known.model_copy(update={"models": models}))
    assert sentence == (
        "effects + KNN (6-DoF): 22 of 24 cells below the mark, geometric mean of the ratios –. "
        "Not below: a yaw velocity MAE (1.25), b yaw acceleration RMSE (–)."
    )


def test_mistakes_are_said_run_by_run(content, tmp_path):
    cost = {"right": 0.5, "wrong": 1.25}
    runs = {"a": {"wrong clock": cost}, "b": {"wrong clock": cost | {"wrong": None}}}
    pitfalls = Pitfalls(runs=runs)
    (sentence,) = published_errors.tell_pitfalls(pitfalls)
    assert sentence == (
        "Wrong clock: bins of about 0.157 s replayed as if each lasted 0.1 s. Velocity RMSE of the "
        "open loop, in standard deviations of the measured velocity: 0.500 becomes "
        "1.25 (a), 0.500 becomes – (b)."
    )
    html = rendered(published_errors=content["published_errors"], pitfalls=pitfalls)
    assert sentence in unescape(html)
    (tmp_path / "page.md").write_text(f"{BEGIN}\n{END}\n")
    _write_folds(tmp_path, content)
    pitfalls.write(tmp_path / "pitfalls.json")
    leave_one_run_out.main([str(tmp_path), str(tmp_path / "page.md")])
    assert sentence in (tmp_path / "page.md").read_text()


def test_figures_of_the_first_run_are_shown_and_those_of_others_unfold():
    drawn = (("error_growth", ""), ("velocities", "a"), ("velocities", "b"), ("path_3d", "a"))
    pictures = [Picture(name, b"\x89PNG", describe_figure(name, run), run) for name, run in drawn]
    compared = ReportData(comparison=Comparison(models={}))
    html = report.render(report.Report("x", compared, pictures))
    before, of_a, of_b = html.split("<details")
    assert before.count("<figure>") == 1
    assert of_a.startswith(" open><summary>Figures of run a</summary>")
    assert of_a.count("<figure>") == 2
    assert of_b.startswith("><summary>Figures of run b</summary>")
    assert of_b.count("<figure>") == 1


def test_an_empty_study_is_a_page_too():
    assert "Summary" in rendered(comparison=Comparison(models={}))


@pytest.mark.parametrize("quantity", ["velocity_rmse", "velocity_mae", "acceleration_rmse"])
def test_tables_hold_the_comparisons_numbers(content, quantity):
    table = tabulate_errors(content["comparison"], "2", "test", quantity)
    rows = list(csv.reader(io.StringIO(table.csv())))
    assert len(rows) == 1 + len(content["comparison"].models)
    runs = content["comparison"].models["nominal"].runs
    tests = [r.windows["2"].by_axis(quantity)["surge"] for r in runs.values() if r.split == "test"]
    row = next(r for r in rows if r[0] == "nominal")
    assert min(tests) <= float(row[1]) <= max(tests)
    latex = table.latex()
    assert all(axis in latex for axis in AXES)
    assert r"\toprule" in latex
    assert latex.count(r"\bfseries ") >= 6


def test_latex_special_characters_are_escaped(content):
    table = tabulate_ladder(content["ladder"])
    table = replace(table, frame=table.frame.rename(index={"nominal": "my_model & mine"}))
    assert r"my\_model \& mine &" in table.latex()


def test_latex_numbers_are_aligned_at_the_decimal_point(content):
    table = tabulate_errors(content["comparison"])
    table.frame.iloc[0, :4] = [float("nan"), 3.2e-5, 123.4, 0.00467]
    latex = table.latex()
    assert latex.startswith(r"% In the preamble: \usepackage{booktabs,siunitx}")
    widths = re.findall(r"S\[table-format=(\d)\.(\d)\]", latex)
    assert widths == [("1", "4"), ("1", "4"), ("3", "4"), ("1", "5"), ("1", "4"), ("1", "4")]
    row = next(line for line in latex.splitlines() if line.startswith("nominal &"))
    assert row.split(" & ")[1:4] == ["{–}", r"\bfseries {\num{3.20e-05}}", "123"]


def test_the_ladder_has_the_fit_that_others_know(content):
    table = tabulate_ladder(content["ladder"])
    for step in content["ladder"].steps:
        assert table.frame.at[step.model, "fit"] == pytest.approx(100 * (1 - step.windows_2s))
    assert "%" not in table.caption  # LaTeX would leave out the rest
    assert (table.best()["fit"] == table.best()["windows_2s"]).all()
    none = ErrorConditions(models={})
    said = terminal.tell_comparison({"nominal": 0.3, "lost": None}, none, tested=True)
    assert "0.300, fit 70 %" in said
    assert re.search(r"lost +·+ –$", said, re.MULTILINE)


def test_models_have_readable_names_on_paper_and_raw_ones_for_programs(content):
    table = tabulate_ladder(content["ladder"])
    html = rendered(ladder=content["ladder"], comparison=content["comparison"])
    for raw, said in (("zero_acceleration", "constant velocity"), ("knn_6dof", "KNN (6-DoF)")):
        assert f"{raw}," in table.csv()
        assert f"{said} &" in table.latex()
        assert f'<th scope="row">{said}</th>' in html
        assert raw not in html
    assert f"<dt>constant velocity</dt><dd>{explain_model('zero_acceleration')}" in html


@pytest.mark.parametrize(
    ("model", "said", "meaning"),
    [
        ("effects+knn_6dof", "effects + KNN (6-DoF)", "nominal + effects, and nearest neighbours"),
        ("svgp_all", "sparse GP (all runs)", "nominal, and a sparse Gaussian process"),
        ("+thruster_lag", "+ thruster_lag", "the step above"),
        ("effects", "nominal + effects", "nominal, and the effects"),
        ("my_own", "my_own", ""),
    ],
)
def test_a_model_is_called_and_explained(model, said, meaning):
    assert title(model) == said
    assert explain_model(model).startswith(meaning)
    assert bool(explain_model(model)) == bool(meaning)


def test_of_many_runs_it_says_which_are_drawn(content):
    many = dict.fromkeys(map(str, range(200)))
    data = ReportData(
        **{k: content[k] for k in ("comparison", "ladder")},
        motions=many,
        replays={"nominal": {}, "better": {}},
        drawn=("3", "4"),
    )
    said = (
        "Of 200 runs, 3 and 4 have figures of their own: of many, those on which better errs most. "
        "The workbench shows each."
    )
    assert said in report.render(report.Report("x", data))
    assert "figures of their own" not in rendered(comparison=content["comparison"])


def test_what_is_known_says_which_figures_there_are(content):
    assert ReportData().figures == []
    early = ReportData(where=content["where"], quality=content["quality"])
    assert early.figures == ["where", "where_map", "excitation"]
    pushed = content["diagnosis"]
    assert ReportData(diagnosis=pushed).figures == ["ranking", "disturbance"]
    calm = pushed.unexplained.model_copy(update={"disturbance": None})
    found = pushed.model_copy(update={"unexplained": calm})
    assert ReportData(diagnosis=found).figures == ["ranking"]


def test_long_lists_of_runs_are_cut():
    assert several(["a", "b", "c"]) == "a, b, c"
    assert several([f"r{k}" for k in range(200)]).endswith("r7 and 192 more")


def test_what_was_not_looked_at_is_said():
    part = LookedAt(seconds=900.0, of=48000.0, wider=7.3)
    (said,) = part_sentences(part)
    assert said.startswith("Of 800 min of train runs, the 15.0 min that tell most were looked at.")
    assert "7.3 times narrower" in said
    assert part_sentences(LookedAt(seconds=60.0, of=60.0, wider=1.0)) == []


def test_what_wanders_is_said_to_be_unforeseeable_and_not_worth_nothing(content):
    drift = SelectedEffect(
        effect="current_drift",
        parameters={"rate": FittedValue(value=0.012, std=0.001)},
        error_reduction=0.0,
        probability=0.9999,
    )
    found = content["diagnosis"].model_copy(update={"selected": (drift,)})
    (said,) = explain(found, built_in()).missing
    assert said.worth == "cannot be foreseen, probability above 0.999"
