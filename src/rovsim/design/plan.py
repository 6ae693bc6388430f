"""A question about a campaign in, the flight that answers it best out."""

from dataclasses import dataclass
from itertools import islice
from typing import Callable, Mapping, Sequence

import numpy as np
from numpy import ndarray as Array
from threadpoolctl import threadpool_limits

from rovsim.core.errors import BadInput
from rovsim.core.run import Site
from rovsim.design.authority import Authority
from rovsim.design.doubts import doubt, no_flight, require_news, warn_of_walls
from rovsim.design.flight import Chances, Envelope, draw_chances
from rovsim.design.from_train_runs import learn
from rovsim.design.knowledge import Knowledge
from rovsim.design.pilot import ModelPilot
from rovsim.design.search import Range, Tried, in_parts, search, try_usual
from rovsim.design.settings import Question
from rovsim.design.surroundings import Surroundings, surround
from rovsim.design.worth import Worth, value
from rovsim.diagnosis.observer.train_runs import prepare_train
from rovsim.diagnosis.observer.usable_runs import select_usable
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.model import Model
from rovsim.measurement.runs import Runs
from rovsim.simulation.batch import Batch

LOOKED_AT, TAKEN_OVER, CHECKED = 8, 4, 40  # chances: while searching, of the worth, in the end
FINALISTS = 4
# Share of the time that is over when a stage begins: means over the development seeds.
STAGES = {"learning": 0.0, "usual manoeuvres": 0.03, "searching": 0.12, "checking": 0.93}

Stage = Callable[[str], None]


@dataclass(frozen=True, eq=False)
class Plan:
    """The flight, what it tells over what is not yet known, and the usual manoeuvres likewise.

    `axes` (j,) are those that sticks move.
    `usual` is None where a manoeuvre stays within the limits at no amplitude. `paths` (s, k+1, 13)
    what could happen, the likeliest first, every `step` s. `doubts`: what speaks against it.
    """

    flight: Tried
    worth: Worth
    usual: Mapping[str, tuple[Tried, Worth] | None]
    known: Knowledge
    paths: Array
    step: float
    envelope: Envelope
    start: Array
    axes: Array
    site: Site
    doubts: tuple[str, ...]


@threadpool_limits.wrap(limits=1, user_api="blas")  # matrices are too small for more to help
def plan(
    model: Model, runs: Runs, question: Question, columns: Sequence[int] | None,
    catalogue: Catalogue, stage: Stage,
) -> Plan:  # fmt: skip
    """Find the flight that tells most.

    Args:
        model: what is known so far.
        runs: all usable runs of a campaign.
        question: what is asked.
        columns: axes of a log per axis; None: it is of thrusters.
        catalogue: all effects.
        stage: told what begins.

    Raises:
        BadInput: nothing that could be planned, no flight stays within the limits, or none tells
            anything.
    """
    stage("learning")
    most = question.search.most_seconds
    train = prepare_train(runs, question.replay, catalogue, model.body.free, most).runs
    usable = select_usable(train)
    if not usable.enough:
        raise BadInput(
            f"only {usable.seconds:.0f} s of the train runs can be used",
            where="rovsim design",
            expected="at least 10 s in which the vehicle moves: a design builds on them",
            remedy="Record a train run of a minute in which the vehicle moves.",
        )
    around = surround(usable.runs, question.seconds, columns, question.replay, catalogue)
    known = learn(model, usable.runs, question, catalogue)
    random = np.random.default_rng(question.seed)
    where = _open_range(known, around, question, random)
    stage("usual manoeuvres")
    usual = try_usual(where, question.seed)
    stage("searching")
    found = search(where, question.design, question.seed)
    stage("checking")
    return _choose(where, usual, found, question, random)


