"""The blind benchmark: valid cases, fair rules, and it goes on where it was."""

import numpy as np
import pytest

from rovsim.application.settings import BlindSettings
from rovsim.benchmarks.blind.answers import KeptAnswer
from rovsim.benchmarks.blind.case import SEED_RANGES, Case, Unlisted, seed_of
from rovsim.benchmarks.blind.flight import fly
from rovsim.benchmarks.blind.known_laws import LAWS
from rovsim.benchmarks.blind.law_score import error_drop, is_right, rate_laws
from rovsim.benchmarks.blind.methods import Method
from rovsim.benchmarks.blind.outside import OUTSIDE_EFFECTS, drawn_outside
from rovsim.benchmarks.blind.recipes import RECIPES, draw_by, usual_recipe
from rovsim.benchmarks.blind.recordings import KINDS
from rovsim.benchmarks.blind.run import Benchmark, pending, place, read_answers, run
from rovsim.benchmarks.blind.score import matching, score
from rovsim.benchmarks.blind.suites import FAMILIES, NO_FAMILY, suite
from rovsim.benchmarks.blind.summary import detection_limit, summarize
from rovsim.benchmarks.blind.tables import write_markdown
from rovsim.core.errors import BadInput
from rovsim.core.files import read_json
from rovsim.core.rotations import from_euler, matrix
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effect_entry import EffectEntry, build_effect
from rovsim.dynamics.effects.base import Wrench
from rovsim.dynamics.effects.damping import CubicDamping
from rovsim.dynamics.effects.dry_friction import DryFriction
from rovsim.dynamics.engine.types import EXAMPLE
from rovsim.dynamics.vehicle import load_vehicle
from rovsim.reporting.pages.marked import BEGIN, END, replace_tables
from rovsim.results.blind_benchmark import BlindSummary
from rovsim.results.diagnosis import Answer, Diagnosis, DiagnosisErrors, ProposedEquation
from synthetic_study import diagnosis as written_diagnosis

SHORT = {
    "duration": 2.0,
    "runs": [{"id": "a", "control": "6dof", "split": "train"}],
}
LAG = EffectEntry(effect="thruster_lag", parameters={"time_constant": 0.2})
DRAG = EffectEntry(effect="quadratic_damping", parameters={"surge": 80.0, "sway": 40.0})


def case(*hidden, **fields):
    return Case(**{"id": "single/x/0", "kind": "single", "seed": 3, "hidden": hidden, **fields})


def diagnosis(*named, verdict=None, groups=(), **parameters):
    """A diagnosis that selects these effects, the parameters given by effect."""
    selected = [{"effect": n, "parameters": parameters.get(n, {})} for n in named]
    verdict = verdict or ("missing_effects" if named else "adequate")
    return Answer(verdict=verdict, selected=selected, indistinguishable=groups)


# the suites


@pytest.mark.parametrize("name", ["quick", "standard", "full"])
def test_every_effect_of_the_catalogue_is_hidden_once_alone(name):
    assert set(RECIPES) == set(built_in()) >= frozenset.union(NO_FAMILY, *FAMILIES)
    alone = [c.hidden[0].effect for c in suite(name, "development") if c.kind == "single"]
    assert set(alone) == set(built_in())


# these two act only if several parameters change together, to what fits them
TOGETHER = {"onboard_control", "thruster_order"}


@pytest.mark.parametrize("name", sorted(set(built_in()) - TOGETHER))
def test_an_effect_without_a_recipe_of_its_own_can_be_hidden(name):
    effect = built_in()[name]
    for k in range(3):
        entry = draw_by(usual_recipe(effect), effect, 1.0, np.random.default_rng(k))
        assert build_effect(entry, built_in()).given()


def test_cases_are_valid_and_their_effects_do_something():
    cases = suite("full", "development")
    assert len({c.id for c in cases}) == len(cases)
    quick, standard = (suite(name, "development") for name in ("quick", "standard"))
    assert {c.id for c in quick} < {c.id for c in standard} < {c.id for c in cases}
    assert len({c.id for c in standard}) == len(standard)
    for one in cases:
        one.settings()
        for entry in one.hidden:
            assert build_effect(entry, built_in()).given()
        for unlisted in one.outside:
            assert unlisted.build().given()


