"""A drag that a cross-flow raises is not taken for a lift: one law, and no name."""

import pytest

from rovsim.benchmarks.blind.asking import diagnosis
from rovsim.benchmarks.blind.flight import fly
from rovsim.benchmarks.blind.suites import law


@pytest.mark.thorough
def test_a_drag_of_two_velocities_is_a_law_and_not_a_lift(tmp_path):
    fly(law("coupled_cubic", 0, "development"), tmp_path / "raw")
    found = diagnosis(tmp_path / "raw", tmp_path / "out")
    assert found.verdict == "unexplained"
    assert not found.selected
    (term,) = found.unexplained.proposal.terms
    assert (term.on, term.quantities) == ("sway", ("u", "v"))


@pytest.mark.thorough
def test_two_names_do_not_stand_in_for_a_law_that_they_resemble(tmp_path):
    """Beside the noise that lift and linear damping leave, the drag u^2 v does not stand out."""
    fly(law("coupled_cubic", 13, "development"), tmp_path / "raw")
    found = diagnosis(tmp_path / "raw", tmp_path)
    assert found.verdict == "unexplained"
    (term,) = found.unexplained.proposal.terms
    assert (term.on, term.quantities) == ("sway", ("u", "v"))
    assert all(one.probability is None for one in found.selected)
