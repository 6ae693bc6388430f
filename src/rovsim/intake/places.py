"""Where the recordings lie beside the campaign.yaml that is to be written."""

import os
from dataclasses import dataclass, field
from pathlib import Path

from rovsim.intake.collect_files import CollectedFiles
from rovsim.intake.names import campaign_name
from rovsim.intake.survey.contents import Contents

CONVERTED = "converted"  # folder of copies whose columns have rovsim's names and units


@dataclass(frozen=True)
class Places:
    """How campaign.yaml in the folder `out` names the recordings.

    `folder` relative to `out`, empty where they lie in it; runs start from `base`, which is
    absolute. `copies`: files to be written into `out`, by where they are now.
    """

    name: str
    folder: str
    base: Path
    out: Path
    copies: dict[Path, str] = field(default_factory=dict)
    names: dict[Path, str] = field(default_factory=dict)

    @staticmethod
    def beside(found: CollectedFiles, out: Path) -> "Places":
        """Of the files that were collected: they stay where they are."""
        out = out.absolute()
        every = [file for one in (*found.motions, *found.logs) for file in one.files]
        files = [one.path.absolute() for one in every if one.original is None]
        inside = all(file.is_relative_to(out) for file in files)
        base = out if inside else Path(os.path.commonpath([file.parent for file in files]))
        folder = "" if inside else _relative(base, out)
        if "$" in folder:  # it would be taken for a variable of the environment
            folder, base = "", out
        places = Places(campaign_name(out.name), folder, base, out)
        for one in every:
            places.names[one.named] = places._place(one)
        return places

    def of(self, named: Path) -> str:
        """How a run calls a file that was named."""
        return self.names[named]

    def _place(self, one: Contents) -> str:
        if one.original is None:
            return _relative(one.path.absolute(), self.base)
        names = (f"{CONVERTED}/{k or ''}{one.path.name}" for k in range(len(self.names) + 1))
        self.copies[one.path] = next(n for n in names if n not in self.copies.values())
        return _relative(self.out / self.copies[one.path], self.base)


def _relative(path: Path, base: Path) -> str:
    """Relative where both share more than the root of the file system."""
    shared = os.path.commonpath([path, base])
    if shared == os.path.sep:
        return str(path)
    return Path(os.path.relpath(path, base)).as_posix()
