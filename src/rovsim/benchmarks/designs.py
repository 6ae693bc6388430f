"""Do designed flights keep their promise? Each is flown in the tank beside the best usual one.

    python -m rovsim.benchmarks.designs development|reporting OUT [CASE…]

A case hides one effect in a rough run of 20 s, asks for a flight of 60 s (which of two effects is
it, or how large is it), and flies that and the usual manoeuvre that would tell most. Then either
is fitted beside the run. One JSON a case in OUT; those that are there are kept. Ends with a table.
"""

import sys
import time
from pathlib import Path
from typing import Any, Mapping, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.application.pipeline.recordings import MeasuredCampaign, measure, open_campaign
from rovsim.application.settings import Settings, compose
from rovsim.benchmarks.blind.case import Range, merged, random_of, seed_of
from rovsim.benchmarks.blind.recipes import RECIPES, drawn
from rovsim.core.files import read_json, write_json, write_text
from rovsim.design.expected_information import NEGLIGIBLE
from rovsim.design.from_train_runs import fit_prior
from rovsim.design.plan import Plan, plan
from rovsim.design.prior_information import PriorInformation
from rovsim.design.report import describe_start, report
from rovsim.design.search import CandidateFlight
from rovsim.design.settings import Question
from rovsim.diagnosis.observer.train_runs import prepare_train
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effect_entry import EffectEntry, Value
from rovsim.dynamics.model import nominal
from rovsim.measurement.recording.commands_csv import format_commands
from rovsim.results.experiment import Start
from rovsim.simulation.synthetic_tank.campaign import make_campaign
from rovsim.simulation.synthetic_tank.settings import TankRun, TankSettings
from rovsim.simulation.synthetic_tank.true_run import LeftTank

# The run before: too short, too rough and too little hidden to be sure of much. Frames get lost,
# and a design needs 10 s of it.
SECONDS, STRENGTH = 20.0, 0.4
ROUGH = {"turbulence": {"force": 1.0, "moment": 0.04}}
PAIRS = (  # the first is hidden
    ("linear_damping", "quadratic_damping"), ("quadratic_damping", "linear_damping"),
    ("quadratic_damping", "cubic_damping"), ("cubic_damping", "quadratic_damping"),
    ("dry_friction", "linear_damping"), ("fluid_memory", "linear_damping"),
    ("lift", "coupled_damping"), ("thruster_lag", "input_delay"), ("input_delay", "thruster_lag"),
    ("thruster_lag", "added_mass"), ("added_mass", "thruster_gain"),
    ("thruster_gain", "quadratic_damping"), ("thruster_gain", "force_curve"),
    ("force_curve", "thruster_deadband"), ("thruster_deadband", "thruster_gain"),
    ("thrust_asymmetry", "thruster_gain"), ("advance_loss", "quadratic_damping"),
    ("net_buoyancy", "constant_wrench"), ("constant_wrench", "current"),
    ("buoyancy_center", "marker_misalignment"),
)  # fmt: skip
VALUES = (
    "linear_damping.surge", "linear_damping.yaw", "quadratic_damping.surge",
    "quadratic_damping.sway", "quadratic_damping.heave", "added_mass.surge", "added_mass.sway",
    "added_mass.yaw", "thruster_gain.all", "thruster_lag.time_constant", "input_delay.delay",
    "thrust_asymmetry.ratio", "force_curve.exponent", "advance_loss.coefficient",
    "propeller_torque.ratio", "buoyancy_center.z", "net_buoyancy.force",
    "coupled_damping.yaw_from_sway", "dry_friction.sway", "marker_offset.x",
)  # fmt: skip


def list_cases() -> list[str]:
    """All 40, pairs and values in turns, so that a part of them is a fair part."""
    pairs = [f"{a}+{b}" for a, b in PAIRS]
    return [one for both in zip(pairs, VALUES, strict=True) for one in both]


def hide(case: str, seeds: Range) -> TankSettings:
    """A tank with the effect of a case, of a size that its recipe draws."""
    random, name = random_of(case, seeds), case.split("+")[0].split(".")[0]
    entry = drawn(name, STRENGTH, random)
    if "." in case:
        own = case.split(".")[1]
        known = next(p for p in built_in()[name].parameters if p.name == own)
        recipe = RECIPES[name]
        change = (recipe.sign or 1) * STRENGTH * random.uniform(*recipe.sizes) * known.scale
        neutral = known.neutral_value
        value = Value(value=float(f"{known.combine(neutral, neutral + change):.4g}"))
        entry = EffectEntry(effect=name, parameters={own: value})
    own_tank: dict[str, Any] = {
        "name": "design",
        "seed": seed_of(case, seeds),
        "duration": SECONDS,
        "effects": (entry,),
        "runs": (TankRun(id="a", control="6dof", split="train"),),
    }
    return TankSettings(**merged(ROUGH, RECIPES[name].tank, own_tank))


def ask(case: str, settings: Settings) -> Question:
    """The question of a case."""
    between = tuple(case.split("+")) if "+" in case else ()
    return Question(
        seed=0,
        between=between,
        know=() if between else (case,),
        design=settings.design,
        signals=settings.signals,
        replay=settings.replay,
    )