def test_a_share_of_a_suite_is_a_random_sample_and_part_of_every_larger_one():
    def ids(share):
        asked = BlindSettings(suite="full", share=share)
        return {one.id for one in Benchmark.of(asked, None).cases}

    quarter, half, full = ids(0.25), ids(0.5), ids(1.0)
    assert quarter < half < full
    assert len(quarter) == pytest.approx(0.25 * len(full), rel=0.2)
    assert len(half) == pytest.approx(0.5 * len(full), rel=0.1)


def test_recordings_of_others_hide_what_they_show_and_what_they_cannot():
    cases = suite("recordings", "development")
    assert len({c.id for c in cases}) == len(cases) == 40
    assert {c.kind for c in cases} == set(KINDS)
    for one in cases:
        known = built_in().on(load_vehicle(one.settings().vehicle))
        assert all(build_effect(entry, known).given() for entry in one.hidden)
        assert not set(one.names) & set(one.silent)
        assert one.partial
    assert {len(c.silent) for c in cases} == {0, 1}
    assert [c for c in cases if not c.hidden]


def test_laboratories_have_everything_at_once():
    cases = [c for c in suite("laboratory", "development") if not c.outside]
    assert len({c.id for c in cases}) == len(cases) == 12
    assert {len([n for n in c.names if n != "pose_filter"]) for c in cases} == {3, 5}
    for one in cases:
        one.settings()
        assert {e.effect for e in one.hidden} > set(one.forgiven)
        assert ("colour_noise" in one.tank["camera"]) != ("pose_filter" in one.names)


def test_physics_of_no_entry_and_every_law_act_beside_a_wrong_file():
    cases = [c for c in suite("laboratory", "development") if c.outside]
    assert {one.name for c in cases for one in c.outside} == {*OUTSIDE_EFFECTS, *LAWS}
    assert len({c.id for c in cases}) == len(cases)
    for one in cases:
        one.settings()
        assert {e.effect for e in one.hidden} == set(one.forgiven)
        assert not one.names
        assert one.verdicts == {"unexplained"}


def test_strong_cases_hide_what_others_do_in_a_larger_size():
    usual = {c.id: c for c in suite("quick", "development")}
    for one in suite("strong", "development"):
        one.settings()
        (large,), (small,) = one.hidden, usual[f"single/{one.names[0]}/0"].hidden
        build = built_in()[large.effect]
        off = [build(**entry.values).values - build().values for entry in (large, small)]
        assert (np.abs(np.nan_to_num(off[0])) >= np.abs(np.nan_to_num(off[1]))).all()
        assert large.values != small.values


def test_laws_lie_outside_the_catalogue():
    cases = suite("equations", "development")
    assert len({c.id for c in cases}) == len(cases) == 61
    laws = [c for c in cases if c.kind == "law"]
    assert {c.outside[0].name for c in laws} == set(LAWS)
    assert not set(LAWS) & set(built_in())
    for one in laws:
        law = one.outside[0].build()
        assert law.given()
        assert not law.listed
        assert one.weaker().outside[0].build().values[0] == pytest.approx(0.8 * law.values[0], 1e-3)


def law(*terms, reached=0.05):
    """A diagnosis that proposes a law of these terms, (on, quantities, size)."""
    step = {"model": "+proposed_effect", "windows_2s": reached}
    ladder = {"schema": "rovsim.ladder/1", "steps": [step]}
    found = Diagnosis.model_validate(written_diagnosis(ladder))
    made = [{"on": on, "quantities": q.split(), "size": size} for on, q, size in terms]
    proposal = {
        "axis": "sway", "equation": "", "file": "proposed_effect.py", "parameters": {},
        "error_reduction": 0.5, "effect": "proposed_effect", "meaning": "", "terms": made,
    }  # fmt: skip
    left = found.unexplained.model_copy(
        update={"proposal": ProposedEquation.model_validate(proposal)}
    )
    error = DiagnosisErrors(nominal=0.3, with_effects=0.2, noise_floor=0.04)
    return found.model_copy(update={"unexplained": left, "error": error})


