"""Read and write plain arrays in `.npz` files, without pickle and safe against huge contents."""

import io
import zipfile
import zlib
from math import prod
from pathlib import Path

import numpy as np

from rovsim.core.errors import BadInput
from rovsim.core.files import write_bytes

SPARE_BYTES = 1 << 26  # that an archive may unpack to beyond ten times its size


def write_arrays(path: Path, **arrays: np.ndarray) -> None:
    """Write arrays as an `.npz` whose bytes depend on the arrays alone (no time stamps)."""
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as archive:
        for name, array in arrays.items():
            buffer = io.BytesIO()
            np.lib.format.write_array(buffer, np.asarray(array), allow_pickle=False)
            archive.writestr(zipfile.ZipInfo(f"{name}.npy"), buffer.getvalue())
    write_bytes(path, content.getvalue())


def read_arrays(path: Path) -> dict[str, np.ndarray]:
    """Read an `.npz` written by `write_arrays`; pickled content is refused.

    Raises:
        BadInput: the file is missing, damaged, holds objects, or unpacks to far more than its size.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            members = archive.infolist()
            unpacked = sum(member.file_size for member in members)
            if unpacked <= 10 * path.stat().st_size + SPARE_BYTES:
                return {m.filename.removesuffix(".npy"): _array(archive.read(m)) for m in members}
        fault = f"would unpack to {unpacked:.1e} bytes"
    except FileNotFoundError:
        fault = "no such file"
    except (
        ValueError,
        OSError,
        EOFError,
        KeyError,
        NotImplementedError,
        RuntimeError,
        zlib.error,
        zipfile.BadZipFile,
    ) as error:
        fault = f"cannot be read ({error})"
    raise BadInput(
        fault,
        where=path,
        expected="plain arrays in an .npz file",
        remedy="Write it again with the command that made it.",
    )


def _array(raw: bytes) -> np.ndarray:
    """Read an array after checking that its header announces exactly the bytes that follow.

    NumPy alone would first allocate what the header announces.
    """
    content = io.BytesIO(raw)
    version = np.lib.format.read_magic(content)
    headers = {
        (1, 0): np.lib.format.read_array_header_1_0,
        (2, 0): np.lib.format.read_array_header_2_0,
    }
    if version not in headers:
        raise ValueError(f"an array of format {version}")
    shape, _, dtype = headers[version](content)
    if dtype.hasobject or prod(shape) * dtype.itemsize != len(raw) - content.tell():
        raise ValueError(f"an array of {shape} {dtype} in {len(raw)} bytes")
    content.seek(0)
    return np.lib.format.read_array(content, allow_pickle=False)
