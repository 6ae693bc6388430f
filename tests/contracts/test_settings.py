"""conf/config.yaml, the sections that read it, and the page that explains it say the same."""

from pathlib import Path

import pytest

from rovsim.application.configuration import compose
from rovsim.application.sections import SimulationSections, TrainingSettings
from rovsim.application.settings import CampaignSettings, Settings, select
from rovsim.core.errors import BadInput
from rovsim.core.schema import Section, checked
from rovsim.design.settings import Question
from rovsim.diagnosis.settings import DiagnosisSettings
from rovsim.simulation.settings import SimulationSettings
from rovsim.simulation.synthetic_tank.settings import TankSettings

PAGE = Path(__file__).parents[2] / "docs" / "configuration.md"


def with_defaults():
    """Sections that can be made of nothing: their defaults stand in the code as well."""
    for name, field in Settings.model_fields.items():
        kind = field.annotation
        if name == "tank" or not isinstance(kind, type) or not issubclass(kind, Section):
            continue
        if not any(own.is_required() for own in kind.model_fields.values()):
            yield name, kind


SECTIONS = dict(with_defaults())


def test_there_are_sections_with_defaults():
    assert {"search", "replay", "design", "study", "blind"} <= set(SECTIONS)


@pytest.mark.parametrize("name", SECTIONS)
def test_defaults_are_the_same_in_conf_and_in_the_code(name):
    assert getattr(compose([]), name) == SECTIONS[name]()


@pytest.mark.parametrize("name", SimulationSettings.model_fields)
@pytest.mark.parametrize("kind", [SimulationSections, TrainingSettings, CampaignSettings, Settings])
def test_a_section_that_a_configuration_lacks_is_not_made_up(kind, name):
    given = select(compose([]), kind).model_dump(mode="json")
    del given[name]
    with pytest.raises(BadInput, match=f"'{name}' is missing"):
        checked(kind, given, "configuration")


def test_a_tank_takes_keys_that_no_file_lists():
    assert compose(["tank=tiny", "tank.camera.rate=50"]).tank.camera.rate == 50.0
    with pytest.raises(BadInput, match="Did you mean 'rate'"):
        compose(["tank.camera.rat=50"])


@pytest.mark.parametrize(
    ("word", "meant"),
    [
        ("blind.methods=[diagnosis,stlq]", "stlsq"),
        ("study.controls=[6dfo]", "6dof"),
        ("folds.controls=[al]", "all"),
        ("tank.runs=[{id: a, control: 6dof, split: trian}]", "train"),
        ("blind.suite=quik", "quick"),
    ],
)
def test_a_mistyped_name_is_answered_with_the_nearest(word, meant):
    with pytest.raises(BadInput, match=f"Did you mean '{meant}'"):
        compose([word])


def test_the_page_names_every_key_of_the_tank():
    text = PAGE.read_text(encoding="utf-8")
    for name, field in TankSettings.model_fields.items():
        kind = field.annotation
        below = kind.model_fields if isinstance(kind, type) and issubclass(kind, Section) else ()
        assert f"`tank.{name}" in text, name
        for own in below:
            assert f"`tank.{name}.{own}`" in text or f"`.{own}`" in text, f"{name}.{own}"


def test_of_the_search_a_question_takes_what_a_design_looks_at_alone():
    def asked(*overrides):
        settings = compose(overrides)
        chosen = select(settings, DiagnosisSettings)
        return Question.of(chosen, settings.design, "here", seconds=20.0)

    some = asked("search.most_seconds=120")
    assert (some.most_seconds, some.seconds) == (120.0, 20.0)
    assert asked("search.most_seconds=120", "search.false_alarm=0.01") == some
    assert asked() == asked().model_copy(update={"most_seconds": 600.0})
