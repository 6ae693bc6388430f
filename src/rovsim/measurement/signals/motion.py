"""A run on its processed clock: poses, and the motion with velocities and accelerations."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy import ndarray as Array

from rovsim.core.array_files import read_arrays, write_arrays
from rovsim.core.run import Commands, RunInfo, Site
from rovsim.measurement.recording.recording import labels, unlabelled
from rovsim.measurement.signals.clock import find_stretches
from rovsim.measurement.signals.measured import Measured

COMMAND_MARGIN_S = 10.0  # kept of the log beside a part: longer than any delay of a command


@dataclass(frozen=True, eq=False)
class Poses:
    """Poses of a run on a uniform clock.

    Attributes:
        run: which run it is.
        site: where it was recorded.
        time: (n,) s.
        eta: (n, 7), position in NED, m, and unit quaternion (w, x, y, z) from FRD to NED,
            sign-continuous.
        usable: bool (n,), False in and beside gaps too long to bridge (a placeholder in `eta`).
        commands: what was commanded.
        measured: which components were measured; None if all.
    """

    run: RunInfo
    site: Site
    time: Array
    eta: Array
    usable: Array
    commands: Commands
    measured: Measured | None = None

    def part(self, at: slice) -> "Poses":
        """The poses of a slice of the samples."""
        return replace(
            self,
            time=self.time[at],
            eta=self.eta[at],
            usable=self.usable[at],
            measured=self.measured and self.measured.part(at),
        )

    def write(self, path: Path) -> None:
        """Write to `.npz`."""
        arrays = {"time": self.time, "eta": self.eta, "usable": self.usable}
        arrays |= dict(self.measured.by_name()) if self.measured else {}
        write_arrays(path, **labels(self.run, self.site, self.commands), **arrays)

    @staticmethod
    def read(path: Path) -> "Poses":
        """Read what `write` wrote."""
        a = read_arrays(path)
        run, site, commands = unlabelled(a)
        measured = Measured.from_names(a)
        return Poses(run, site, a["time"], a["eta"], a["usable"], commands, measured)


@dataclass(frozen=True, eq=False)
class Motion:
    """A measured run, ready to be compared with a model.

    A sampled motion (`binned` False) has a uniform clock, every value holds at time[k], and
    `state_nu` is `nu`. In a binned one `nu` is the mean over time[k] .. time[k+1], `nu_dot` the
    backward difference of these means (NaN at k = 0), and `time` may be uneven.

    Attributes:
        run: which run it is.
        site: where it was recorded.
        time: (n,) s.
        eta: (n, 7), instantaneous pose at time[k], as in `Poses`.
        nu: (n, 6), body velocity at CO in FRD, m/s and rad/s.
        nu_dot: (n, 6), its rate of change, m/s2 and rad/s2.
        state_nu: (n, 6), instantaneous velocity at time[k], from which a replay may start.
        usable: bool (n,), whether a sample or bin may be compared with a model.
        commands: what was commanded.
        binned: whether velocities are means over bins.
        end: time at which the last sample lies, or at which the last bin ends, s.
        measured: which components were measured; None if all.
    """

    run: RunInfo
    site: Site
    time: Array
    eta: Array
    nu: Array
    nu_dot: Array
    state_nu: Array
    usable: Array
    commands: Commands
    binned: bool
    end: float
    measured: Measured | None = None

    @property
    def state(self) -> Array:
        """Instantaneous states (n, 13): position, quaternion, velocity."""
        return self.state_at(slice(None))

    def state_at(self, index: Array | slice) -> Array:
        """The states (k, 13) of the samples or bins at `index`."""
        return np.concatenate([self.eta[index], self.state_nu[index]], axis=1)

    def part(self, at: slice) -> "Motion":
        """The motion of a slice of the samples or bins.

        Its commands are those from `COMMAND_MARGIN_S` before it to as long after it; their `before`
        and `after` say how much of the recording lies on either side.
        """
        names = ("time", "eta", "nu", "nu_dot", "state_nu", "usable")
        arrays = {name: getattr(self, name)[at] for name in names}
        time, bins = arrays["time"], self.time[at.stop :]
        end = float(bins[0] if self.binned and len(bins) else self.end if self.binned else time[-1])
        commands = self.commands.within(float(time[0]) - COMMAND_MARGIN_S, end + COMMAND_MARGIN_S)
        before = commands.before + float(time[0] - self.time[0])
        after = commands.after + self.end - end
        return replace(
            self,
            commands=replace(commands, before=before, after=after),
            end=end,
            measured=self.measured and self.measured.part(at),
            **arrays,
        )

    def segments(self) -> list[tuple[int, int]]:
        """Stretches [first, last) of usable samples, in order."""
        return find_stretches(self.usable)

    def write(self, path: Path) -> None:
        """Write to `.npz`."""
        names = ("time", "eta", "nu", "nu_dot", "state_nu", "usable")
        arrays = {name: getattr(self, name) for name in names}
        arrays |= {"binned": np.array(self.binned), "end": np.array(self.end)}
        arrays |= dict(self.measured.by_name()) if self.measured else {}
        write_arrays(path, **labels(self.run, self.site, self.commands), **arrays)

    @staticmethod
    def read(path: Path) -> "Motion":
        """Read what `write` wrote."""
        a = read_arrays(path)
        run, site, commands = unlabelled(a)
        return Motion(
            run,
            site,
            a["time"],
            a["eta"],
            a["nu"],
            a["nu_dot"],
            a["state_nu"],
            a["usable"],
            commands,
            bool(a["binned"]),
            float(a["end"]),
            Measured.from_names(a),
        )
