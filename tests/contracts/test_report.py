"""Tables and the report: the numbers of the JSON files, nothing more."""

import csv
import io
import re
from html.parser import HTMLParser

import pytest

from rovsim import AXES
from rovsim.figures import kind
from rovsim.figures.style import save
from rovsim.report import page
from rovsim.tables import errors_table, escaped, ladder_table
from synthetic_study import study


@pytest.fixture(scope="module")
def content():
    return study()


@pytest.fixture(scope="module")
def html(content, tmp_path_factory):
    folder = tmp_path_factory.mktemp("report")
    save(kind("ladder").draw(ladder=content["ladder"]), folder, "ladder")
    picture = page.Picture.read(folder / "ladder.png", "ladder")
    inputs = page.ReportInputs(
        "tank <b>&", content["comparison"], content["ladder"], content["timing"],
        content["quality"], [picture], {"settings": {"seed": 0}},
        where=content["where"],
    )  # fmt: skip
    return page.render(inputs)


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
    for heading in (
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
    for step in content["ladder"]["steps"]:
        assert f"{step['windows_2s']:.3g}"[:4] in html


def test_the_findings_of_every_model_are_sentences_on_the_page(html, content):
    for model in content["where"]["models"].values():
        for sentence in model["sentences"]:
            assert sentence in html


def test_an_empty_study_is_a_page_too():
    assert "Summary" in page.render(page.ReportInputs("nothing", {"models": {}}))


@pytest.mark.parametrize("quantity", ["velocity_rmse", "velocity_mae", "acceleration_rmse"])
def test_tables_hold_the_comparisons_numbers(content, quantity):
    table = errors_table(content["comparison"], "2", "test", quantity)
    rows = list(csv.reader(io.StringIO(table.csv())))
    assert len(rows) == 1 + len(content["comparison"]["models"])
    runs = content["comparison"]["models"]["nominal"]["runs"]
    tests = [r["windows"]["2"][quantity]["surge"] for r in runs.values() if r["split"] == "test"]
    row = next(r for r in rows if r[0] == "nominal")
    assert min(tests) <= float(row[1]) <= max(tests)
    latex = table.latex()
    assert all(axis in latex for axis in AXES)
    assert r"\toprule" in latex
    assert latex.count(r"\textbf{") >= 6


def test_latex_special_characters_are_escaped():
    assert escaped("a_b & 50%") == r"a\_b \& 50\%"
    assert r"zero\_acceleration" in ladder_table(study()["ladder"]).latex()
