"""Bands hold what they promise, know what they do not know, and travel with the model's file."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from rovsim.core.errors import BadInput
from rovsim.core.yaml_files import read_yaml
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effects.current import CurrentDrift
from rovsim.dynamics.effects.damping import QuadraticDamping
from rovsim.dynamics.effects.thrusters import ThrusterLag
from rovsim.dynamics.model_file import read_model, write_model
from rovsim.dynamics.uncertainty import Draws, Uncertainty, correlate
from rovsim.evaluation.coverage import cover
from rovsim.results.fitted import Correlation, FittedNoise
from rovsim.simulation.bands import BAND_LEVEL, band_ends, predict_band, why_without_bands
from rovsim.simulation.ensemble import Ensemble
from rovsim.simulation.noise_draws import NoiseDraws
from rovsim.simulation.replay import ReplayCase, find_spans, predict, predict_all
from rovsim.simulation.settings import SimulationSettings
from rovsim.simulation.step_grid import StepGrid
from rovsim.simulation.stepper import Stepper
from worlds import at_rest, model, motion, sticks

SETTINGS = SimulationSettings()
NOISE = FittedNoise(
    disturbance=(0.02,) * 3 + (0.05,) * 3,
    memory_s=(0.8,) * 6,
    reading=(3e-4,) * 3 + (1e-3,) * 3,
    period_s=0.05,
)
SILENT = FittedNoise(disturbance=(0.0,) * 6, memory_s=(1.0,) * 6, reading=(0.0,) * 6, period_s=0.05)
DRAG, LAG = QuadraticDamping(surge=40.0), ThrusterLag(time_constant=0.2)
BETWEEN = ("quadratic_damping.surge", "thruster_lag.time_constant")
TOGETHER = np.array([[4.0, -0.019], [-0.019, 1e-4]])  # of drag and lag: correlation -0.95


def known(noise=NOISE, drag_std=2.0, instead=(), correlation=None):
    """Drag and a lag, as sure as `TOGETHER` says, or only of themselves."""
    found = model(DRAG.with_std({"surge": drag_std}), LAG.with_std({"time_constant": 0.01}))
    told = correlate(TOGETHER, BETWEEN) if correlation is None else correlation
    return replace(found, uncertainty=Uncertainty(noise, Draws(found.added, told), instead))


SURE = replace(model(DRAG, LAG), uncertainty=Uncertainty(SILENT, Draws((DRAG, LAG), Correlation())))


def flown(world, random, seconds=60.0):
    """A run of a vehicle under sticks: as a perfect model predicts it, disturbed and misread."""
    still = motion(sticks(3, 60), seconds=seconds)
    clean = predict(world, still, [(0, len(still.time) - 1)], SETTINGS)
    noise = NoiseDraws.of(NOISE, random)
    (pushed,) = noise.draw_disturbance(np.diff(StepGrid.over(still, SETTINGS.replay.step).edges), 1)
    whole = [(0, len(still.time) - 1)]
    (happened,) = predict_all([ReplayCase(world, still, pushed)], whole, SETTINGS)
    eta, nu = happened.eta.copy(), happened.nu.copy()
    eta[0], nu[0] = still.eta[0], still.nu[0]
    true = replace(still, eta=eta, nu=nu, state_nu=nu, nu_dot=np.nan_to_num(happened.nu_dot))
    assert np.abs(happened.nu[1:] - clean.nu[1:]).max() > 0.01
    return noise.resample_measurement_noise(true, world.mocap_view, SETTINGS.signals, 1)[0]


def test_a_band_holds_its_share_of_what_happens_to_such_a_vehicle():
    world, random = known(), np.random.default_rng(4)
    shares = []
    for _ in range(3):
        run = flown(world.draw(random), random)
        spans = find_spans(run, SETTINGS.replay.only(2.0), open_loop=False)["2"]
        found = cover(run, predict_band(world, run, spans, SETTINGS), spans)
        assert found.windows == len(spans)
        shares.append(found.at_end.array())
    # 29 windows of 2 s, 6 axes, 3 runs: half a thousand points that are nearly independent
    assert np.mean(shares) == pytest.approx(BAND_LEVEL, abs=4 * np.sqrt(0.09 / 522))


def test_a_band_that_is_too_narrow_is_found_out():
    random = np.random.default_rng(4)
    run = flown(known(), random)
    calm = NOISE.model_copy(update={"disturbance": (0.005,) * 3 + (0.0125,) * 3})
    spans = find_spans(run, SETTINGS.replay.only(2.0), open_loop=False)["2"]
    found = cover(run, predict_band(known(calm), run, spans, SETTINGS), spans)
    assert np.mean(found.at_end.array()) < BAND_LEVEL - 0.1


def test_where_nothing_is_left_to_chance_the_band_is_the_prediction():
    run = motion(sticks(), seconds=8.0)
    spans = find_spans(run, SETTINGS.replay.only(2.0), open_loop=False)["2"]
    band = predict_band(SURE, run, spans, SETTINGS)
    found = predict(SURE, run, spans, SETTINGS)
    np.testing.assert_allclose(band.nu[0], found.nu, atol=1e-9)
    np.testing.assert_allclose(band.nu[1], found.nu, atol=1e-9)
    np.testing.assert_allclose(band.place[0, :, :3], found.eta[:, :3], atol=1e-9)


def test_a_band_begins_at_what_was_measured_and_opens():
    run = motion(sticks(), seconds=8.0)
    spans = find_spans(run, SETTINGS.replay.only(2.0), open_loop=False)["2"]
    band = predict_band(known(), run, spans, SETTINGS)
    width = band.place[1] - band.place[0]
    first, last = spans[0][0] + 1, spans[0][1]
    assert np.isnan(width[spans[0][0]]).all()
    assert (width[first] < 0.2 * width[last]).all()
    assert (width[first] < 2e-4).all()


def test_a_long_run_is_done_in_parts_that_do_not_show(monkeypatch):
    run = motion(sticks(), seconds=24.0)
    spans = find_spans(run, SETTINGS.replay.only(2.0), open_loop=False)["2"]
    whole = predict_band(SURE, run, spans, SETTINGS)
    monkeypatch.setattr("rovsim.simulation.bands.MAX_GROUP_S", 4.0)
    parts = predict_band(SURE, run, spans, SETTINGS)
    np.testing.assert_allclose(parts.nu, whole.nu, atol=1e-5)
    assert np.isnan(predict_band(SURE, run, [(0, 2400)], SETTINGS).nu).all()


def test_draws_spread_and_hang_together_as_the_file_says():
    random = np.random.default_rng(0)
    drawn = [known().uncertainty.draw(random) for _ in range(1000)]
    values = np.array([[drag["surge"], lag["time_constant"]] for drag, lag in drawn])
    np.testing.assert_allclose(values.mean(axis=0), [40.0, 0.2], rtol=0.01)
    np.testing.assert_allclose(np.cov(values.T), TOGETHER, rtol=0.2)


def test_other_names_are_drawn_as_often_as_they_are_likely():
    other = Draws((QuadraticDamping(sway=30.0),), Correlation())
    world = known(instead=((0.25, other),))
    random = np.random.default_rng(1)
    share = np.mean([len(world.uncertainty.draw(random)) == 1 for _ in range(2000)])
    assert share == pytest.approx(0.25, abs=0.04)


def test_what_no_body_can_have_is_not_drawn():
    random = np.random.default_rng(2)
    wide = known(drag_std=1e9)
    for _ in range(20):
        surge = wide.draw(random).added[0]["surge"]
        low = next(p.low for p in QuadraticDamping.parameters if p.name == "surge")
        assert surge >= low


def test_how_sure_a_model_is_comes_back_from_its_file(tmp_path):
    world = known(instead=((0.2, Draws((DRAG.with_std({"surge": 1.0}),), Correlation())),))
    write_model(world, tmp_path / "m.yaml")
    back = read_model(tmp_path / "m.yaml", built_in())
    assert back.uncertainty.noise == NOISE
    assert back.uncertainty.own.correlation == world.uncertainty.own.correlation
    a, b = (m.draw(np.random.default_rng(5)) for m in (world, back))
    assert [e.given() for e in a.added] == [e.given() for e in b.added]
    assert back.uncertainty.instead[0][0] == 0.2


def test_another_model_does_not_inherit_it(tmp_path):
    world = known()
    assert (world + QuadraticDamping(sway=1.0)).uncertainty is None
    assert world.draw(np.random.default_rng(0)).uncertainty is None
    assert world.called("other").uncertainty is world.uncertainty
    stored = SimpleNamespace(model_dump=lambda mode: {"kind": "knn"})
    write_model(world, tmp_path / "m.yaml", stored)
    assert {"residual"} == {"residual", "uncertainty"} & read_yaml(tmp_path / "m.yaml").keys()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("correlation: {between: [a.b], rows: [[1.0], [0.5]]}", "1 rows, of 1 to 1 numbers"),
        ("correlation: {between: [a.b], rows: [[2.0]]}", "correlations from -1 to 1"),
        ("instead: [{probability: 0.7, effects: []}, {probability: 0.7, effects: []}]", "add up"),
        ("instead: [{probability: 2, effects: []}]", "probability"),
        ("instead: [{probability: 0.1, effects: [{effect: nobody}]}]", "nobody"),
        ("noise: 3", "noise"),
        ("noise: {disturbance: [-1, 1, 1, 1, 1, 1]}", "noise.disturbance.0' is -1. .*equal to 0"),
        ("noise: {reading: [1, 1, 1, 1, 1, 1e300]}", "noise of at most 1000"),
        ("noise: {memory_s: [0, 1, 1, 1, 1, 1]}", "memory_s.0' is 0. .*greater than 0"),
        ("noise: {period_s: 0}", "period_s' is 0. .*greater than 0"),
        ("noise: {colour: [1, 1, 1]}", "noise.colour' .* six values"),
        ("noise: {colour: [1, 1, 1, 1, 1, .inf]}", "noise.colour"),
        ("correlation: {between: [drag.surge], rows: [[1.0]]}", "correlation of 'drag.surge'"),
        ("correlation: {between: [a, a], rows: [[1], [1, 1]]}", "each named once"),
        ("correlation: {between: [a, b, c], rows: [[1], [-1, 1], [-1, -1, 1]]}", "all at once"),
        (
            "instead: [{probability: 0.1, effects: [{effect: lift, parameters: {coefficient: "
            "{value: 1, std: -1}}}]}]",
            "std' is -1",
        ),
        (
            "instead: [{probability: 0.1, effects: [{effect: lift, parameters: {coefficient: "
            "{value: 1, std: 1}}}], correlation: {between: [lift.coeff], rows: [[1]]}}]",
            "Did you mean 'lift.coefficient'",
        ),
    ],
)
def test_a_file_that_says_it_wrongly_is_refused(text, said, tmp_path):
    rest = "" if text.startswith("noise") else ", noise: {}"
    (tmp_path / "m.yaml").write_text(
        f"schema: rovsim.model/1\nvehicle: bluerov2_heavy\nuncertainty: {{{text}{rest}}}\n"
    )
    with pytest.raises(BadInput, match=said):
        read_model(tmp_path / "m.yaml", built_in())


def test_where_nobody_knows_it_says_why():
    run = motion(sticks(), seconds=8.0)
    spans = find_spans(run, SETTINGS.replay.only(2.0), open_loop=False)["2"]
    wanders = known()
    wanders = replace(wanders, added=(*wanders.added, CurrentDrift(rate=0.01)))
    for world, why in [
        (model(), "rovsim add"),
        (known(FittedNoise()), "what noise"),
        (wanders, "wanders"),
    ]:
        assert why in why_without_bands(world, run)
        assert predict_band(world, run, spans, SETTINGS) is None
    assert why_without_bands(known(), run) is None


def test_ends_leave_out_as_much_on_either_side():
    random = np.random.default_rng(7)
    draws, others = random.normal(size=(39, 5000)), random.normal(size=5000)
    low, high = band_ends(draws)
    assert np.mean(others < low) == pytest.approx(0.05, abs=0.01)
    assert np.mean(others > high) == pytest.approx(0.05, abs=0.01)


def test_an_ensemble_without_chance_steps_as_the_model():
    ensemble, one = Ensemble(SURE, draws=3), Stepper(SURE)
    states, state = ensemble.start(at_rest()), at_rest()
    for command in sticks():
        states, state = ensemble.step(states, command, 0.02), one.step(state, command, 0.02)
    np.testing.assert_allclose(states, np.tile(state, (3, 1)), atol=1e-12)
    np.testing.assert_allclose(ensemble.band(states), np.tile(state, (2, 1)), atol=1e-12)


def test_an_ensemble_spreads_as_wide_as_the_band_of_a_replay(monkeypatch):
    monkeypatch.setattr("rovsim.simulation.bands.DRAWS", 79)
    world, run = known(), motion(sticks(), seconds=4.0)
    quiet = NOISE.model_copy(update={"reading": (0.0,) * 6})
    world = replace(world, uncertainty=replace(world.uncertainty, noise=quiet))
    band = predict_band(world, run, [(0, 200)], SETTINGS)
    ensemble = Ensemble(world, draws=79, seed=3)
    states, log = ensemble.start(at_rest()), run.commands
    for k in range(200):
        line = int(np.searchsorted(log.time, run.time[k], "right")) - 1
        states = ensemble.step(states, log.value[line], 0.01)
    low, high = ensemble.band(states)
    ratio = (high - low)[7:] / (band.nu[1, 200] - band.nu[0, 200])
    np.testing.assert_allclose(ratio, 1.0, atol=0.5)  # an end of 79 draws errs by a sixth
    assert np.mean(ratio) == pytest.approx(1.0, abs=0.2)


def test_an_ensemble_of_a_model_that_is_not_known_is_refused():
    with pytest.raises(BadInput, match="how sure"):
        Ensemble(model())
