"""A campaign: one folder of raw recordings, described by `campaign.yaml`."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rovsim.core.errors import unlisted
from rovsim.core.rotations import axes_signs
from rovsim.measurement.campaign_file import CommandLog, Mocap, Run, Tank


@dataclass(frozen=True)
class Campaign:
    """A checked campaign: every file of every run was there when it was loaded.

    Attributes:
        name: of the campaign.
        vehicle: a name or a path; a relative path is relative to `file.parent`.
        tank: its walls; None where not stated.
        mocap: how the motion was exported.
        commands: how the commands were logged; None where no run has any.
        runs: the runs, in the order of the file.
        file: the campaign file.
        folder: the folder that the paths of the runs are relative to.
        source: where to get the recordings.
    """

    name: str
    vehicle: str
    tank: Tank | None
    mocap: Mocap
    commands: CommandLog | None
    runs: tuple[Run, ...]
    file: Path
    folder: Path
    source: str = ""

    def run(self, run_id: str) -> Run:
        """Return the run with that id.

        Raises:
            BadInput: there is none.
        """
        runs = {run.id: run for run in self.runs}
        if run_id not in runs:
            raise unlisted(run_id, runs, found=f"no run '{run_id}'", where=self.file)
        return runs[run_id]

    @property
    def files(self) -> list[Path]:
        """The campaign file and all files that its runs are read from, sorted."""
        raw = {path for run in self.runs for path in self.raw_files(run)}
        return sorted({self.file} | raw)

    def mocap_paths(self, run: Run) -> list[Path]:
        """Absolute paths of the files with the run's measurements: one, or one for each sensor."""
        return [self.folder / name for name in run.sensor_files]

    def commands_path(self, run: Run) -> Path:
        """Absolute path of the command log of a run that has one."""
        return self.folder / run.commands

    def raw_files(self, run: Run) -> list[Path]:
        """Files that hold the run, each once; for a folder (a ROS 2 bag) the files in it."""
        paths = [*self.mocap_paths(run), *([self.commands_path(run)] if run.commanded else [])]
        groups = [sorted(p.iterdir()) if p.is_dir() else [p] for p in paths]
        return list(dict.fromkeys(path for files in groups for path in files))

    def tank_ned(self) -> np.ndarray:
        """Low and high walls (3, 2) along the axes of NED, m; NaN where unknown."""
        walls = np.array([getattr(self.tank, axis, None) or [np.nan] * 2 for axis in "xyz"])
        return np.sort(walls * self.world_signs()[:, None], axis=1)

    def world_signs(self) -> np.ndarray:
        """Signs (3,) between the MoCap world axes and NED."""
        return axes_signs(self.mocap.world_axes)
