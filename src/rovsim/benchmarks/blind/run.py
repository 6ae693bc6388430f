"""Run cases: in parallel, resumable, one JSON per case and method."""

import hashlib
import json
import multiprocessing
import os
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Iterator, Sequence

from rovsim.application.provenance import digest
from rovsim.benchmarks.blind.answers import KeptAnswer
from rovsim.benchmarks.blind.case import Case
from rovsim.benchmarks.blind.flight import SIMULATORS, fly
from rovsim.benchmarks.blind.methods import Method
from rovsim.core.errors import RovsimError
from rovsim.core.files import read_json
from rovsim.results.diagnosis import Answer, Diagnosis

FLIGHT = "rovsim.benchmarks.blind.flight"
ONE_THREAD = {"NUMBA_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class Job:
    """A case and the methods that have not answered it yet, with where and under which digest."""

    case: Case
    methods: tuple[tuple[Method, Path, str], ...]
    simulator: str


def place(folder: Path, method: Method, case: Case) -> Path:
    """Where the answer of a method to a case is kept."""
    return folder / method.name / f"{case.id.replace('/', '__').replace(' ', '_')}.json"


def fingerprint(case: Case, code: str) -> str:
    """Digest of all that an answer depends on."""
    content = json.dumps([case.model_dump(mode="json"), code], sort_keys=True)
    return hashlib.sha256(content.encode()).hexdigest()[:16]


def pending(
    cases: Sequence[Case], methods: Sequence[Method], folder: Path, simulator: str = "tank"
) -> Iterator[Job]:
    """Jobs for what is missing or was answered by other code, of cases the simulator can fly."""
    flown_by = SIMULATORS[simulator]
    codes = {m.name: digest(FLIGHT, *flown_by.code, *m.code) for m in methods}
    for case in filter(flown_by.states, cases):
        wanted = [(m, place(folder, m, case), fingerprint(case, codes[m.name])) for m in methods]
        left = tuple(w for w in wanted if not _answered(w[1], w[2]))
        if left:
            yield Job(case, left, simulator)


def _answered(path: Path, mark: str) -> bool:
    return path.is_file() and read_json(path).get("digest") == mark


def work(job: Job) -> None:
    """Fly a case once, ask every method, keep each answer as soon as it is there."""
    with tempfile.TemporaryDirectory() as folder:
        campaign = Path(folder, "campaign")
        flown = fly(job.case, campaign, job.simulator)
        for method, path, mark in job.methods:
            begin, worked = time.perf_counter(), time.process_time()
            diagnosis, error = _ask(method, campaign, Path(folder, method.name))
            KeptAnswer(
                digest=mark,
                method=method.name,
                case=flown,
                redrawn=flown != job.case,
                seconds=time.perf_counter() - begin,
                cpu_seconds=time.process_time() - worked,
                diagnosis=diagnosis,
                error=error,
            ).write(path)


def _ask(method: Method, campaign: Path, out: Path) -> tuple[Diagnosis | Answer | None, str | None]:
    """The answer, or why there is none: a crash is a wrong answer, not the end of the benchmark."""
    try:
        return method.answer(campaign, out), None
    except (RovsimError, ArithmeticError, LookupError, TypeError, ValueError, SystemExit) as error:
        return None, f"{type(error).__name__}: {error}"


def run(
    cases: Sequence[Case],
    methods: Sequence[Method],
    folder: Path,
    cores: int,
    progress: Progress = lambda done, total: None,
    simulator: str = "tank",
) -> None:
    """Answer all cases by all methods; what is there already is not asked again."""
    jobs = list(pending(cases, methods, folder, simulator))
    if cores == 1:
        for done, job in enumerate(jobs):
            progress(done, len(jobs))
            work(job)
    elif jobs:
        _in_parallel(jobs, cores, progress)
    progress(len(jobs), len(jobs))


def _in_parallel(jobs: Sequence[Job], cores: int, progress: Progress) -> None:
    """One process a core, one thread each: seconds are then those of one core."""
    os.environ.update(ONE_THREAD)
    context = multiprocessing.get_context("spawn")  # threads do not survive a fork
    with ProcessPoolExecutor(cores, mp_context=context) as pool:
        waiting = [pool.submit(work, job) for job in jobs]
        try:
            for done, future in enumerate(as_completed(waiting)):
                future.result()
                progress(done + 1, len(jobs))
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def read_answers(cases: Sequence[Case], method: Method, folder: Path) -> list[KeptAnswer]:
    """What a method said to those cases that it has answered."""
    paths = [place(folder, method, case) for case in cases]
    return [KeptAnswer.read(path) for path in paths if path.is_file()]
