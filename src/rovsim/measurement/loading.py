"""Read `campaign.yaml` and check the campaign that it describes."""

import os
import re
import unicodedata
from pathlib import Path
from typing import Mapping, Sequence

from rovsim.core.axes import AXES
from rovsim.core.errors import BadInput, unlisted
from rovsim.core.schema import checked
from rovsim.core.yaml_files import read_yaml
from rovsim.measurement.campaign import Campaign
from rovsim.measurement.campaign_file import CampaignFile, CommandLog, Mocap, Run
from rovsim.measurement.recording.readers import (
    CommandReader,
    FileAxes,
    MocapReader,
    command_readers,
    mocap_readers,
)
from rovsim.measurement.unanswered import check_answered


def load_campaign(path: Path) -> Campaign:
    """Load a folder that holds `campaign.yaml`, or such a file under another name.

    Raises:
        BadInput: a key, a value or a recording is wrong or missing.
    """
    file = _campaign_file(Path(os.path.expanduser(path))).absolute()
    plain = read_yaml(file)
    check_answered(plain, file)
    content = checked(CampaignFile, plain, file)
    check_ids(content.runs, file)
    _check_options(content.mocap, "mocap", mocap_readers(), file)
    _check_axes(content.mocap, file)
    if content.commands is not None:
        _check_options(content.commands, "commands", command_readers(), file)
    _check_commands(content, file)
    fields = dict(content) | {"runs": tuple(content.runs), "folder": _folder(content.folder, file)}
    campaign = Campaign(file=file, **fields)
    _check_files(campaign)
    return campaign


def _campaign_file(path: Path) -> Path:
    file = path / "campaign.yaml" if path.is_dir() else path
    if not file.is_file():
        raise BadInput(
            "no campaign.yaml in this folder" if path.is_dir() else "no such file or folder",
            where=path,
            expected="a folder that holds campaign.yaml",
            remedy="Check the path; `rovsim init FOLDER` writes that file from recordings.",
        )
    return file


def check_ids(runs: Sequence[Run], where: Path | str) -> None:
    """Refuse two runs whose ids some file systems could not tell apart.

    Args:
        runs: the runs.
        where: the file, named in the error.

    Raises:
        BadInput: there are two such ids; it names both.
    """
    ids: dict[str, str] = {}
    for n, run in enumerate(runs):
        # some file systems see neither case nor Unicode form
        key = unicodedata.normalize("NFC", run.id).casefold()
        if key in ids:
            raise BadInput(
                f"'runs.{n}.id' is {run.id!r}, and an earlier run is {ids[key]!r}",
                where=where,
                expected="a different id for each run (case does not count)",
                remedy="Rename one of them.",
            )
        ids[key] = run.id


def _check_axes(mocap: Mocap, file: Path) -> None:
    """Refuse axes that do not belong to the stated format of the file."""
    readers, plain = mocap_readers(), FileAxes()
    file_axes = readers[mocap.format].axes if mocap.format in readers else plain
    allowed = {*plain.every, *file_axes.every}
    foreign = [axes for axes in (mocap.world_axes, mocap.body_axes) if axes not in allowed]
    if not foreign:
        return
    other_formats = "; ".join(
        f"{' and '.join(extra)} are those of {name}"
        for name, reader in readers.items()
        if (extra := [axes for axes in reader.axes.every if axes not in plain.every])
    )
    raise BadInput(
        f"the axes '{foreign[0]}' with 'mocap.format: {mocap.format}'",
        where=file,
        expected=f"{' or '.join(plain.world)}, and {' or '.join(plain.body)}; {other_formats}",
        remedy="Turn the file's axes, or name those it has.",
    )


