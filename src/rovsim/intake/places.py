"""How the campaign.yaml that is to be written refers to the recordings."""

import os
from dataclasses import dataclass, field
from pathlib import Path

from rovsim.intake.collect_files import CollectedFiles
from rovsim.intake.names import campaign_name
from rovsim.intake.survey.contents import Contents

CONVERTED_FOLDER = "converted"  # folder of copies whose columns have rovsim's names and units


@dataclass(frozen=True)
class Places:
    """Paths of the recordings as campaign.yaml has them.

    Attributes:
        name: of the campaign.
        folder: key `folder` of campaign.yaml: the recordings' common folder relative to `out`;
            empty where they lie in `out`.
        base: the absolute folder to which the paths of runs are relative.
        out: the absolute folder in which campaign.yaml will be written.
        copies: files to be copied, and the path of each copy in `out`.
        names: path of each recording as a run gives it, by the path that its owner knows.
    """

    name: str
    folder: str
    base: Path
    out: Path
    copies: dict[Path, str] = field(default_factory=dict)
    names: dict[Path, str] = field(default_factory=dict)

    @staticmethod
    def beside(collected: CollectedFiles, out: Path) -> "Places":
        """Refer to collected files where they lie, and to copies where these will be written."""
        out = out.absolute()
        sources = [
            file for source in (*collected.motions, *collected.logs) for file in source.files
        ]
        files = [source.path.absolute() for source in sources if source.original is None]
        inside = all(file.is_relative_to(out) for file in files)
        base = out if inside else Path(os.path.commonpath([file.parent for file in files]))
        folder = "" if inside else _relative(base, out)
        if "$" in folder:  # would be read as an environment variable
            folder, base = "", out
        places = Places(campaign_name(out.name), folder, base, out)
        for source in sources:
            places.names[source.named] = places._place(source)
        return places

    def of(self, named: Path) -> str:
        """Return the path that a run gives for a file of the user's."""
        return self.names[named]

    def _place(self, one: Contents) -> str:
        if one.original is None:
            return _relative(one.path.absolute(), self.base)
        names = (f"{CONVERTED_FOLDER}/{k or ''}{one.path.name}" for k in range(len(self.names) + 1))
        self.copies[one.path] = next(n for n in names if n not in self.copies.values())
        return _relative(self.out / self.copies[one.path], self.base)


def _relative(path: Path, base: Path) -> str:
    """Make a path relative to `base`, or keep it where they only share the root directory."""
    shared = os.path.commonpath([path, base])
    if shared == os.path.sep:
        return str(path)
    return Path(os.path.relpath(path, base)).as_posix()
