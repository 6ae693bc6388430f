"""The surroundings of a rule's script: its files and settings, a log, errors in one message."""

import json
import logging
import sys
import traceback
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Iterator

from rovsim.core.bounded_cache import ReadAgain, Remade, read_again
from rovsim.core.collector import end_at_once
from rovsim.core.errors import RovsimError
from rovsim.core.names import as_list
from rovsim.core.progress import heard_by
from rovsim.core.schema import S, checked
from rovsim.measurement.signals.motion import Motion

if TYPE_CHECKING:  # a study has a hundred jobs: each imports what it uses, where it uses it
    from rovsim.dynamics.catalogue import Catalogue
    from rovsim.dynamics.model import Model
    from rovsim.dynamics.vehicle import Vehicle
    from rovsim.measurement.campaign import Campaign
    from rovsim.measurement.runs import Runs
    from rovsim.simulation.prediction import Replay


@dataclass(frozen=True)
class Job:
    """One job of a rule: its files and settings, read as objects of the library.

    Attributes:
        snakemake: the object that Snakemake gives a script.
    """

    snakemake: Any

    @cached_property
    def catalogue(self) -> "Catalogue":
        """All effects that models can have, with those of the user's own files."""
        from rovsim.dynamics.catalogue import load_catalogue

        return load_catalogue(
            [Path(name) for name in self.snakemake.config.get("effects_file", [])]
        )

    @property
    def params(self) -> Any:
        """Parameters of the rule."""
        return self.snakemake.params

    @property
    def wildcards(self) -> Any:
        """Values of the rule's wildcards."""
        return self.snakemake.wildcards

    def paths(self, name: str) -> list[Path]:
        """Return the input files under a name, none where the rule left it empty."""
        files = self.snakemake.input.get(name) or []
        return [Path(path) for path in as_list(files)]

    def path(self, name: str) -> Path:
        """Return the one input file under a name."""
        (path,) = self.paths(name)
        return path

    def output(self, name: str | int = 0) -> Path:
        """Return an output file by its name or position."""
        return Path(self.snakemake.output[name])

    def outputs(self) -> dict[str, list[Path]]:
        """Return all output files by name."""
        return {
            name: [Path(path) for path in as_list(files)]
            for name, files in self.snakemake.output.items()
        }

    def contents(self, *names: str) -> dict[str, Path]:
        """Return the input files under these names; names that the rule lacks are left out."""
        return {name: path for name in names for path in self.paths(name)}

    def section(self, kind: type[S]) -> S:
        """Parse the rule's settings, which are JSON, as a section of the configuration.

        Raises:
            BadInput: a value is not allowed.
        """
        return checked(kind, json.loads(self.params.settings), "conf")

    def motions(self, name: str = "motions") -> ReadAgain[Motion]:
        """Return the motions of input files, each read when it is asked for."""
        return ReadAgain(self.paths(name), Motion.read)

    @property
    def campaign(self) -> "Campaign":
        """The campaign of the input `campaign`."""
        from rovsim.measurement.loading import load_campaign

        return load_campaign(self.path("campaign"))

    @property
    def vehicle(self) -> "Vehicle":
        """The vehicle of the campaign."""
        from rovsim.application.pipeline.recorded_run import load_campaign_vehicle

        return load_campaign_vehicle(self.campaign)

    def model(self, name: str) -> "Model":
        """Load the input `model`, or without such an input the built-in model of this name.

        Args:
            name: that the model gets.
        """
        from rovsim.dynamics.model_file import load_model

        spec = str(self.path("model")) if self.paths("model") else name
        return load_model(spec, self.vehicle, self.catalogue).called(name)

    def models(self) -> "list[Model]":
        """Read the input `models`; each is named after its folder."""
        from rovsim.dynamics.model_file import read_model

        files = self.paths("models")
        return [read_model(path, self.catalogue).called(path.parent.name) for path in files]

    def runs(self) -> "Runs":
        """Read the usable runs of the input `motions`, with their poses before the filter."""
        from rovsim.measurement.runs import Runs

        return Runs.read(self.paths("motions"), self.paths("stages"))

    def replays(self) -> "dict[str, Remade[Replay]]":
        """Return the input `replays` by model and run, in the rule's order; read when asked for."""
        from rovsim.simulation.prediction import Replay

        by_model: dict[str, dict[str, Path]] = {}
        for path in self.paths("replays"):  # MODEL/RUN.npz
            by_model.setdefault(path.parent.name, {})[path.stem] = path
        return {model: read_again(runs, Replay.read) for model, runs in by_model.items()}


@contextmanager
def job(snakemake: Any) -> Iterator[Job]:
    """Run a script's body as a job that logs to the rule's log file.

    A `RovsimError` becomes one message and exit code 2; other errors are logged and raised.
    """
    end_at_once()
    path = snakemake.log[0]
    logging.basicConfig(filename=path, level=logging.INFO, format="%(asctime)s %(message)s")
    logging.info("rule %s %s", snakemake.rule, dict(snakemake.wildcards))
    try:
        with heard_by():
            yield Job(snakemake)
    except RovsimError as error:
        logging.error("%s", error)
        print(f"rovsim: {error}", file=sys.stderr)
        sys.exit(2)
    except Exception:
        logging.error("%s", traceback.format_exc())
        raise
    logging.info("done")
