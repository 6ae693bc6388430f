"""Who is asked: a method reads a campaign folder and answers in the form of diagnosis.json."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, Sequence

Answer = Callable[[Path, Path], dict[str, Any]]


@dataclass(frozen=True)
class Method:
    """A method under test.

    `answer(campaign, out)` gives the diagnosis and may write into `out`; it is a module's function,
    so that another process can find it. `code` modules whose change makes old answers void.
    """

    name: str
    answer: Answer
    code: tuple[str, ...]


def chosen(names: Sequence[str]) -> list[Method]:
    """Methods by name; each is imported only when asked for."""
    return [_METHODS[name]() for name in names]


def _diagnosis() -> Method:
    from rovsim.hidden.asking import diagnosis

    return Method("diagnosis", diagnosis, ("rovsim.hidden.asking",))


def _stlsq() -> Method:
    from rovsim.hidden.sparse import stlsq

    return Method("stlsq", stlsq, ("rovsim.hidden.sparse",))


def _frols() -> Method:
    from rovsim.hidden.sparse import frols

    return Method("frols", frols, ("rovsim.hidden.sparse",))


_METHODS = {"diagnosis": _diagnosis, "stlsq": _stlsq, "frols": _frols}
