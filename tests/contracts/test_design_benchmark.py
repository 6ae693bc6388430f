"""The benchmark of designs: its cases hide and ask what they say, its table counts what it kept."""

import json

import pytest

from rovsim.application.configuration import compose
from rovsim.benchmarks.designs.cases import FLIGHT_SECONDS, ask, hide, list_cases
from rovsim.benchmarks.designs.table import tabulate
from rovsim.dynamics.catalogue import built_in
from rovsim.results.design_benchmark import FlownCase, ReachedOdds, ReachedStd, ThroughWall
from rovsim.results.experiment import Expected, Surer

PAIR, VALUE = "dry_friction+linear_damping", "net_buoyancy.force"
WALL = ThroughWall(left="through the floor after 3 s")


def test_pairs_and_values_come_in_turns_each_once():
    cases = list_cases()
    assert len(set(cases)) == len(cases) == 40
    assert ["+" in one for one in cases] == 20 * [True, False]


@pytest.mark.parametrize("case", list_cases())
def test_a_case_hides_what_it_names_and_asks_for_it(case):
    tank, question = hide(case, "development"), ask(case, compose([]))
    (entry,) = tank.effects
    assert tank.duration == FLIGHT_SECONDS
    assert hide(case, "development") == tank
    assert hide(case, "reporting").seed != tank.seed
    if "+" in case:
        assert question.between == tuple(case.split("+"))
        assert (entry.effect, question.know) == (question.between[0], ())
    else:
        assert (question.between, question.know) == ((), (case,))
        assert [f"{entry.effect}.{name}" for name in entry.values] == [case]
    declared = {p.name: p for p in built_in()[entry.effect].parameters}
    assert any(value != declared[name].neutral_value for name, value in entry.values.items())


def flown(case, designed, usual=None, **fields):
    """A case as it is kept; its value was promised to 0.5."""
    known = {"promised": Expected(std={case: Surer(now=3.0, then=0.5)}), "manoeuvre": "designed"}
    took = {"seconds": 30.0, "cpu_seconds": 20.0}
    known |= took | {"hidden": (), "best_usual": None, "expected_ratio": None}
    return FlownCase(**{**known, "case": case, "designed": designed, "usual": usual, **fields})


def odds(log_odds):
    return ReachedOdds(log_odds=log_odds, log_odds_before=1.0)


def std(reached, gained):
    return ReachedStd(std=reached, std_before=3.0, gained=gained, value=2.0)


def test_the_table_counts_what_is_better_than_the_best_usual_manoeuvre():
    pairs = [
        flown(PAIR, odds(9.0), odds(2.0)),
        flown(PAIR, odds(9.0), odds(6.0), seconds=50.0, cpu_seconds=40.0),
        flown(PAIR, odds(9.0)),
        flown(PAIR, WALL, odds(2.0)),
        flown(PAIR, odds(4.0), odds(2.0)),
    ]
    values = [
        flown(VALUE, std(0.6, 24.0), std(1.5, 3.0)),
        flown(VALUE, std(0.5, 8.0), std(1.0, 4.0)),
        flown(VALUE, WALL, WALL),
    ]
    assert tabulate([*pairs, *values]).splitlines() == [
        "8 flights, 2 through a wall; a design took 30 s (median), at most 50 s; of the processor "
        "20 and 40 s.",
        "Pairs: 3 of 5 with twice the log odds of the best usual manoeuvre, median 2.0 times.",
        "Values: 1 of 3 with three times the information, median 2.0 times; the interval reached "
        "is off by 10 % of what was promised (median).",
    ]


@pytest.mark.parametrize(("one", "line"), [(PAIR, "Pairs: 1 of 1"), (VALUE, "Values: 1 of 1")])
def test_a_usual_flight_through_a_wall_told_nothing(one, line):
    told = odds(4.0) if one == PAIR else std(0.5, 8.0)
    first, second = tabulate([flown(one, told, WALL)]).splitlines()
    assert first.startswith("1 flights, 0 through a wall")
    assert second.startswith(line)


@pytest.mark.parametrize("usual", [WALL, odds(2.0), std(0.5, 8.0)])
def test_a_case_is_read_as_it_was_written(tmp_path, usual):
    case = flown(PAIR, odds(4.0), usual)
    case.write(tmp_path / "case.json")
    assert FlownCase.read(tmp_path / "case.json") == case


def test_a_case_without_a_usual_manoeuvre_has_no_key_of_it(tmp_path):
    case = flown(VALUE, std(0.5, 8.0)).model_dump(exclude={"usual"})
    FlownCase(**case).write(tmp_path / "case.json")
    written = json.loads((tmp_path / "case.json").read_text())
    assert written["designed"] == {"std": 0.5, "std_before": 3.0, "gained": 8.0, "value": 2.0}
    assert written["promised"]["std"][VALUE] == {"now": 3.0, "then": 0.5}
    assert "usual" not in written
