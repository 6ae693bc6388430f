"""Advise what to record next, so that the next diagnosis is surer."""

from typing import Sequence

from rovsim.diagnosis.checks.wrong_units import list_absurd
from rovsim.diagnosis.differing_runs import (
    NOTHING_WRONG,
    HeldOutRuns,
    advise_on_difference,
    advise_on_tests,
)
from rovsim.diagnosis.train_diagnosis import TrainDiagnosis
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.effects.base import Effect
from rovsim.dynamics.parameter_labels import label_parameters
from rovsim.results.fitted import Doubt

FIX_SCALE = (
    "To fix the common scale of thrust, inertia and drag, measure one force. Either measure the "
    "pull on a spring balance at a steady command (for the force curve of the vehicle file), or "
    "how far a known weight heels the vehicle (for its centre of buoyancy)."
)

# What to record where none of an axis' motion was measured, with the columns of docs/formats.md.
CHANNELS_TO_RECORD = (
    (
        ("surge", "sway"),
        "a position (x_m, y_m) or a velocity over ground (u_m_s, v_m_s, as a DVL gives it)",
    ),
    (("heave",), "a depth (depth_m)"),
    (("roll", "pitch"), "an attitude (roll_rad, pitch_rad) or turn rates (p_rad_s, q_rad_s)"),
    (("yaw",), "a heading (yaw_rad) or a turn rate (r_rad_s)"),
)

ADD_TRAIN_RUN = (
    "Write `split: train` for a run in campaign.yaml that can be used: at least a minute in which "
    "the vehicle moves."
)

CORRECT_DIVERGING_MODEL = (
    "Correct the model first: look for a negative total drag, a wrong sign or a wrong unit in its "
    "file, or diagnose model=nominal."
)

CHECK_UNITS = (
    "{}: check the units first, of mass and thrust in the vehicle file, of positions and commands "
    "in the recordings."
)

LEAVE_OUT_ENDS = (
    "Look at the ends of runs in `disturbed_ends`: leave out with `use` where the vehicle was "
    "moved by hand, lifted or aground, and diagnose again."
)

RECORD_WITHOUT_AUTOPILOT = (
    "An autopilot that holds an angle by a sensor better than the cameras looks like a small force "
    "in the runs where it acts: its thrust tells how the vehicle turns before the cameras do. "
    "Record runs without it, and diagnose these alone."
)

# What settles a doubt, where something does:
ADVICE_ON_DOUBT: dict[Doubt, str] = {
    "looks_ahead": "A negative input_delay beside a pose_filter is what software leaves that "
    "smooths forwards and backwards, and so without delay: export the poses unsmoothed, and "
    "diagnose these.",
    "autopilot": RECORD_WITHOUT_AUTOPILOT,
    "varies": RECORD_WITHOUT_AUTOPILOT,
    "depth_at_rest": "Let it float without commands for most of a run: the median of a run's "
    "depths is taken for its depth at rest, and a constant force in heave shifts that.",
}


def advise(
    diagnosis: TrainDiagnosis,
    groups: Sequence[Sequence[str]],
    joint: Sequence[Sequence[str]],
    catalogue: Catalogue,
    test_runs: HeldOutRuns = NOTHING_WRONG,
) -> str:
    """Advise in a few sentences what to record, or to check, next.

    Args:
        diagnosis: of the train runs.
        groups: ids of effects that cannot be told apart, each group by itself.
        joint: parameters, as `effect.parameter`, that are only known together, in groups, too.
        catalogue: says what reveals each effect.
        test_runs: what is wrong with these.
    """
    if not diagnosis.enough:
        return _advise_new_data(diagnosis)
    parts = _doubt_units(diagnosis)
    doubts = {s.doubt for s in diagnosis.selected}
    advice = (text for doubt, text in ADVICE_ON_DOUBT.items() if doubt in doubts)
    parts += dict.fromkeys(advice)  # two doubts may have the same
    if groups:
        names = " and ".join(groups[0])
        parts.append(
            f"{names} cannot be told apart with these runs. {_list_revealing(groups[0], catalogue)}"
        )
        pair = ",".join(groups[0][:2])
        parts.append(
            f"`rovsim design campaign=DIR 'between=[{pair}]'` plans such a flight, for a vehicle "
            "that can stay in one place."
        )
    if joint:
        parts.append(_advise_separation(joint, catalogue, diagnosis.base.vehicle.thruster_names))
    if diagnosis.scale:
        parts.append(FIX_SCALE)
    parts += _advise_excitation(diagnosis)
    if test_runs.differ:
        parts.insert(0, advise_on_tests(test_runs))
    parts += _advise_on_rest(diagnosis, test_runs)
    return " ".join(parts) or _confirm(diagnosis)


