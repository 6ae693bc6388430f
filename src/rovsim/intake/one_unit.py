"""Give columns of one name the same unit in all files.

Where no name states the unit, the size of the numbers in one file may tell it for all.
"""

from collections import defaultdict
from dataclasses import replace
from pathlib import Path
from typing import Mapping

from rovsim.core.errors import BadInput
from rovsim.intake.survey.contents import Contents
from rovsim.intake.survey.sizes import Key, Unit, UnknownUnit


def list_others(
    contents_by_path: Mapping[Path, Contents], refused: Mapping[Path, BadInput]
) -> dict[Path, dict[Key, Unit]]:
    """List files that have to be read again with a unit that other files tell.

    Args:
        contents_by_path: what each readable file holds.
        refused: the errors of the others.

    Returns:
        For each such file, the units of its columns, by the names of these columns.

    Raises:
        BadInput: two files tell two units for columns of the same names.
    """
    by_key: dict[Key, list[tuple[Path, Unit]]] = defaultdict(list)
    for path, contents in contents_by_path.items():
        for key, unit in contents.units.items():
            by_key[key].append((path, unit))
    units_by_path: dict[Path, dict[Key, Unit]] = defaultdict(dict)
    for key, units in by_key.items():
        if len({u.factor for _, u in units if u.sure}) > 1 and not any(u.shared for _, u in units):
            continue  # such as times: each file may have its own unit
        source, unit = _first(key, units)
        differing = [
            path for path, file_unit in units if unit.sure and file_unit.factor != unit.factor
        ]
        for path in (*differing, *_asking(key, refused, unit.sure)):
            units_by_path[path][key] = _as_in(source, unit)
    return dict(units_by_path)


def _asking(key: Key, refused: Mapping[Path, BadInput], sure: bool) -> list[Path]:
    """List refused files that lack the unit of these columns and may take it from other files."""
    return [
        path
        for path, error in refused.items()
        if isinstance(error, UnknownUnit) and error.key == key and (sure or not error.large)
    ]


def _first(key: Key, units: list[tuple[Path, Unit]]) -> tuple[Path, Unit]:
    """Return the first file whose numbers surely tell the unit, else the first file; and the unit.

    Raises:
        BadInput: two files surely tell two different units.
    """
    sure = {unit.factor: (path, unit) for path, unit in reversed(units) if unit.sure}
    if len(sure) > 1:
        listing = " and ".join(f"{_short(unit)} in {path.name}" for path, unit in sure.values())
        raise BadInput(
            f"the columns {', '.join(key)} are{listing}, by their size",
            where="the files",
            expected="one unit for columns of one name",
            remedy="Rename these columns after their units.",
        )
    return next(iter(sure.values()), units[0])


def _as_in(path: Path, unit: Unit) -> Unit:
    return replace(unit, note=f"{_short(unit)}, as in {path.name}" if unit.note else "")


def _short(unit: Unit) -> str:
    return unit.note.partition(",")[0]
