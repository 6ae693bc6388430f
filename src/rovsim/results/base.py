"""What all results share: one file, read and written whole, and six values by axis."""

from pathlib import Path
from typing import Any, ClassVar, Self

import numpy as np
from numpy import ndarray as Array
from pydantic import JsonValue, SerializerFunctionWrapHandler, ValidationError, model_serializer

from rovsim.core.axes import AXES
from rovsim.core.errors import BadInput
from rovsim.core.files import read_json, write_json
from rovsim.core.schema import Section


class Result(Section):
    """What a command computed, as its JSON file holds it.

    `noun` says what it is, and `command` what writes it, for whoever reads another file by mistake.
    """

    noun: ClassVar[str] = "result"
    command: ClassVar[str] = "the command that made it"

    def to_json(self) -> dict[str, JsonValue]:
        """Plain values, keys in the order of the file."""
        return self.model_dump(mode="json", by_alias=True)

    def write(self, path: Path) -> None:
        """Write the file, whole or not at all."""
        write_json(path, self.to_json())

    @classmethod
    def read(cls, path: Path) -> Self:
        """Read the file.

        Raises:
            BadInput: it is missing or damaged, or it is something else.
        """
        try:
            return cls.model_validate(read_json(path))
        except ValidationError as error:
            first = error.errors(include_url=False)[0]
        name = ".".join(str(part) for part in first["loc"])
        raise BadInput(
            f"is not a {cls.noun} of this program ({f'{name}: ' if name else ''}{first['msg']})",
            where=path,
            expected=f"what {cls.command} wrote",
            remedy=f"Run {cls.command} again.",
        )


class Sparse(Section):
    """A section of which only the keys that were given are written."""

    @model_serializer(mode="wrap")
    def _given(self, whole: SerializerFunctionWrapHandler) -> dict[str, Any]:
        return {key: value for key, value in whole(self).items() if key in self.model_fields_set}


class ByAxis(Section):
    """One value an axis; None where there is none."""

    surge: float | None = None
    sway: float | None = None
    heave: float | None = None
    roll: float | None = None
    pitch: float | None = None
    yaw: float | None = None

    @staticmethod
    def of(values: Array) -> "ByAxis":
        """Six values (6,); what is not finite is None."""
        return ByAxis(**{axis: or_none(v) for axis, v in zip(AXES, values, strict=True)})

    def __getitem__(self, axis: str) -> float | None:
        return getattr(self, axis)

    def array(self) -> Array:
        """The values (6,); NaN where there is none."""
        return np.array([or_nan(self[axis]) for axis in AXES])


def or_none(value: float) -> float | None:
    """A finite number, else None: JSON has no NaN."""
    return float(value) if np.isfinite(value) else None


def or_nan(value: float | None) -> float:
    """The number; NaN for None."""
    return float("nan") if value is None else float(value)
