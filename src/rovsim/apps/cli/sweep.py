"""A Hydra multirun, and one job of it; importable, so that every launcher can send it to a worker.

A run that fails leaves `failed.txt` in its folder, and the others continue: the launcher decides
where and in what order they run, and Hydra does not pass on what they return.
"""

import os
import sys
from itertools import count
from pathlib import Path
from shutil import which
from typing import Any, Sequence

from rovsim.application.configuration import compose, settings_of, sweep_folder
from rovsim.application.settings import Settings
from rovsim.apps.cli.complaint import describe_os_error, warn
from rovsim.apps.cli.unfinished import CONTINUED, run_unfinished
from rovsim.core.errors import BadInput, RovsimError
from rovsim.core.files import make_folder, write_text
from rovsim.core.model_names import name_learned
from rovsim.measurement.loading import load_campaign

SLURM_LAUNCHER = "hydra/launcher=submitit_slurm"
SWEEP_FOLDER_KEY = "hydra.sweep.dir"
FAILURE_FILE = "failed.txt"
# What a run's name has without this, or what is the same in all of them.
NAMED_KEYS = ("command", "campaign", "residual", "control", "out", "output")


def run_sweep(overrides: Sequence[str], campaigns: Sequence[Path]) -> None:
    """Let Hydra run a command once for every combination of the given values.

    Args:
        overrides: of the command line; some of them have several values.
        campaigns: folders that `check_sweep` returned.

    Raises:
        BadInput: there is no launcher, a campaign cannot be read, or some of the runs failed; all
            others are done.
    """
    check_launcher(overrides)
    check_campaigns(campaigns)
    words = [word for word in overrides if not word.startswith(f"{SWEEP_FOLDER_KEY}=")]
    folder = choose_sweep_folder(sweep_folder(first_values(overrides)), given=words != [*overrides])
    for path in folder.rglob(FAILURE_FILE):
        path.unlink()
    try:
        _run_all(words, folder)
    except KeyboardInterrupt:
        if any(f"command={name}" in words for name in CONTINUED):
            warn(f"the same sweep with {SWEEP_FOLDER_KEY}={folder} goes on where this one ends")
        raise
    refuse_failed(folder)


def _run_all(words: Sequence[str], folder: Path) -> None:
    """Let Hydra run all combinations of the overrides, in inner folders of a folder."""
    import hydra

    from rovsim.application.conf_search import first_folder

    os.environ.setdefault("HYDRA_FULL_ERROR", "1")  # errors come here, as they are
    literal = str(folder).replace("\\", "\\\\").replace("'", "\\'")
    sys.argv = ["rovsim", "--multirun", *words, f"{SWEEP_FOLDER_KEY}='{literal}'"]
    hydra.main(version_base="1.3", config_path=first_folder(), config_name="config")(job)()


def choose_sweep_folder(folder: Path, given: bool) -> Path:
    """Make the folder of a sweep.

    Unless the user has `given` it, a number is added where another sweep has the same: two sweeps
    that begin in the same second would write over each other's runs.

    Raises:
        BadInput: the folder cannot be made.
    """
    if given:
        make_folder(folder)
        return folder
    make_folder(folder.parent)
    for number in count(1):
        candidate = folder if number == 1 else folder.with_name(f"{folder.name}_{number}")
        try:
            candidate.mkdir()
        except FileExistsError:
            continue
        return candidate
    raise AssertionError  # it counts on


def refuse_failed(folder: Path) -> None:
    """Say which runs of a sweep failed.

    Raises:
        BadInput: some did.
    """
    failed = sorted(folder.rglob(FAILURE_FILE), key=lambda path: (len(path.parent.name), path))
    if failed:
        numbers = ", ".join(path.parent.name for path in failed)
        raise BadInput(
            f"{len(failed)} of the runs failed ({numbers})",
            where=folder,
            expected="runs that all end",
            remedy=f"The others are kept. Why it failed stands in the {FAILURE_FILE} of each: mend "
            "that, and sweep over its values alone.",
        )


