"""Error messages and warnings on stderr; this module imports fast, for errors at the start."""

import sys
from typing import NoReturn

from rovsim.core.columns import fold

NAMELESS_FILE = "a file of $ROVSIM_CACHE or $TMPDIR"  # those of results are named by `core.files`


def complain(message: str) -> NoReturn:
    """Say what is wrong with the input, and end with exit code 2."""
    warn(message)
    sys.exit(2)


def warn(message: str) -> None:
    """Say what went wrong beside the result, and go on."""
    lines = [line for paragraph in f"rovsim: {message}".splitlines() for line in fold(paragraph)]
    print("\n".join(lines), file=sys.stderr)


def describe_os_error(error: OSError) -> str:
    """Return which file the system refused and why, for instance since the disk is full."""
    return f"{error.filename or NAMELESS_FILE}: {error.strerror or error}"