def test_an_equation_is_right_by_its_quantities_and_worth_what_it_takes_away():
    truth = LAWS["coupled_cubic"]
    for terms, right in (
        ([("sway", "u v", 2.0)], True),
        ([("sway", "u v", 2.0), ("roll", "w", 0.1)], True),
        ([("sway", "v", 2.0)], False),
        ([("sway", "u v", 2.0), ("sway", "r", 0.1)], False),
        ([("yaw", "u v", 2.0), ("sway", "u v", 0.1)], False),
    ):
        assert is_right(law(*terms).unexplained.proposal, truth) is right
    assert error_drop(law(("sway", "u v", 2.0), reached=0.04)) == pytest.approx(1.0)
    assert error_drop(law(("sway", "u v", 2.0), reached=0.12)) == pytest.approx(0.5)
    case = next(
        c for c in suite("equations", "development") if c.outside[0].name == "coupled_cubic"
    )
    good, bad = law(("sway", "u v", 2.0), reached=0.1), law(("sway", "v", 2.0), reached=0.19)
    answers = [
        KeptAnswer(digest="", method="d", case=case, redrawn=False, seconds=1.0, diagnosis=d)
        for d in (good, bad)
    ]
    rates = rate_laws(answers)["coupled_cubic"]
    assert (rates.proposed, rates.right, rates.half) == (1.0, 0.5, 0.5)
    assert rates == rate_laws(answers)["all laws"]


def test_seeds_of_the_two_ranges_are_disjoint_and_cases_repeatable():
    ranges = [set(range(first, last + 1)) for first, last in SEED_RANGES.values()]
    assert not ranges[0] & ranges[1]
    for seeds, allowed in zip(SEED_RANGES, ranges, strict=True):
        cases = suite("full", seeds)
        assert {c.seed for c in cases} <= allowed
        assert cases == suite("full", seeds)
    assert seed_of("single/lift/0", "development") != seed_of("single/lift/1", "development")


def test_weaker_cases_hide_the_same_but_less():
    cases = {c.id: c for c in suite("full", "development")}
    for name in ("thruster_lag", "quadratic_damping", "thruster_gain", "payload", "pose_filter"):
        full, tenth = cases[f"single/{name}/0"], cases[f"weak 0.1/{name}/0"]
        strong, weak = (build_effect(one.hidden[0], built_in()) for one in (full, tenth))
        for p, a, b in zip(strong.parameters, strong.values, weak.values, strict=True):
            kept = p.name in RECIPES[name].fixed
            expected = a if kept else p.combine(p.neutral_value, a, 0.1)
            assert b == pytest.approx(expected, rel=1e-3)


def test_sets_hold_effects_of_different_families():
    for one in suite("full", "reporting"):
        if one.kind in ("pair", "triple"):
            names = [e.effect for e in one.hidden]
            assert len(names) == {"pair": 2, "triple": 3}[one.kind]
            assert all(len(family & set(names)) <= 1 for family in FAMILIES)


@pytest.mark.parametrize("name", OUTSIDE_EFFECTS)
def test_outside_physics_never_enters_the_catalogue(name):
    found = drawn_outside(name, 1.0, np.random.default_rng(0))
    assert name not in built_in()
    assert all([found.__doc__, found.equation, found.neglects, found.source])
    with pytest.raises(BadInput, match="unknown effect"):
        build_effect(EffectEntry(effect=name), built_in())


def pushes(effect, count=400):
    """Wrench (count, 6) on a vehicle that moves and leans at random."""
    random, found = np.random.default_rng(0), []
    for k in range(count):
        nu = tuple(random.uniform(-0.5, 0.5, 6))
        R = matrix(from_euler(*random.uniform(-0.4, 0.4, 3)))
        place = tuple(random.uniform(1.0, 3.0, 3))
        at = EXAMPLE._replace(t=0.1 * k, duration=40.0, nu=nu, nu_r=nu, R=R, position=place)
        found.append(type(effect).wrench(at, effect.named_parameters()(*effect.values)))
    return np.array(found)


@pytest.mark.parametrize(
    "name", [n for n, cls in OUTSIDE_EFFECTS.items() if issubclass(cls, Wrench)]
)
def test_outside_physics_is_no_drag_law_of_the_catalogue(name):
    found = pushes(drawn_outside(name, 1.0, np.random.default_rng(0)))
    pushed = np.flatnonzero(np.any(found != 0.0, axis=0))
    assert len(pushed)
    for law in (CubicDamping, DryFriction):
        tried = pushes(law(**{p.name: p.scale for p in law.parameters}))
        for axis in pushed:
            alike = np.corrcoef(found[:, axis], tried[:, axis])[0, 1]
            assert abs(alike) < 0.5, law.id


# flying


