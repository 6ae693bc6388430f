"""A diagnosis that a user gives is shown on the recordings that it is of, and on no others."""

import shutil

import pytest

from rovsim.application.configuration import compose
from rovsim.application.provenance import digest_recordings
from rovsim.apps.workbench import tasks
from rovsim.apps.workbench.workbench import Workbench
from rovsim.core.errors import BadInput
from rovsim.dynamics.catalogue import built_in
from rovsim.measurement.loading import load_campaign
from synthetic_study import a_lag


@pytest.fixture
def given(bench, tmp_path):
    """The folder of a campaign of its own, and a diagnosis of it."""
    folder = tmp_path / "campaign"
    shutil.copytree(bench.data.campaign.folder, folder)
    read = digest_recordings(load_campaign(folder))
    diagnosis = tmp_path / "found" / "diagnosis.json"
    a_lag().model_copy(update={"recordings": read}).write(diagnosis)
    return folder, diagnosis


def opened(folder, diagnosis):
    settings = compose([f"campaign='{folder}'", f"diagnosis='{diagnosis}'"])
    return Workbench.opened(settings, built_in())


def test_it_is_shown_wherever_the_campaign_lies_and_whatever_it_is_called(given, tmp_path):
    folder, diagnosis = given
    moved = folder.rename(tmp_path / "moved")
    described = moved / "campaign.yaml"
    described.write_text(described.read_text("utf-8").replace("name: ", "name: renamed-"), "utf-8")
    assert opened(moved, diagnosis).diagnosis.selected[0].effect == "thruster_lag"


def test_that_of_other_recordings_is_refused_and_says_which(given):
    folder, diagnosis = given
    with (folder / "6dof-1_commands.csv").open("a", encoding="utf-8") as log:
        log.write("\n")
    with pytest.raises(BadInput) as refused:
        opened(folder, diagnosis)
    assert refused.value.where == str(diagnosis)
    assert "1 of the 6 files that it read are not in this campaign" in refused.value.found
    assert "(6dof-1_commands.csv)" in refused.value.found
    assert str(folder) in refused.value.expected
    assert "Open the campaign that was diagnosed" in refused.value.remedy


def test_that_of_another_campaign_is_refused_in_fewer_words(given):
    folder, diagnosis = given
    a_lag().model_copy(update={"recordings": {"a.tsv": "0" * 16, "a.csv": "1" * 16}}).write(
        diagnosis
    )
    with pytest.raises(BadInput, match="none of the 2 files that it read is in this campaign"):
        opened(folder, diagnosis)


def test_that_of_fewer_recordings_is_refused_too(given):
    folder, diagnosis = given
    read = digest_recordings(load_campaign(folder))
    fewer = {name: content for name, content in read.items() if not name.startswith("6dof-2")}
    a_lag().model_copy(update={"recordings": fewer}).write(diagnosis)
    with pytest.raises(BadInput, match="did not read 2 of the 6 files of this campaign"):
        opened(folder, diagnosis)


def test_one_that_does_not_say_what_it_is_of_is_taken(given):
    folder, diagnosis = given
    a_lag().write(diagnosis)
    assert opened(folder, diagnosis).diagnosis is not None


def test_a_diagnosis_says_what_it_is_of(bench, tmp_path):
    found = tasks.diagnose_into(bench.only("nominal"), tmp_path / "diagnosis.json")
    assert found.recordings == digest_recordings(bench.data.campaign)
    assert "campaign.yaml" not in found.recordings
