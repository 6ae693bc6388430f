"""Run cases, one JSON file for each case and method; what has been answered is not run again."""

import hashlib
import json
import tempfile
import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Callable, Iterator, Sequence

from rovsim.application.provenance import digest
from rovsim.application.settings import BlindSettings
from rovsim.benchmarks.blind.answers import KeptAnswer
from rovsim.benchmarks.blind.case import Case, share_of
from rovsim.benchmarks.blind.flight import SIMULATORS, fly
from rovsim.benchmarks.blind.methods import Method, chosen
from rovsim.benchmarks.blind.suites import suite
from rovsim.core.errors import RovsimError
from rovsim.core.files import read_json
from rovsim.dynamics.vehicle import default_vehicle, vehicle_file
from rovsim.results.bands import Bands
from rovsim.results.diagnosis import Answer, Diagnosis

FLIGHT_MODULE = "rovsim.benchmarks.blind.flight"
# subfolder of the answers, by simulator
_SUBFOLDERS = {"tank": (), "independent": ("independent",)}
Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class PendingCase:
    """A case, and the methods that have not answered it yet.

    Attributes:
        case: to be flown.
        methods: each with the file of its answer and the digest that the answer will have.
        simulator: that flies the case.
    """

    case: Case
    methods: tuple[tuple[Method, Path, str], ...]
    simulator: str

    @property
    def mark(self) -> str:
        """Digest of the files and digests of the answers that the job will give."""
        return hashlib.sha256(repr([w[1:] for w in self.methods]).encode()).hexdigest()[:16]


@dataclass(frozen=True)
class Benchmark:
    """A run of the benchmark.

    Attributes:
        asked: settings.
        out: folder of the answers.
        cases: that are run.
        methods: that answer them.
    """

    asked: BlindSettings
    out: Path
    cases: tuple[Case, ...]
    methods: tuple[Method, ...]

    @staticmethod
    def of(asked: BlindSettings, out: str | None) -> "Benchmark":
        """Prepare a run with some settings; `out` is results/blind unless given."""
        folder = Path(out or Path("results/blind", *_SUBFOLDERS[asked.simulator]))
        cases = [c for c in suite(asked.suite, asked.seeds) if share_of(c.id) < asked.share]
        return Benchmark(asked, folder, tuple(cases), tuple(chosen(asked.methods)))

    @property
    def answers(self) -> Path:
        """Folder of the answers to cases with these seeds."""
        return self.out / self.asked.seeds

    def only(self, name: str) -> "Benchmark":
        """Reduce the run to one case, given by the name of its files."""
        return replace(self, cases=tuple(case for case in self.cases if file_name(case) == name))

    def pending(self) -> list[PendingCase]:
        """List jobs for answers that are missing or were given by other code."""
        return list(pending(self.cases, self.methods, self.answers, self.asked.simulator))


def file_name(case: Case) -> str:
    """Return the id of a case as the name of a file."""
    return case.id.replace("/", "__").replace(" ", "_")


def place(folder: Path, method: Method, case: Case) -> Path:
    """Return the file of the answer of a method to a case."""
    return folder / method.name / f"{file_name(case)}.json"


def fingerprint(case: Case, code: str) -> str:
    """Digest all that an answer depends on.

    Args:
        case: that is answered.
        code: digest of simulator, method and vehicle file.
    """
    content = json.dumps([case.model_dump(mode="json"), code], sort_keys=True)
    return hashlib.sha256(content.encode()).hexdigest()[:16]


def pending(
    cases: Sequence[Case], methods: Sequence[Method], folder: Path, simulator: str = "tank"
) -> Iterator[PendingCase]:
    """Yield jobs for answers that are missing or were given by other code.

    Args:
        cases: those that the simulator cannot fly are skipped.
        methods: that answer them.
        folder: of the answers.
        simulator: its name.
    """
    backend = SIMULATORS[simulator]
    vehicle = [vehicle_file(default_vehicle())]
    codes = {
        m.name: digest(FLIGHT_MODULE, *backend.code, *m.code, described=vehicle) for m in methods
    }
    for case in filter(backend.states, cases):
        answers = [(m, place(folder, m, case), fingerprint(case, codes[m.name])) for m in methods]
        unanswered = tuple(w for w in answers if not _answered(w[1], w[2]))
        if unanswered:
            yield PendingCase(case, unanswered, simulator)


def _answered(path: Path, mark: str) -> bool:
    return path.is_file() and read_json(path).get("digest") == mark


def work(job: PendingCase) -> None:
    """Fly a case once, ask every method, and write each answer as soon as it is given."""
    with tempfile.TemporaryDirectory() as folder:
        campaign = Path(folder, "campaign")
        flown = fly(job.case, campaign, job.simulator)
        for method, path, mark in job.methods:
            begin, begin_cpu = time.perf_counter(), time.process_time()
            diagnosis, error = _ask(method, campaign, Path(folder, method.name))
            seconds, cpu = time.perf_counter() - begin, time.process_time() - begin_cpu
            KeptAnswer(
                digest=mark,
                method=method.name,
                case=flown,
                redrawn=flown != job.case,
                seconds=seconds,
                cpu_seconds=cpu,
                diagnosis=diagnosis,
                bands=_cover(method, campaign, diagnosis),
                error=error,
            ).write(path)


def _ask(method: Method, campaign: Path, out: Path) -> tuple[Diagnosis | Answer | None, str | None]:
    """Return the answer of a method, or the error by which it crashed.

    A crash counts as a wrong answer and does not end the benchmark.
    """
    try:
        return method.answer(campaign, out), None
    except (RovsimError, ArithmeticError, LookupError, TypeError, ValueError, SystemExit) as error:
        return None, f"{type(error).__name__}: {error}"


def _cover(method: Method, campaign: Path, diagnosis: Diagnosis | Answer | None) -> Bands | None:
    if method.bands is None or not isinstance(diagnosis, Diagnosis):
        return None
    return method.bands(campaign, diagnosis)


def run(jobs: Sequence[PendingCase], progress: Progress = lambda done, total: None) -> None:
    """Do jobs one after the other; `progress` is called with how many are done, and of how many."""
    for done, job in enumerate(jobs):
        progress(done, len(jobs))
        work(job)
    progress(len(jobs), len(jobs))


def read_answers(cases: Sequence[Case], method: Method, folder: Path) -> list[KeptAnswer]:
    """Read the answers of a method to those of the cases that it has answered."""
    paths = [place(folder, method, case) for case in cases]
    return [KeptAnswer.read(path) for path in paths if path.is_file()]
