"""Decorators of the compiled functions of the estimation."""

from typing import Any

from rovsim.dynamics.compilation.compiled import FROM_PYTHON, INTERNAL, keep

# A division by zero gives what is not finite: it ends no search among noises that cannot be.
MATHS: dict[str, Any] = {"error_model": "numpy"}

from_python = keep(**MATHS, **FROM_PYTHON)
unlocked = keep(nogil=True, **MATHS, **FROM_PYTHON)  # releases the interpreter's lock (GIL)
internal = keep(**MATHS, **INTERNAL)  # called by compiled functions alone
inlined = keep(inline="always", **MATHS, **INTERNAL)
