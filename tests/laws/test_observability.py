"""What the runs could not show is said, and only that."""

import numpy as np

from flown import observed
from rovsim.diagnosis.checks.observability import DETECTION_STDS, find_shown, list_not_observable
from rovsim.diagnosis.selection.search_result import SearchResult
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.diagnosis.settings import SearchSettings
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effect_entry import EffectEntry
from rovsim.dynamics.effects.onboard_control import OnboardControl
from rovsim.estimation.candidates import list_candidates
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.noise import FIRST_NOISE
from rovsim.estimation.sensitivities import linearise_candidates, measure_columns
from rovsim.estimation.white_columns import WhiteColumns
from rovsim.simulation.synthetic_tank.settings import Log

LOOPS = {
    f"{name}_{axis}": value
    for axis in ("roll", "pitch", "yaw")
    for name, value in (("gain", 0.7), ("bandwidth", 2.0))
}
PENALTY = 10.0
TRIED = ("propeller_torque", "thruster_deadband", "quadratic_damping")


def test_behind_loops_about_all_angles_the_torque_of_propellers_cannot_be_seen(tmp_path):
    """In demands of surge, sway and heave those of left- and right-handed ones add to zero."""
    entry = EffectEntry(effect=OnboardControl.id, parameters=LOOPS)
    base, runs = observed(tmp_path, duration=20.0, effects=(entry,), log=Log(kind="demand"))
    bank = FilterBank.design(runs, base, FIRST_NOISE)
    listed = list_candidates(runs, built_in(), base.vehicle)
    some = [c for c in listed if c.effect.id in TRIED]
    known = linearise_candidates(bank, Hypothesis(base), some)
    workspace = SearchWorkspace.begin(WhiteColumns(bank, known, FIRST_NOISE), SearchSettings())
    loops = Term(OnboardControl(**LOOPS), tuple(LOOPS))
    with_loops, without = (
        list_not_observable(
            SearchResult(workspace, workspace.fit(h), (), True), built_in(), base.vehicle
        )
        for h in (Hypothesis(base, (loops,)), Hypothesis(base))
    )
    assert with_loops == ("propeller_torque",)
    assert without == ()


def test_what_has_no_slope_has_no_column(tmp_path):
    """In the plane a small tilt changes a reading by its square: of that, no part is a slope."""
    box = {"x": (0.0, 20.0), "y": (0.0, 20.0), "z": (0.0, 3.0)}
    base, runs = observed(tmp_path, duration=20.0, vehicle="cybership2", tank=box)
    bank = FilterBank.design(runs, base, FIRST_NOISE)
    listed = list_candidates(runs, built_in(), base.vehicle)
    tilts = [c for c in listed if c.effect.id == "world_tilt"]
    found = linearise_candidates(bank, Hypothesis(base), tilts)
    assert found.count
    assert all(not own.any() for own in found.columns)


def test_what_acts_on_axes_that_nobody_reads_has_no_length(tmp_path):
    """Markers that lean turn a ship about its roll, which x, y and yaw do not tell."""
    base, runs = observed(tmp_path, duration=20.0)
    bank = FilterBank.design(runs, base, FIRST_NOISE)
    listed = list_candidates(runs, built_in(), base.vehicle)
    (lean,) = (c for c in listed if c.effect.id == "marker_misalignment")
    columns = bank.linearise(Hypothesis(base, (lean.term(),))).J
    in_roll = [own * (np.arange(6) == 3)[:, None] for own in columns]
    assert (measure_columns(bank, in_roll) > 0.0).all()
    for run in runs:
        vars(run)["innovation_mask"] = run.innovation_mask & (np.arange(6) != 3)
    assert not measure_columns(bank, in_roll).any()
    assert (measure_columns(bank, columns) > 0.0).all()


def test_of_a_larger_vehicle_more_is_worth_looking_for(tmp_path):
    """A drag of ten N s/m is nothing to a vehicle of three tonnes, a thousand is."""
    base, runs = observed(tmp_path, duration=20.0)
    bank = FilterBank.design(runs, base, FIRST_NOISE)
    listed = list_candidates(runs, built_in(), base.vehicle)
    known = linearise_candidates(
        bank, Hypothesis(base), [c for c in listed if c.effect.id == "linear_damping"]
    )
    (block,) = known.blocks
    needed = np.sqrt(PENALTY) + DETECTION_STDS
    sizes = np.full(known.count, 0.1 * needed)
    assert find_shown(sizes, [block], PENALTY, 1.0) == {"linear_damping": False}
    assert find_shown(sizes, [block], PENALTY, 11.0) == {"linear_damping": True}
