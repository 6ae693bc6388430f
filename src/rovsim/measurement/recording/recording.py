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

AUX_PREFIX = "beside_"  # what was logged beside the commands


@dataclass(frozen=True, eq=False)
class Recording:
    """One run as it was measured, on the MoCap clock.

    Where no full poses were measured, there are only channels: `time` holds the times of all of
    them, `rate` is that of the fastest, and `tracked` is False throughout.

    Attributes:
        run: which run it is.
        site: where it was recorded.
        time: (n,) s, increasing.
        position: (n, 3), NED, m.
        attitude: (n, 4), unit quaternion (w, x, y, z) from FRD to NED.
        tracked: bool (n,), False where the body was not seen (the pose there is NaN).
        commands: what was commanded.
        rate: nominal rate, Hz.
        nu: (n, 6), exported body velocities in FRD, m/s and rad/s, which are means from time[k] to
            time[k+1]; None if there are none.
        channels: further measured channels, by kind (`channels.CHANNEL_KINDS`).
        sensors: places and delays of what measured the channels.
    """

    run: RunInfo
    site: Site
    time: Array
    position: Array
    attitude: Array
    tracked: Array
    commands: Commands
    rate: float
    nu: Array | None = None
    channels: Mapping[str, Channel] = field(default_factory=dict)
    sensors: Sensors = field(default_factory=Sensors)

    @property
    def posed(self) -> bool:
        """Whether this is a recording of full poses, even if the body was never seen."""
        return bool(self.tracked.any()) or not self.channels

    def write(self, path: Path) -> None:
        """Write to `.npz`."""
        arrays = {**labels(self.run, self.site, self.commands), "time": self.time}
        arrays |= {"position": self.position, "attitude": self.attitude, "found": self.tracked}
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
    """Arrays with run, site and commands, which every stage of processing stores."""
    auxiliary = commands.auxiliary
    return {
        "run": np.array([run.id, run.control, run.split, commands.kind]),
        "tank": site.tank,
        "axes": site.axes,
        "level": np.array(site.level),
        "command_time": commands.time,
        "command_value": commands.value,
        **{f"{AUX_PREFIX}{name}": np.stack([x.time, x.value]) for name, x in auxiliary.items()},
    }


def unlabelled(a: dict[str, Array]) -> tuple[RunInfo, Site, Commands]:
    """Put together run, site and commands from the arrays of `labels`."""
    *run, kind = (str(s) for s in a["run"])
    auxiliary = {
        name.removeprefix(AUX_PREFIX): Logged(a[name][0], a[name][1])
        for name in a
        if AUX_PREFIX in name
    }
    value = a["command_value"]
    commands = Commands(a["command_time"], value, kind, auxiliary)  # type: ignore[arg-type]
    return RunInfo(*run), Site(a["tank"], a["axes"], float(a["level"])), commands