def test_the_same_case_gives_the_same_bytes_and_no_truth_beside_them(tmp_path):
    one = case(LAG, tank=SHORT, outside=[Unlisted(name="backlash", parameters={"width": 2.0})])
    assert fly(one, tmp_path / "a") == fly(one, tmp_path / "b") == one
    names = sorted(p.name for p in (tmp_path / "a").iterdir())
    assert names == ["a_6D.tsv", "a_commands.csv", "campaign.yaml"]
    for name in names:
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()
    fly(case(LAG, tank=SHORT), tmp_path / "c")
    assert (tmp_path / "c/a_6D.tsv").read_bytes() != (tmp_path / "a/a_6D.tsv").read_bytes()


def test_what_leaves_the_tank_is_flown_again_weaker(tmp_path):
    strong = EffectEntry(effect="net_buoyancy", parameters={"force": 300.0})
    flown = fly(case(strong, tank=SHORT), tmp_path / "c")
    assert flown.strength < 1.0
    assert flown.hidden[0].parameters["force"].value == pytest.approx(
        300.0 * flown.strength, rel=1e-2
    )


# the score


def test_the_truth_itself_is_exact():
    answer = {"time_constant": {"value": 0.21, "std": 0.01}}
    found = score(case(LAG), diagnosis("thruster_lag", thruster_lag=answer))
    assert found.verdict
    assert found.first
    assert found.exact_strict
    assert found.false == 0
    assert found.parameters[0].error == pytest.approx(0.05)
    assert found.parameters[0].covered


def test_an_equivalent_name_is_exact_leniently_alone():
    alike = ["input_delay", "thruster_lag"]
    found = score(case(LAG), diagnosis("input_delay", groups=[alike]))
    assert (found.exact, found.exact_strict, found.alike) == (True, False, 2)
    assert (found.first, found.first_strict) == (True, False)
    assert (found.false, found.false_strict) == (0, 1)
    assert not score(case(LAG), diagnosis("input_delay")).exact


def test_one_name_does_not_stand_for_two_effects():
    group = {"a", "b", "c"}
    assert matching(["c"], ["a", "b"], [group]) == 1
    assert matching(["c", "a"], ["a", "b"], [group]) == 2
    assert matching(["a", "c"], ["a", "b"], [{"b", "c"}]) == 2
    assert matching(["x"], ["a"], [group]) == 0


def test_a_second_name_is_false_and_a_missing_one_is_not_exact():
    more = score(case(LAG), diagnosis("thruster_lag", "lift"))
    assert (more.exact, more.first, more.false) == (False, True, 1)
    fewer = score(case(LAG, DRAG), diagnosis("thruster_lag"))
    assert (fewer.exact, fewer.first, fewer.false) == (False, True, 0)


def test_what_the_runs_cannot_show_has_a_column_of_its_own():
    both = case(LAG, DRAG)
    named = diagnosis("thruster_lag").model_copy(update={"not_observable": ("quadratic_damping",)})
    assert (score(both, named).exact, score(both, named).unseen) == (False, True)
    assert not score(both, diagnosis("thruster_lag")).unseen
    assert not score(case(LAG), named).unseen  # exact
    other = diagnosis("thruster_lag", "lift").model_copy(
        update={"not_observable": ("quadratic_damping",)}
    )
    assert not score(both, other).unseen
    silent = diagnosis().model_copy(update={"not_observable": ("quadratic_damping",)})
    assert score(case(DRAG), silent).unseen
    still = silent.model_copy(update={"verdict": "insufficient_data"})
    assert score(case(DRAG), still).unseen
    assert not score(both, still).unseen  # the lag was to be found
    assert not score(case(DRAG), still.model_copy(update={"not_observable": ()})).unseen


def test_what_cannot_be_shown_must_be_said_and_not_named():
    silent = case(DRAG, silent=("quadratic_damping",))
    said = diagnosis().model_copy(update={"not_observable": ("quadratic_damping",)})
    assert score(silent, said).exact
    assert not score(silent, diagnosis()).exact
    assert not score(silent, diagnosis("quadratic_damping")).exact


def test_a_number_left_out_says_the_default():
    answer = {"surge": {"value": 88.0, "std": 2.0}}
    found = score(case(DRAG), diagnosis("quadratic_damping", quadratic_damping=answer)).parameters
    assert [(p.name, round(p.error, 6), p.covered) for p in found] == [
        ("surge", 0.1, False),
        ("sway", 1.0, None),
    ]


