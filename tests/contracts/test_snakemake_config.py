"""What Snakemake is told: words of an override string, and names that there are not; its folder."""

import pytest
from filelock import FileLock

from rovsim.application.study.lock import hold
from rovsim.application.study.snakemake_config import SnakemakeConfig, split_words
from rovsim.application.study.study import Study
from rovsim.core.errors import BadInput


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("tank=lag  residual.k=9 ", ["tank=lag", "residual.k=9"]),
        ("a=[{b: c, d: {e: 1}}] f=2", ["a=[{b: c, d: {e: 1}}]", "f=2"]),
        ("out='my tank' a=\"b c\"", ["out='my tank'", 'a="b c"']),
        ("a=']' b=1", ["a=']'", "b=1"]),
        ("", []),
    ],
)
def test_overrides_are_parted_outside_of_quotes_and_brackets(text, words):
    assert split_words(text) == words


def test_overrides_may_hold_what_the_command_line_may():
    hidden = "[{effect: net_buoyancy, parameters: {force: 5}}]"
    told = SnakemakeConfig({"overrides": f"tank=tiny tank.effects={hidden} out='my tank'"})
    (effect,) = told.settings.tank.effects
    assert effect.effect == "net_buoyancy"
    assert told.settings.out == "my tank"


@pytest.mark.parametrize(
    "word",
    ["study.residuals=[knnn]", "folds.residuals=[knnn]"],
)
def test_a_residual_that_nobody_knows_is_refused_before_anything_is_planned(word):
    """Also where no run is left out: the typing error would show only when one is."""
    with pytest.raises(BadInput, match=f"{word.partition('=')[0]}: .*'knnn'.*mean 'knn'"):
        Study({"overrides": f"tank=tiny {word}"}).check()


@pytest.mark.parametrize(
    ("names", "said"),
    [
        ("[knn]", "'knn'.*as in knn_6dof"),
        ("[knn_6dfo]", "'knn_6dfo'.*Did you mean '6dof'"),
        ("[kn_6dof]", "'kn'"),
    ],
)
def test_residuals_on_effects_are_named_with_their_control(names, said):
    with pytest.raises(BadInput, match=f"study.on_effects: .*{said}"):
        Study({"overrides": f"tank=tiny study.on_effects={names}"}).check()


def test_a_folder_that_another_study_holds_or_nobody_can_write_to_is_one_message(tmp_path):
    with (
        FileLock(tmp_path / ".study.lock"),
        pytest.raises(BadInput, match="another study writes here"),
    ):
        hold(tmp_path)
    (tmp_path / "file").touch()
    with pytest.raises(BadInput, match="results: cannot be written"):
        hold(tmp_path / "file" / "results")
