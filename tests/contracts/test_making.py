"""A page says when, from which commit and on which machine it was made; a fixed clock fixes it."""

import subprocess

import pytest

from rovsim.application.configuration import compose
from rovsim.application.provenance import provenance
from rovsim.core.making import describe_commit, describe_machine, describe_making
from rovsim.dynamics.catalogue import built_in
from rovsim.reporting.html import report
from rovsim.reporting.report_data import ReportData


def test_a_report_says_when_and_where_it_was_made(tmp_path, monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1764000000")
    pages = [tmp_path / "one.html", tmp_path / "two.html"]
    for page in pages:
        report.write(page, report.Report("x", ReportData()))
    said, again = (page.read_text() for page in pages)
    assert "Made 2025-11-24 16:00 UTC by rovsim " in said
    assert describe_machine() in said
    assert said == again


def test_without_a_fixed_clock_it_is_today(monkeypatch):
    monkeypatch.delenv("SOURCE_DATE_EPOCH", raising=False)
    assert "1970" not in describe_making()


def test_the_commit_is_that_of_the_sources_and_of_no_other_folder(tmp_path):
    assert describe_commit(tmp_path) == ""
    git = ["git", "-C", str(tmp_path), "-c", "user.name=a", "-c", "user.email=a@b"]
    (tmp_path / "src").mkdir()
    (tmp_path / "src" / "a.py").write_text("")
    for words in (["init", "-q"], ["add", "."], ["commit", "-qm", "first"]):
        subprocess.run([*git, *words], check=True)
    commit = describe_commit(tmp_path)
    assert len(commit) == 12
    (tmp_path / "src" / "a.py").write_text("1")
    assert describe_commit(tmp_path) == f"{commit}, changed since"


@pytest.mark.parametrize("path", ["", "/nowhere"])
def test_without_git_nothing_is_said_of_a_commit(tmp_path, monkeypatch, path):
    (tmp_path / ".git").mkdir()
    monkeypatch.setenv("PATH", path)
    assert describe_commit(tmp_path) == ""


def test_provenance_has_a_row_for_each_section():
    settings = {"seed": 0, "search": {"draws": 9, "trials": 3}, "signals": {"filter": {"order": 3}}}
    rows = report.list_rows({"code": "abc", "settings": settings})
    assert rows == [
        ("code", "abc"),
        ("settings", "seed 0"),
        ("settings.search", "draws 9; trials 3"),
        ("settings.signals.filter", "order 3"),
    ]


def test_where_a_result_is_written_is_no_part_of_it():
    one, other = (
        provenance(compose([f"out={name}", "port=8502"]), built_in(), None) for name in ("a", "b")
    )
    assert one == other
    assert one["settings"]["replay"]