def test_nothing_hidden_asks_for_nothing():
    assert score(case(), diagnosis()).exact
    alarm = score(case(), diagnosis("lift"))
    assert not alarm.verdict
    assert alarm.first is None
    assert alarm.false == 1
    assert not score(case(), diagnosis(verdict="unexplained")).verdict


def test_a_deviation_may_be_named_or_not():
    off = case(DRAG, forgiven=["quadratic_damping", "linear_damping"])
    assert score(off, diagnosis()).exact
    assert score(off, diagnosis("quadratic_damping")).exact
    assert not score(off, diagnosis("lift")).exact
    assert not score(off, diagnosis(verdict="unexplained")).verdict


def test_outside_physics_has_to_be_flagged():
    strange = case(outside=[Unlisted(name="tone", parameters={"force": 3.0})])
    assert score(strange, diagnosis(verdict="unexplained")).exact
    assert not score(strange, diagnosis()).verdict
    assert not score(strange, diagnosis("lift")).verdict


def test_the_detection_limit_is_where_half_are_named():
    rows = [(1.0, True)] * 4 + [(0.5, True)] * 4 + [(0.25, False)] * 4
    assert detection_limit(rows) == pytest.approx(np.sqrt(0.125))
    assert detection_limit([(1.0, False), (0.5, True), (0.1, False)] * 2) == pytest.approx(0.5)
    assert detection_limit([(1.0, False), (0.5, False)]) is None
    assert detection_limit([(1.0, True), (0.5, True)]) == 0.5


# running


def stub(campaign, out):
    """Answers by the book, and leaves a trace of having been asked."""
    trace = STATE["folder"] / "asked"
    trace.write_text(trace.read_text() + "x" if trace.exists() else "x")
    if STATE["crash"]:
        raise ValueError("no idea")
    assert (campaign / "campaign.yaml").exists()
    assert not (campaign / "truth.yaml").exists()
    return diagnosis("thruster_lag")


STATE: dict = {}


@pytest.fixture
def asked(tmp_path):
    STATE.update(folder=tmp_path, crash=False)
    trace = tmp_path / "asked"
    return lambda: len(trace.read_text()) if trace.exists() else 0


def ask(cases, method, folder):
    """What is missing, or was answered by other code."""
    run(list(pending(cases, [method], folder)))


def test_what_was_answered_is_not_asked_again(tmp_path, asked):
    cases = [case(LAG, tank=SHORT, id=f"single/{k}", seed=k) for k in range(2)]
    method = Method("stub", stub, ("rovsim.core.errors",))
    ask(cases[:1], method, tmp_path / "r")
    assert asked() == 1
    ask(cases, method, tmp_path / "r")
    assert asked() == 2
    ask(cases, method, tmp_path / "r")
    assert asked() == 2
    changed = Method("stub", stub, ("rovsim.core.errors", "rovsim.evaluation.latency"))
    ask(cases[:1], changed, tmp_path / "r")
    assert asked() == 3
    found = summarize(read_answers(cases, method, tmp_path / "r"))
    assert found.kinds["single"].exact == 1.0


def test_a_crash_is_a_wrong_answer_and_is_told(tmp_path, asked):
    STATE["crash"] = True
    one, method = case(LAG, tank=SHORT), Method("stub", stub, ("rovsim.core.errors",))
    ask([one], method, tmp_path)
    assert "no idea" in read_json(place(tmp_path, method, one))["error"]
    found = summarize(read_answers([one], method, tmp_path))
    assert found.failed == (one.id,)
    assert found.kinds["single"].exact == 0.0


def test_the_page_gets_its_tables_between_the_marks(tmp_path):
    page = tmp_path / "page.md"
    page.write_text(f"before\n{BEGIN}\nlast year's\n{END}\nafter\n")
    answer = KeptAnswer(
        digest="",
        method="diagnosis",
        case=case(LAG),
        redrawn=False,
        seconds=1.5,
        diagnosis=diagnosis("thruster_lag"),
    )
    methods = {"diagnosis": summarize([answer])}
    results = BlindSummary(suite="quick", seeds="reporting", methods=methods)
    for _ in range(2):
        replace_tables(page, write_markdown(results))
    text = page.read_text()
    assert text.startswith("before")
    assert text.endswith("after\n")
    assert "last year's" not in text
    assert "| thruster_lag | 100 % | 100 % |" in text
    page.write_text("no marks")
    with pytest.raises(BadInput, match="marks"):
        replace_tables(page, "")
