"""What surrounds the script of a rule: its files and settings, a log, errors in one message."""

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
    """One job of a rule, in the library's terms; `snakemake` is what Snakemake gives a script."""

    snakemake: Any

    @cached_property
    def catalogue(self) -> "Catalogue":
        """Effects that models can have, those of the user's files among them."""
        from rovsim.dynamics.catalogue import load_catalogue

        return load_catalogue(
            [Path(name) for name in self.snakemake.config.get("effects_file", [])]
        )

    @property
    def params(self) -> Any:
        """What the rule gives beside files and settings."""
        return self.snakemake.params

    @property
    def wildcards(self) -> Any:
        """What the rule's wildcards stand for."""
        return self.snakemake.wildcards

    def paths(self, name: str) -> list[Path]:
        """Input files of a name, none where the rule left it empty."""
        given = self.snakemake.input.get(name) or []
        return [Path(path) for path in as_list(given)]

    def path(self, name: str) -> Path:
        """The one input file of a name."""
        (path,) = self.paths(name)
        return path

    def output(self, name: str | int = 0) -> Path:
        """An output file."""
        return Path(self.snakemake.output[name])

    def outputs(self) -> dict[str, list[Path]]:
        """Output files by name."""
        return {
            name: [Path(path) for path in as_list(given)]
            for name, given in self.snakemake.output.items()
        }

    def contents(self, *names: str) -> dict[str, Path]:
        """Those of the input files of these names that the rule has."""
        return {name: path for name in names for path in self.paths(name)}

    def section(self, kind: type[S]) -> S:
        """The rule's settings, JSON, as a section of the configuration.

        Raises:
            BadInput: one of them does not fit.
        """
        return checked(kind, json.loads(self.params.settings), "conf")

    def motions(self, name: str = "motions") -> ReadAgain[Motion]:
        """Runs, each read when it is asked for."""
        return ReadAgain(self.paths(name), Motion.read)

    @property
    def campaign(self) -> "Campaign":
        """That of the input `campaign`."""
        from rovsim.measurement.loading import load_campaign

        return load_campaign(self.path("campaign"))

    @property
    def vehicle(self) -> "Vehicle":
        """That of the campaign."""
        from rovsim.application.pipeline.reading import load_campaign_vehicle

        return load_campaign_vehicle(self.campaign)

    def model(self, name: str) -> "Model":
        """The input `model`, or a built-in model, under a name."""
        from rovsim.dynamics.model_file import load_model

        spec = str(self.path("model")) if self.paths("model") else name
        return load_model(spec, self.vehicle, self.catalogue).called(name)

    def models(self) -> "list[Model]":
        """The input `models`, each called by its folder."""
        from rovsim.dynamics.model_file import read_model

        files = self.paths("models")
        return [read_model(path, self.catalogue).called(path.parent.name) for path in files]

    def runs(self) -> "Runs":
        """The usable ones of the input `motions`, with their poses before the filter."""
        from rovsim.measurement.runs import Runs

        return Runs.read(self.paths("motions"), self.paths("stages"))

    def replays(self) -> "dict[str, Remade[Replay]]":
        """The input `replays` by model and run, in the order of the rule; read when asked for."""
        from rovsim.simulation.prediction import Replay

        found: dict[str, dict[str, Path]] = {}
        for path in self.paths("replays"):  # MODEL/RUN.npz
            found.setdefault(path.parent.name, {})[path.stem] = path
        return {model: read_again(runs, Replay.read) for model, runs in found.items()}


@contextmanager
def job(snakemake: Any) -> Iterator[Job]:
    """Log to the rule's log; an expected error becomes one message and exit code 2."""
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
