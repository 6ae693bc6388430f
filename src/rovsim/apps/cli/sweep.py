"""One job of a Hydra multirun; importable, so that every launcher can send it to a worker."""

from pathlib import Path
from shutil import which
from typing import Any, Sequence

from rovsim.application.configuration import compose, settings_of
from rovsim.application.settings import Settings
from rovsim.apps.cli.complaint import complain
from rovsim.apps.cli.dispatch import run_command
from rovsim.core.errors import BadInput, RovsimError
from rovsim.core.model_names import name_learned

SLURM = "hydra/launcher=submitit_slurm"
# What a run's name has without this, or what is the same in all of them.
NAMED = ("command", "campaign", "residual", "control", "out", "output")


def job(composed: Any) -> None:
    """Run the command of one combination; its results go to the job's own folder."""
    from hydra.core.hydra_config import HydraConfig

    hydra = HydraConfig.get()
    try:
        settings = name_run(settings_of(composed), hydra.overrides.task)
        out = choose_out(settings.out, hydra.runtime.output_dir, hydra.sweep.subdir)
        run_command(settings.model_copy(update={"out": out}))
    except RovsimError as error:
        complain(str(error))


def check_sweep(overrides: Sequence[str]) -> None:
    """Compose the run of each value, the others at their first, before any of them begins.

    Raises:
        BadInput: one of the values cannot be used.
    """
    first: list[str] = []
    others: list[tuple[int, str]] = []
    for word in overrides:
        key, values = word.partition("=")[0], _list_values(word)
        others += [(len(first), f"{key}={value}") for value in values[1:]]
        first.append(f"{key}={values[0]}" if values else word)
    for run in (first, *([*first[:k], word, *first[k + 1 :]] for k, word in others)):
        compose(run).learner  # noqa: B018 - its settings are checked when they are asked for


def check_launcher(overrides: Sequence[str]) -> None:
    """Look for Slurm, where runs are to go to one: by `srun`, as the launcher does.

    Raises:
        BadInput: there is none.
    """
    if SLURM in overrides and which("srun") is None:
        raise BadInput(
            "no Slurm is on this machine (there is no 'srun')",
            where=SLURM,
            expected="a node from which jobs can be sent",
            remedy="Run it there, or leave that out: the sweep then runs here.",
        )


def _list_values(word: str) -> list[str]:
    """The values that an override sweeps over; none where it has one, or cannot be read."""
    from hydra.core.override_parser.overrides_parser import OverridesParser
    from hydra.errors import OverrideParseException

    try:
        parsed = OverridesParser.create().parse_override(word)
    except OverrideParseException:
        return []  # composed as it is, it is refused
    return list(parsed.sweep_string_iterator()) if parsed.is_sweep_override() else []


def choose_out(given: str | None, own: str, name: str) -> str:
    """Folder of a job: `own` is Hydra's; in a folder that is given, one of the same name."""
    return own if given is None else str(Path(given, name))


def name_run(settings: Settings, overrides: Sequence[str]) -> Settings:
    """The settings, with a name that tells one MLflow run of a sweep from another."""
    own = [word for word in overrides if word.partition("=")[0].lstrip("+") not in NAMED]
    if settings.tracking.name or not own:
        return settings
    name = " ".join([name_learned(settings.learner.kind, settings.control), *own])
    tracking = settings.tracking.model_copy(update={"name": name})
    return settings.model_copy(update={"tracking": tracking})