def _advise_new_data(diagnosis: TrainDiagnosis) -> str:
    """Say what is needed where there was too little to judge anything."""
    if diagnosis.usable.diverged_from:
        return CORRECT_DIVERGING_MODEL
    if not diagnosis.usable.runs:
        return ADD_TRAIN_RUN
    return (
        "Record train runs of at least a minute in which the vehicle moves: "
        f"only {diagnosis.usable.seconds:.0f} s could be used."
    )


def _doubt_units(diagnosis: TrainDiagnosis) -> list[str]:
    """Say what to check first, if a fitted value is absurdly far from the vehicle file."""
    absurd = list_absurd(diagnosis.base, [s.term for s in diagnosis.selected])
    return [CHECK_UNITS.format(" and ".join(absurd))] if absurd else []


def _advise_on_rest(diagnosis: TrainDiagnosis, test_runs: HeldOutRuns) -> list[str]:
    """Say what to do about what is left unexplained."""
    if diagnosis.difference:
        return [
            advise_on_difference(
                diagnosis.difference, test_runs, diagnosis.base.vehicle.thruster_names
            )
        ]
    if diagnosis.disturbed_ends:
        return [LEAVE_OUT_ENDS]
    if not diagnosis.structures:
        return []
    structure = diagnosis.structures[0]
    return [
        f"Record some time without commands, then move slowly in {structure.axis} alone. If the "
        f"remainder ({structure.what}) is there without commands too, it comes from outside; if "
        "only with motion, from the vehicle."
    ]


def _advise_excitation(diagnosis: TrainDiagnosis) -> list[str]:
    """Say which axes to move, what to command and what to measure, where nobody did."""
    parts = []
    if at_rest := diagnosis.usable.still:
        parts.append(
            f"Move {', '.join(at_rest)} more in a train run: with hardly any motion, little can be "
            "said about what acts there."
        )
    if idle := diagnosis.not_commanded:
        parts.append(f"Command {', '.join(idle)} in a train run, alone for some seconds each time.")
    axes = diagnosis.usable.unmeasured
    return parts + [
        f"Record {channel}: without it nothing can be said about what acts in {', '.join(missing)}."
        for group, channel in CHANNELS_TO_RECORD
        if (missing := [axis for axis in axes if axis in group])
    ]


def _list_revealing(names: Sequence[str], catalogue: Catalogue) -> str:
    """What reveals each of these effects, in sentences of the catalogue."""
    return " ".join(text for name in names if (text := catalogue[name].revealed_by))


def _advise_separation(
    joint: Sequence[Sequence[str]], catalogue: Catalogue, thrusters: Sequence[str]
) -> str:
    """Say how to tell values apart: by what reveals the effect to which most of them belong."""
    owners = [name.split(".")[0] for group in joint for name in group]
    commonest = max(dict.fromkeys(owners), key=owners.count)
    group = next(g for g in joint if any(name.startswith(f"{commonest}.") for name in g))
    names = ", ".join(label_parameters(group, thrusters))
    return f"To know {names} one by one: {_advise_on(catalogue[commonest], group)}"


def _confirm(diagnosis: TrainDiagnosis) -> str:
    """Say what would make the least important accepted effect surer, or that nothing is needed."""
    if not diagnosis.selected:
        return "Nothing is needed: drive faster or in other places to look for rarer effects."
    weakest = min(diagnosis.selected, key=lambda s: s.error_reduction)
    parameters = [f"{weakest.term.id}.{name}" for name in weakest.term.free]
    return f"To be surer of {weakest.term.id}: {_advise_on(type(weakest.term.effect), parameters)}"


def _advise_on(effect: type[Effect], parameters: Sequence[str]) -> str:
    """Say what reveals an effect, or how to plan a flight, where a user's effect does not say.

    Args:
        effect: its class.
        parameters: those that the flight should tell, as `effect.parameter`.
    """
    command = f"rovsim design campaign=DIR model=FILE 'know=[{','.join(parameters)}]'"
    return effect.revealed_by or f"plan a flight with `{command}`."