def _open_range(
    known: Knowledge, around: Surroundings, question: Question, random: np.random.Generator
) -> Range:
    limits, first = question.design.limits, known.rivals[0].hypothesis.model
    envelope = Envelope.around(around, limits, first.vehicle.floats)
    batch = Batch([first], around.site, candidates=around.wrenches, learned=False)
    authority = Authority(first, around.kind, around.axes, around.largest)
    if not {0, 1, 5} <= set(authority.axes):
        raise BadInput(
            f"{first.vehicle.name} cannot push sideways",
            where="rovsim design",
            expected="a vehicle that can stay near a place without looking",
            remedy="Record what `diagnose` recommends under next_experiment.",
        )
    start = envelope.middle
    if first.vehicle.floats:
        start[2] = around.site.level
    pilot = ModelPilot(authority, around.site, start, limits, batch)
    if not pilot.full.any():
        raise BadInput(
            "no axis can be commanded",
            where="rovsim design",
            expected="commands that push the vehicle",
            remedy="Check thrusters and mixer of the vehicle file.",
        )
    return Range(pilot, envelope, _draw(known, LOOKED_AT, around, random), known, around)


def _draw(
    known: Knowledge, count: int, around: Surroundings, random: np.random.Generator
) -> Chances:
    """What could happen: the likeliest of each rival first, then others."""
    each = [rival.draw(max(2, count // len(known.rivals)), random) for rival in known.rivals]
    return draw_chances(each, known, around, random)


def _choose(
    where: Range, usual: Mapping[str, list[Tried]], found: Sequence[Array], question: Question,
    random: np.random.Generator,
) -> Plan:  # fmt: skip
    """The best over what is not yet known, of those that surely stay within the limits.

    A usual manoeuvre is taken where none is better.
    """
    many = _draw(where.known, CHECKED, where.around, random)
    some = [rival.draw(TAKEN_OVER, random) for rival in where.known.rivals]
    best = {name: _first_safe(where, own, many) for name, own in usual.items()}
    rated = {name: (one, _average(where, one, some)) for name, one in best.items() if one}
    again = (one for some in in_parts(found) for one in where.try_numbers(some))
    able = (one for one in again if one.worth)
    safe = list(islice((one for one in able if _paths(where, one, many) is not None), FINALISTS))
    tried = [(one, _average(where, one, some)) for one in safe]
    everything = [*tried, *rated.values()]
    if not everything:
        raise no_flight(where, question)
    flight, worth = max(everything, key=lambda one: one[1].told)
    require_news(worth, where.known)
    paths = _paths(where, flight, many)
    assert paths is not None
    return Plan(
        flight, worth, {name: rated.get(name) for name in usual}, where.known, paths,
        where.around.step, where.envelope, where.pilot.start, where.axes, where.around.site,
        (*doubt(where.known, question), *warn_of_walls(paths, where.pilot.start, where.envelope)),
    )  # fmt: skip


def _first_safe(where: Range, tried: Sequence[Tried], many: Chances) -> Tried | None:
    """The first that surely stays within the limits."""
    able = (one for one in tried if one.worth)
    return next((one for one in able if _paths(where, one, many) is not None), None)


def _paths(where: Range, one: Tried, many: Chances) -> Array | None:
    """What could happen (s, k+1, 13); None where it leaves the limits."""
    start = where.pilot.starts(np.array([one.heading]))[0]
    paths = many.predict(where.around.drives(one.commands), start)
    return paths if where.envelope.holds(paths) else None


def _average(where: Range, one: Tried, some: Sequence[Sequence[Model]]) -> Worth:
    """The worth over models that could be true: the middle of each number."""
    start, found = where.pilot.starts(np.array([one.heading]))[0], []
    drives = where.around.drives(one.commands)
    for models in zip(*some, strict=True):
        still = Chances(
            models, np.zeros((len(models), len(where.around.edges) - 1, 6)),
            np.zeros((len(models), 3)), np.zeros(len(models)), where.around,
        )  # fmt: skip
        paths = still.predict(drives, start)
        found.append(value(paths, one.commands, where.known, where.around, exact=True))
    return Worth(
        tuple(np.median([w.surer[k] for w in found], axis=0) for k in range(len(some))),
        tuple(np.median([w.std[k] for w in found], axis=0) for k in range(len(some))),
        np.median([w.gain for w in found], axis=0),
        where.known.likely,
    )