def _check_commands(content: CampaignFile, file: Path) -> None:
    log = content.commands
    commanded = [run.id for run in content.runs if run.commanded]
    if log is None and commanded:
        raise BadInput(
            f"'commands' is missing, and run '{commanded[0]}' has commands",
            where=file,
            expected="'commands' with format, kind and columns",
            remedy="Add it, or write 'commands: none' in each run in which nothing was commanded.",
        )
    if log is not None and log.axes and not log.per_axis:
        raise BadInput(
            f"'commands.axes' with 'commands.kind: {log.kind}', which is per thruster",
            where=file,
            expected="axes of what is commanded per axis: kind demand or wrench",
            remedy="Leave 'axes' out, or correct 'kind'.",
        )
    if log is not None and (unknown := [name for name in log.angles if name not in log.names]):
        raise unlisted(
            unknown[0],
            log.names,
            found=f"'commands.angles' names '{unknown[0]}', which is none of 'commands.columns'",
            where=file,
        )
    if log is not None and log.per_axis and len(log.axis_numbers) != len(log.columns):
        raise BadInput(
            f"'commands.columns' names {len(log.columns)} columns for kind {log.kind}",
            where=file,
            expected=f"columns named after the axes, or six in the order {', '.join(AXES)}",
            remedy="List all six columns, name them after their axes, or give 'axes' as well.",
        )


def _check_options(
    section: Mocap | CommandLog,
    name: str,
    readers: Mapping[str, MocapReader] | Mapping[str, CommandReader],
    file: Path,
) -> None:
    """Refuse options of another format than the one that a section of the file states.

    Args:
        section: the section.
        name: of the section.
        readers: of all formats that it may state.
        file: the campaign file, for the error.
    """
    if section.format not in readers:  # which is told where the file is read
        return
    own = readers[section.format].options
    for reader in readers.values():
        for option, meaning in reader.options.items():
            if option not in own and getattr(section, option):
                raise BadInput(
                    f"'{name}.{option}' with '{name}.format: {section.format}'",
                    where=file,
                    expected=f"{meaning}: 'format: {reader.name}'",
                    remedy="Leave it out, or correct 'format'.",
                )


def _folder(text: str, file: Path) -> Path:
    """Folder of the recordings: `text`, relative to the file, with its variables expanded."""

    def value(match: re.Match[str]) -> str:
        name = match["name"] or match["bare"]
        setting = os.environ.get(name) or match["default"]
        if setting is None:
            raise BadInput(
                f"'folder' is {text!r}, and the environment has no {name}",
                where=file,
                expected=f"{name} set to the folder of the recordings",
                remedy=f"Set it, or give a default: ${{{name}:-../recordings}}.",
            )
        return setting

    pattern = r"\$(?:\{(?P<name>\w+)(?::-(?P<default>[^}]*))?\}|(?P<bare>\w+))"
    folder = os.path.expanduser(re.sub(pattern, value, text))
    return Path(os.path.normpath(file.parent / folder))


def _files_of(campaign: Campaign, run: Run) -> list[tuple[str, Path]]:
    measured = [("mocap", path) for path in campaign.mocap_paths(run)]
    return [*measured, *([("commands", campaign.commands_path(run))] if run.commanded else [])]


def _check_files(campaign: Campaign) -> None:
    missing = [
        (key, run.id, path)
        for run in campaign.runs
        for key, path in _files_of(campaign, run)
        if not path.exists()
    ]
    if not missing:
        return
    key, run_id, first_path = missing[0]
    others = dict.fromkeys(path.name for _, _, path in missing if path != first_path)
    also_missing = f"; so are {', '.join(others)}" if others else ""
    remedy = (
        f"Put {'them' if others else 'it'} there, correct '{key}' of that run, or set 'folder' (or "
        "the environment variable that it names) to where the recordings are."
    )
    raise BadInput(
        f"the {key} file of run '{run_id}' is missing: {first_path}{also_missing}",
        where=campaign.file,
        expected=f"{'these files' if others else 'that file'} in {campaign.folder}",
        remedy=f"{remedy} {campaign.source}".strip(),
    )
