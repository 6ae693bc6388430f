"""A run on a clean clock: poses, then velocities and accelerations."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy import ndarray as Array

from rovsim.core.array_files import read_arrays, write_arrays
from rovsim.core.run import Commands, RunInfo, Site
from rovsim.measurement.recording.recording import labels, unlabelled
from rovsim.measurement.signals.clock import find_stretches
from rovsim.measurement.signals.measured import Measured

BESIDE = 10.0  # s of the log kept on either side of a part: longer than any delay of a command


@dataclass(frozen=True, eq=False)
class Poses:
    """Poses on a uniform clock.

    `time` (n,) s; `eta` (n, 7): position NED m and unit quaternion (w, x, y, z), sign-continuous;
    `usable` (n,): False in and beside gaps too long to bridge (`eta` there is a placeholder).
    `measured`: what of it was, None: everything.
    """

    run: RunInfo
    site: Site
    time: Array
    eta: Array
    usable: Array
    commands: Commands
    measured: Measured | None = None

    def part(self, at: slice) -> "Poses":
        """Some samples of it."""
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

    `time` (n,) s; `eta` (n, 7) as in `Poses`; `nu`, `nu_dot` (n, 6) body velocity and acceleration
    at CO in FRD (m/s, rad/s); `usable` (n,).

    Sampled (`binned` False): a uniform clock, everything holds at time[k] and `state_nu` is `nu`.
    Binned: `nu` is the mean over time[k] .. time[k+1] (the last bin ends at `end`), `nu_dot` the
    backward difference (NaN at k = 0), `time` may be uneven; `eta` and `state_nu` (n, 6) are the
    instantaneous pose and velocity at time[k], from which a replay may start.

    `measured`: what of it was, None: everything.
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
        """Instantaneous state (n, 13): position, quaternion, velocity."""
        return self.state_at(slice(None))

    def state_at(self, index: Array | slice) -> Array:
        """The state (k, 13) of some samples or bins."""
        return np.concatenate([self.eta[index], self.state_nu[index]], axis=1)

    def part(self, at: slice) -> "Motion":
        """Some samples or bins of it, which know where in the recording they lie."""
        names = ("time", "eta", "nu", "nu_dot", "state_nu", "usable")
        arrays = {name: getattr(self, name)[at] for name in names}
        time, bins = arrays["time"], self.time[at.stop :]
        end = float(bins[0] if self.binned and len(bins) else self.end if self.binned else time[-1])
        commands = self.commands.within(float(time[0]) - BESIDE, end + BESIDE)
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