def run_case(case: str, seeds: Range, out: Path) -> dict[str, Any]:
    """Hide, plan, fly, fit: what was promised, and what came of it."""
    tank, settings = hide(case, seeds), compose([])
    folder, question = out / seeds / case, ask(case, settings)
    make_campaign(tank, folder / "before", built_in())
    data = _measure(folder / "before", settings)
    began, worked = time.perf_counter(), time.process_time()
    found = plan(nominal(data.vehicle), data.runs, question, None, built_in(), lambda name: None)
    seconds, cpu = time.perf_counter() - began, time.process_time() - worked
    said = report(found, "nominal", question, found.site)
    said.write(folder / "designed.json")
    usual = [own for own in found.baselines.values() if own]
    best = max(usual, key=lambda own: own[1].utility)[0] if usual else None
    result: dict[str, Any] = {
        "case": case,
        "seconds": seconds,
        "cpu_seconds": cpu,
        "manoeuvre": found.flight.name,
        "hidden": [e.plain() for e in tank.effects],
        "promised": said.model_dump(mode="json")["expects"],
        "best_usual": best.name if best else None,
        "expected_ratio": min(
            (o.designed_is_better for o in said.baselines.values() if o.designed_is_better),
            default=None,
        ),
    }
    flights = {"designed": found.flight} | ({"usual": best} if best else {})
    for name, tried in flights.items():
        result[name] = _fly(name, tried, tank, folder, found, data, question, settings)
    return result


def _measure(folder: Path, settings: Settings) -> MeasuredCampaign:
    return measure(open_campaign(str(folder)), settings.signals)


def _fly(
    name: str,
    tried: CandidateFlight,
    tank: TankSettings,
    folder: Path,
    found: Plan,
    data: MeasuredCampaign,
    question: Question,
    settings: Settings,
) -> dict[str, Any]:
    """Fly a log in the same tank, and fit all that was asked to both runs."""
    log = data.campaign.commands
    assert log is not None
    sent = folder / f"{name}.csv"
    write_text(sent, format_commands(tried.commands, log))
    start = report(found, "nominal", question, found.site).model_copy(
        update={"start": _start(found, tried)}
    )
    start.write(sent.with_suffix(".json"))
    run = TankRun(id=name, control="6dof", split="train", fly=str(sent))
    try:
        flown = tank.model_copy(update={"runs": (*tank.runs, run)})
        make_campaign(flown, folder / f"with_{name}", built_in())
    except LeftTank as error:
        return {"left": error.found}
    runs = _measure(folder / f"with_{name}", settings).runs
    base = nominal(data.vehicle)
    train = prepare_train(runs, settings.replay, built_in(), base.body.free).runs
    return _reached(found.prior, fit_prior(base, train, question, built_in()))


def _start(found: Plan, tried: CandidateFlight) -> Start:
    return describe_start(found.start, tried.heading, found.site)


def _reached(before: PriorInformation, after: PriorInformation) -> dict[str, Any]:
    """Log odds of the truth, or standard deviation and value, before and after."""
    if after.rival_names:
        return {
            "log_odds": 0.5 * after.deviance_difference,
            "log_odds_before": 0.5 * before.deviance_difference,
        }
    (own,), (old,) = after.rivals, before.rivals
    scale = own.hypothesis.terms[0].parameters[0].scale
    std, was = float(own.std()[0]), float(old.std()[0])
    value = float(own.hypothesis.x[own.of_interest[0]])
    return {
        "std": std * scale,
        "std_before": was * scale,
        "gained": (was / std) ** 2 - 1.0,
        "value": value * scale,
    }


def tabulate(results: Sequence[Mapping[str, Any]]) -> str:
    """What designs reached beside usual manoeuvres, and beside what they promised."""
    pairs = [r for r in results if "+" in r["case"]]
    values = [r for r in results if "+" not in r["case"]]
    left = sum("left" in r["designed"] for r in results)
    lines = [
        f"{len(results)} flights, {left} through a wall; a design took "
        f"{np.median([r['seconds'] for r in results]):.0f} s (median), "
        f"at most {max(r['seconds'] for r in results):.0f} s; of the processor "
        f"{np.median([r['cpu_seconds'] for r in results]):.0f} and "
        f"{max(r['cpu_seconds'] for r in results):.0f} s."
    ]
    better = _ratios(pairs, lambda r, k: r[k]["log_odds"])
    if len(better):
        lines.append(
            f"Pairs: {np.sum(better >= 2.0)} of {len(better)} with twice the log odds of the best "
            f"usual manoeuvre, median {np.median(better):.1f} times."
        )
    better = _ratios(values, lambda r, k: r[k]["gained"])
    if len(better):
        off = np.array(
            [r["designed"]["std"] / _promised(r) - 1.0 for r in values if "std" in r["designed"]]
        )
        lines.append(
            f"Values: {np.sum(better >= 3.0)} of {len(better)} with three times the information, "
            f"median {np.median(better):.1f} times; the interval reached is off by "
            f"{100 * np.median(np.abs(off)):.0f} % of what was promised (median)."
        )
    return "\n".join(lines)


def _promised(result: Mapping[str, Any]) -> float:
    return float(result["promised"]["std"][result["case"]]["then"])


def _ratios(results: Sequence[Mapping[str, Any]], get: Any) -> Array:
    """Designed over usual; a usual flight that left the tank told nothing."""
    found = []
    for one in results:
        if "left" in one["designed"]:
            found.append(0.0)
        elif "usual" not in one or "left" in one["usual"]:
            found.append(np.inf)
        else:
            found.append(get(one, "designed") / max(get(one, "usual"), NEGLIGIBLE))
    return np.array(found)


def main(seeds: Range, out: Path, cases: Sequence[str]) -> None:
    """Run what is missing of these cases (all if none is named), then print the table."""
    results = []
    for case in cases or list_cases():
        file = out / seeds / f"{case}.json"
        if not file.exists():
            write_json(file, run_case(case, seeds, out))
        results.append(read_json(file))
        print(tabulate(results), flush=True)


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]), sys.argv[3:])  # type: ignore[arg-type]
