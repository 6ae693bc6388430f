"""A run as it was logged, in NED and FRD, before any filtering."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Mapping

import numpy as np
from numpy import ndarray as Array

from rovsim.core.array_files import read_arrays, write_arrays
from rovsim.core.run import Commands, Logged, RunInfo, Site
from rovsim.measurement.recording.channels import Channel, by_name, from_names
from rovsim.measurement.sensors import Sensors

BESIDE = "beside_"  # what was logged beside the commands


@dataclass(frozen=True, eq=False)
class Recording:
    """One run on the MoCap clock.

    `time` (n,) s, increasing; `position` (n, 3) m in NED; `attitude` (n, 4) quaternion body to
    world; `found` (n,) False where the body was not seen (the pose there is NaN); `nu` (n, 6) the
    export's own body velocities, bin means from time[k] to time[k+1], or None; `rate` nominal Hz.

    `channels` are what else was measured (`channels.KINDS`), of `sensors`. Where no full pose was,
    they are all there is: `time` holds the times of all channels, `rate` is that of the fastest,
    and `found` is False throughout.
    """

    run: RunInfo
    site: Site
    time: Array
    position: Array
    attitude: Array
    found: Array
    commands: Commands
    rate: float
    nu: Array | None = None
    channels: Mapping[str, Channel] = field(default_factory=dict)
    sensors: Sensors = field(default_factory=Sensors)

    @property
    def posed(self) -> bool:
        """Whether it is a recording of full poses, seen or not."""
        return bool(self.found.any()) or not self.channels

    def write(self, path: Path) -> None:
        """Write to `.npz`."""
        arrays = {**labels(self.run, self.site, self.commands), "time": self.time}
        arrays |= {"position": self.position, "attitude": self.attitude, "found": self.found}
        arrays["rate"] = np.array(self.rate)
        if self.nu is not None:
            arrays["nu"] = self.nu
        if self.channels:
            arrays |= dict(by_name(self.channels))
            arrays["sensors"] = np.array(self.sensors.model_dump_json())
        write_arrays(path, **arrays)

    @staticmethod
    def read(path: Path) -> "Recording":
        """Read what `write` wrote."""
        a = read_arrays(path)
        run, site, commands = unlabelled(a)
        channels = from_names(a)
        sensors = Sensors.model_validate_json(str(a["sensors"])) if channels else Sensors()
        return Recording(
            run,
            site,
            a["time"],
            a["position"],
            a["attitude"],
            a["found"],
            commands,
            float(a["rate"]),
            a.get("nu"),
            channels,
            sensors,
        )


def labels(run: RunInfo, site: Site, commands: Commands) -> dict[str, Array]:
    """The arrays that every stage of a run carries along."""
    beside = commands.auxiliary
    return {
        "run": np.array([run.id, run.control, run.split, commands.kind]),
        "tank": site.tank,
        "axes": site.axes,
        "level": np.array(site.level),
        "command_time": commands.time,
        "command_value": commands.value,
        **{f"{BESIDE}{name}": np.stack([x.time, x.value]) for name, x in beside.items()},
    }


def unlabelled(a: dict[str, Array]) -> tuple[RunInfo, Site, Commands]:
    """Undo `labels`."""
    *run, kind = (str(s) for s in a["run"])
    beside = {
        name.removeprefix(BESIDE): Logged(a[name][0], a[name][1]) for name in a if BESIDE in name
    }
    value = a["command_value"]
    commands = Commands(a["command_time"], value, kind, beside)  # type: ignore[arg-type]
    return RunInfo(*run), Site(a["tank"], a["axes"], float(a["level"])), commands
