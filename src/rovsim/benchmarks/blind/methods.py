"""The methods that are compared: each reads a campaign folder and answers like diagnosis.json."""

from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Sequence

from rovsim.core.extras import require
from rovsim.results.bands import Bands
from rovsim.results.diagnosis import Answer, Diagnosis

Ask = Callable[[Path, Path], Diagnosis | Answer]


@dataclass(frozen=True)
class Method:
    """A method under test.

    Attributes:
        name: in settings and tables.
        answer: returns the answer to the campaign in a folder; may write files into another folder.
            A function of a module, so that another process can find it.
        code: modules; when they change, answers have to be made again.
        bands: measures how much of the test runs lies in the bands of the diagnosed model; None for
            methods without bands.
    """

    name: str
    answer: Ask
    code: tuple[str, ...]
    bands: Callable[[Path, Diagnosis], Bands | None] | None = None


def chosen(names: Sequence[str]) -> list[Method]:
    """Return methods by name; each is imported only when it is asked for.

    Raises:
        BadInput: one of them needs a package that is not installed.
    """
    return [_METHODS[name]() for name in names]


def _diagnosis() -> Method:
    from rovsim.benchmarks.blind.asking import bands, diagnosis

    return Method("diagnosis", diagnosis, ("rovsim.benchmarks.blind.asking",), bands)


def _stlsq() -> Method:
    return _regression("stlsq")


def _frols() -> Method:
    return _regression("frols")


def _regression(name: str) -> Method:
    require("benchmark", by=f"blind.methods, {name}")
    from rovsim.benchmarks.blind import sparse

    return Method(name, getattr(sparse, name), ("rovsim.benchmarks.blind.sparse",))


_METHODS = {"diagnosis": _diagnosis, "stlsq": _stlsq, "frols": _frols}
