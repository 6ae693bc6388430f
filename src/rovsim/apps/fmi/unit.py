"""Pack a model as an FMI 2.0 co-simulation unit with pythonfmu."""

import shutil
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from rovsim.core.errors import BadInput
from rovsim.core.files import copy_file
from rovsim.core.yaml_files import read_yaml
from rovsim.dynamics.model import Model
from rovsim.dynamics.model_file import write_model

SLAVE_FILE, MODEL_FILE = "slave.py", "model.yaml"


def write_unit(model: Model, source: Path | None, out: Path) -> None:
    """Write a model as a unit.

    Args:
        model: to be packed.
        source: its file, in the folder with the arrays of its residual; None if it is built in.
        out: the .fmu file.

    Raises:
        BadInput: `out` is no .fmu file, or cannot be written.
    """
    if out.suffix != ".fmu":
        raise BadInput(
            f"'{out.name}' is no unit",
            where="out",
            expected="a name that ends with .fmu",
            remedy="For example out=vehicle.fmu.",
        )
    from pythonfmu.builder import FmuBuilder

    with TemporaryDirectory() as folder:
        inside = Path(folder, "inside")
        inside.mkdir()
        files = _packed(model, source, inside)
        script = Path(shutil.copy(Path(__file__).with_name(SLAVE_FILE), folder))
        before = list(sys.path)
        try:
            built = FmuBuilder.build_FMU(script, Path(folder, "unit.fmu"), files)
        finally:
            sys.path[:] = before  # pythonfmu leaves the script's folder there
        copy_file(Path(built), out)


def _packed(model: Model, source: Path | None, folder: Path) -> list[Path]:
    """Write the files of a model into a folder, with its residual; returns all files there."""
    residual = read_yaml(source).get("residual") if source else None
    write_model(model, folder / MODEL_FILE, residual=residual)
    if source and residual:
        copy_file(source.parent / residual["file"], folder / residual["file"])
    return sorted(folder.iterdir())