def job(composed: Any) -> None:
    """Run the command for one combination of values; its results go to the job's own folder.

    An error is printed, and noted in a file for the end of the sweep, which continues.
    """
    from hydra.core.hydra_config import HydraConfig

    hydra = HydraConfig.get()
    try:
        settings = name_run(settings_of(composed), hydra.overrides.task)
        out = choose_out(settings.out, hydra.runtime.output_dir, hydra.sweep.subdir)
        run_unfinished(settings, Path(out))
    except (RovsimError, OSError) as error:
        if isinstance(error, BrokenPipeError):
            raise
        reason = describe_os_error(error) if isinstance(error, OSError) else str(error)
        words = " ".join(hydra.overrides.task[1:])  # without the command
        message = f"run {hydra.job.num} of the sweep ({words}): {reason}"
        warn(message)
        write_text(Path(hydra.runtime.output_dir, FAILURE_FILE), f"{message}\n")


def first_values(overrides: Sequence[str]) -> list[str]:
    """Return the overrides of a sweep's first run: the first value of each."""
    pairs = [(word, _list_values(word)) for word in overrides]
    return [f"{word.partition('=')[0]}={v[0]}" if v else word for word, v in pairs]


def check_sweep(overrides: Sequence[str]) -> list[Path]:
    """Check the settings of a sweep before any run begins: each value with the others' first.

    Returns:
        The campaigns that the values name, each once.

    Raises:
        BadInput: one of the values cannot be used.
    """
    runs = [compose(words) for words in _vary_one(overrides)]
    for run in runs:
        run.learner  # noqa: B018 - its settings are checked when they are asked for
    return [Path(name) for name in dict.fromkeys(run.campaign for run in runs) if name is not None]


def check_campaigns(folders: Sequence[Path]) -> None:
    """Check that the campaigns of a sweep can be read; otherwise all its runs would fail.

    Raises:
        BadInput: one of them cannot be read.
    """
    for folder in folders:
        load_campaign(folder)


def _vary_one(overrides: Sequence[str]) -> list[list[str]]:
    """Return the overrides of the first run, and of each further value with the others' first."""
    first = first_values(overrides)
    others = [
        (k, f"{word.partition('=')[0]}={value}")
        for k, word in enumerate(overrides)
        for value in _list_values(word)[1:]
    ]
    return [first, *([*first[:k], word, *first[k + 1 :]] for k, word in others)]


def check_launcher(overrides: Sequence[str]) -> None:
    """Check that Slurm is there if runs are to be sent to it: by `srun`, as the launcher does.

    Raises:
        BadInput: it is not.
    """
    if SLURM_LAUNCHER in overrides and which("srun") is None:
        raise BadInput(
            "no Slurm is on this machine (there is no 'srun')",
            where=SLURM_LAUNCHER,
            expected="a node from which jobs can be sent",
            remedy="Run it there, or leave that out: the sweep then runs here.",
        )


def _list_values(word: str) -> list[str]:
    """Return the values that an override sweeps over; none for a single or unreadable value."""
    from hydra.core.override_parser.overrides_parser import OverridesParser
    from hydra.errors import OverrideParseException

    try:
        parsed = OverridesParser.create().parse_override(word)
    except OverrideParseException:
        return []  # composed as it is, it is refused
    return list(parsed.sweep_string_iterator()) if parsed.is_sweep_override() else []


def choose_out(given: str | None, own: str, name: str) -> str:
    """Return the folder of a job: `own`, which Hydra chose, or `name` in a folder that is given."""
    return own if given is None else str(Path(given, name))


def name_run(settings: Settings, overrides: Sequence[str]) -> Settings:
    """Return the settings with a name by which MLflow distinguishes the runs of a sweep."""
    words = [word for word in overrides if word.partition("=")[0].lstrip("+") not in NAMED_KEYS]
    if settings.tracking.name or not words:
        return settings
    name = " ".join([name_learned(settings.learner.kind, settings.control), *words])
    tracking = settings.tracking.model_copy(update={"name": name})
    return settings.model_copy(update={"tracking": tracking})
