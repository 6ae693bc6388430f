"""A door into the program: a valid input, ways to damage it, and the code behind the door.

A door is one class; the tests find it by itself.
"""

from pathlib import Path
from typing import Any, Callable, ClassVar

import numpy as np
import yaml

from damage import damaged
from fuzz.hostile import TEXTS, changed
from rovsim.apps.cli.main import main
from rovsim.core.errors import RovsimError

ENTRIES: dict[str, type["Entry"]] = {}


class Refused(RovsimError):
    """A command that ended with an exit code of its own."""


def command(*words: str) -> None:
    """A whole command, in this process; what it refuses, it said and wrote nothing."""
    try:
        main(words)
    except SystemExit as end:
        if end.code != 0:
            raise Refused(end.code) from None


class Entry:
    """One door: `prepare` writes a valid input once, `damage` spoils it, `enter` uses it."""

    name: ClassVar[str]
    share: ClassVar[float] = 1.0  # of the tries: less where one takes long
    refuses: ClassVar[bool] = True  # some of the damage; a log is read around a scratch

    def __init_subclass__(cls) -> None:
        if hasattr(cls, "name"):
            ENTRIES[cls.name] = cls

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def prepare(self) -> None:
        raise NotImplementedError

    def damage(self, random: np.random.Generator) -> None:
        raise NotImplementedError

    def enter(self) -> None:
        """Use the input as the program does; RovsimError refuses it."""
        raise NotImplementedError


class Text(Entry):
    """A YAML or JSON file: faults in its tree, in its bytes, or another text altogether."""

    file: Path
    form: Callable[[Any], str] = staticmethod(
        lambda tree: yaml.safe_dump(tree, allow_unicode=True, sort_keys=False)
    )

    def written(self, tree: Any) -> None:
        self.tree = tree
        self.file.write_text(self.form(tree), encoding="utf-8")
        self.good = self.file.read_bytes()

    def damage(self, random: np.random.Generator) -> None:
        way = random.random()
        if way < 0.7:
            text = self.form(changed(self.tree, random)).encode("utf-8", "surrogatepass")
        elif way < 0.97:
            text = damaged(self.good, random)
        else:
            text = random.choice(list(TEXTS.values())).encode()
        self.file.write_bytes(text)
