"""Odds and probabilities of explanations, however far apart they are."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rovsim.core.odds import lr_statistic_of, odds_of, probability_of, share_odds

STATISTICS = st.floats(-1e6, 1e6)


@given(STATISTICS)
def test_one_of_two_holds(lr_statistic):
    both = probability_of(lr_statistic) + probability_of(-lr_statistic)
    assert both == pytest.approx(1.0)
    assert share_odds([0.0, -lr_statistic])[0] == pytest.approx(probability_of(lr_statistic))


@given(st.lists(STATISTICS, min_size=1), STATISTICS)
def test_one_of_several_holds_whatever_all_are_measured_from(statistics, offset):
    shares = share_odds(statistics)
    assert shares.sum() == pytest.approx(1.0)
    assert np.all((shares >= 0.0) & (shares <= 1.0))
    assert shares[np.argmax(statistics)] == shares.max()
    np.testing.assert_allclose(share_odds(np.array(statistics) + offset), shares, atol=1e-6)


def test_what_cannot_be_has_no_share_and_odds_come_back():
    assert share_odds([0.0, -np.inf]).tolist() == [1.0, 0.0]
    assert odds_of(lr_statistic_of(20.0)) == pytest.approx(20.0, rel=0.01)
