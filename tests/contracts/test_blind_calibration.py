"""The blind benchmark tells honest intervals and probabilities from others."""

import numpy as np
import pytest
from scipy.special import ndtr

from rovsim.benchmarks.blind.answers import KeptAnswer
from rovsim.benchmarks.blind.calibration import calibrate
from rovsim.benchmarks.blind.case import Case
from rovsim.benchmarks.blind.pictures import RANKS, RELIABILITY, write_pictures
from rovsim.benchmarks.blind.summary import summarize
from rovsim.benchmarks.blind.tables import write_markdown
from rovsim.dynamics.effect_entry import EffectEntry
from rovsim.results.blind_benchmark import BlindSummary
from rovsim.results.diagnosis import Answer, DiagnosisErrors
from synthetic_study import study

STD = 0.01


def kept(answer, *hidden, **fields):
    one = Case(id="pair/x/0", kind="pair", seed=3, hidden=hidden)
    return KeptAnswer(
        **{"digest": "", "method": "diagnosis", "case": one, "redrawn": False, "seconds": 2.0}
        | fields,
        diagnosis=answer,
    )


def answers(confidence=1.0, offset=0.0, count=400):
    """Fitted lags, and a drag of which one axis is hidden; all with the same relation to the truth.

    `confidence`: how many times smaller the deviations are than they should be.
    """
    random = np.random.default_rng(5)
    for k in range(count):
        lag, drag = 0.1 + 0.1 * random.random(), 50.0 * random.random()
        miss = STD * (random.normal(size=3) + offset)
        told = {"time_constant": {"value": lag + miss[0], "std": STD / confidence}}
        pair = {
            "surge": {"value": drag + 100.0 * miss[1], "std": 100.0 * STD / confidence},
            "sway": {"value": 100.0 * miss[2], "std": 100.0 * STD / confidence},
        }
        selected = [
            {"effect": "thruster_lag", "parameters": told, "probability": 0.7},
            {"effect": "quadratic_damping", "parameters": pair},
        ]
        hidden = (
            EffectEntry(effect="thruster_lag", parameters={"time_constant": lag}),
            EffectEntry(effect="quadratic_damping", parameters={"surge": drag}),
        )
        yield kept(Answer(verdict="missing_effects", selected=selected), *hidden, cpu_seconds=k)


def page(found):
    results = BlindSummary(suite="quick", seeds="reporting", methods={"diagnosis": found})
    return write_markdown(results)


def test_honest_intervals_are_called_so():
    found = calibrate(list(answers()))
    assert found.ranks.values == 3 * 400
    assert found.ranks.covered == pytest.approx(0.95, abs=0.02)
    assert found.ranks.stretch == pytest.approx(1.0, abs=0.1)
    assert found.ranks.p_value > 0.01
    assert set(found.effects) == {"thruster_lag", "quadratic_damping"}
    # a number that was fitted and is not hidden stands for its default
    assert found.parameters["quadratic_damping.sway"].covered == pytest.approx(0.95, abs=0.04)
    assert (
        "too"
        not in page(summarize(list(answers()))).split("**Are intervals")[1].split("ranks |")[1]
    )


@pytest.mark.parametrize(
    ("confidence", "covered", "said"),
    [(2.0, 2 * ndtr(0.98) - 1, "too narrow"), (0.5, 2 * ndtr(3.92) - 1, "too wide")],
)
def test_intervals_that_are_not_honest_are_told(confidence, covered, said):
    found = calibrate(list(answers(confidence)))
    assert found.ranks.covered == pytest.approx(covered, abs=0.03)
    assert found.ranks.stretch == pytest.approx(confidence, rel=0.1)
    assert found.ranks.p_value < 1e-6
    text = page(summarize(list(answers(confidence))))
    assert f"| {said} |" in text
    assert "honest, as far" not in text


def test_values_off_to_one_side_have_uneven_ranks():
    found = calibrate(list(answers(offset=0.5))).ranks
    assert found.p_value < 1e-6
    assert found.counts[-1] < 0.5 * found.counts[0]


def test_too_few_values_are_not_judged():
    found = calibrate(list(answers(count=9))).parameters["thruster_lag.time_constant"]
    assert (found.values, found.p_value) == (9, None)
    assert calibrate([]).ranks.covered is None


def test_false_names_have_no_truth_and_crashes_claim_nothing():
    wrong = Answer(
        verdict="missing_effects",
        selected=[{"effect": "lift", "parameters": {"coefficient": {"value": 3.0, "std": 1.0}}}],
    )
    assert calibrate([kept(wrong), kept(None, error="ValueError")]).ranks.values == 0


def test_a_probability_is_held_against_the_share_of_right_names():
    def named(probability, right):
        one = {"effect": "lift", "parameters": {}, "probability": probability}
        hidden = (EffectEntry(effect="lift", parameters={"coefficient": 9.0}),) if right else ()
        return kept(Answer(verdict="missing_effects", selected=[one]), *hidden)

    said = [named(0.99, k < 30) for k in range(40)] + [named(1.0, True) for _ in range(7)]
    found = calibrate([*said, named(None, False), named(None, True)])
    assert [(c.low, c.high, c.names, c.right) for c in found.probability] == [
        (0.99, 0.999, 40, 30),
        (0.999, 1.0, 7, 7),
    ]
    assert found.probability[0].claimed == pytest.approx(0.99)
    nothing = found.without_probability
    assert (nothing.low, nothing.names, nothing.right, nothing.claimed) == (None, 2, 1, None)


@pytest.mark.parametrize(("reached", "worse"), [(0.2, 0.0), (0.203, 0.0), (0.21, 1.0), (None, 1.0)])
def test_a_model_that_errs_more_on_test_runs_is_counted(reached, worse):
    error = DiagnosisErrors(nominal=0.2, with_effects=reached, noise_floor=None)
    found = study()["diagnosis"].model_copy(update={"error": error})
    assert summarize([kept(found)]).kinds["pair"].worse == worse
    untested = DiagnosisErrors(nominal=None, with_effects=None, noise_floor=None)
    found = study()["diagnosis"].model_copy(update={"error": untested})
    assert summarize([kept(found)]).kinds["pair"].worse is None


def test_times_are_told_by_median_and_tail():
    found = summarize(list(answers(count=101))).kinds["pair"]
    assert (found.cpu_seconds, found.cpu_seconds_95) == (50.0, 95.0)
    assert summarize([kept(None, error="x")]).kinds["pair"].cpu_seconds is None


def test_pictures_show_what_there_is(tmp_path):
    methods = {"diagnosis": summarize(list(answers(2.0)))}
    results = BlindSummary(suite="quick", seeds="reporting", methods=methods)
    drawn = write_pictures(tmp_path / "page.md", results)
    assert drawn == [RANKS, RELIABILITY]
    files = sorted(p.name for p in (tmp_path / "images").iterdir())
    assert files == [f"{RANKS}.png", f"{RELIABILITY}.png"]
    for name in drawn:
        assert f"(images/{name}.png)" in write_markdown(results, drawn)
        assert f"(images/{name}.png)" not in write_markdown(results)
    nothing = BlindSummary(suite="quick", seeds="reporting", methods={"diagnosis": summarize([])})
    assert write_pictures(tmp_path / "page.md", nothing) == []
    assert "Are intervals honest" not in write_markdown(nothing)
