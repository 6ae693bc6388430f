"""Work for another process, which imports nothing heavy for it."""

import os
import time

from rovsim.core.errors import BadInput
from rovsim.core.progress import counted


def counting(rounds, pause):
    """Something that takes a while and tells how far it is."""
    for _ in counted(range(rounds), "counting"):
        time.sleep(pause)
    return rounds


def failing():
    """Input that cannot be used."""
    raise BadInput("is broken", where="there", expected="sound input", remedy="Mend it.")


def dying():
    """A process that ends without a word."""
    os._exit(3)
