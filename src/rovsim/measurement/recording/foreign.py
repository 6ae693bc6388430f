"""Turn the errors of other libraries on damaged files into one message about the file."""

from contextlib import contextmanager
from pathlib import Path
from typing import Iterator

from rovsim.core.errors import BadInput


@contextmanager
def read_by(library: str, path: Path, expected: str, remedy: str) -> Iterator[None]:
    """Wrap calls of a library that reads `path`: any error of it is reported as a bad file.

    Raises:
        BadInput: the library could not read it.
    """
    try:
        yield
    except BadInput:
        raise
    except Exception as error:  # of any type: damaged bytes may fail anywhere in the library
        detail = " ".join(str(error).split())[:200]
        raise BadInput(
            f"cannot be read ({library}: {type(error).__name__}{f': {detail}' if detail else ''})",
            where=path,
            expected=expected,
            remedy=remedy,
        ) from None
