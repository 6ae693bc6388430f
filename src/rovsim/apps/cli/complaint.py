"""One message and exit code 2; it is here alone, because half of the package is slow to import."""

import sys
from typing import NoReturn

from rovsim.core.columns import fold


def complain(message: str) -> NoReturn:
    """Say what is wrong with the input, and end."""
    lines = [line for one in f"rovsim: {message}".splitlines() for line in fold(one)]
    print("\n".join(lines), file=sys.stderr)
    sys.exit(2)
