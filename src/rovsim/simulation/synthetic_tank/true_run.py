"""One run in the tank: pilot, thrusters, vehicle and turbulence, in closed loop.

The replay's integrator is Runge-Kutta 4 at 10 ms; this is Heun's method at 1 ms, so that the truth
is not made by what will be compared with it.
"""

from dataclasses import dataclass, replace
from typing import Callable

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.core.rotations import HALF_TURN_X, from_euler, multiply, rotate
from rovsim.core.run import CommandKind, Commands, Site, latest
from rovsim.dynamics.effects.current import Current
from rovsim.dynamics.model import Model
from rovsim.simulation.batch import Batch
from rovsim.simulation.command_columns import round_as_logged
from rovsim.simulation.drive import Drive
from rovsim.simulation.synthetic_tank.allocation import Allocation
from rovsim.simulation.synthetic_tank.pilot import Helmsman, Pilot
from rovsim.simulation.synthetic_tank.sent_log import SentLog
from rovsim.simulation.synthetic_tank.settings import Release, TankSettings
from rovsim.simulation.synthetic_tank.turbulence import draw_currents, draw_turbulence

PUSHED = 500  # ticks for which pushes are drawn at once
FIXED_POINT = 5  # a clock's rate is within some per cent of 1, so this is exact to a nanosecond


@dataclass(frozen=True, eq=False)
class TrueRun:
    """What happened: states (n, 13) in NED after so many `steps` (n,), rising, of `step` s each.

    `state` holds the steps that were asked for alone; `commands` are as the pilot sent them, and
    `total` is how many steps the run has.
    """

    steps: Array
    state: Array
    commands: Commands
    step: float
    total: int

    @property
    def time(self) -> Array:
        """Times (n,) s of the states."""
        return self.steps * self.step

    def at(self, steps: Array) -> Array:
        """States (m, 13) after these steps (m,), which were asked for."""
        return np.asarray(self.state[np.searchsorted(self.steps, steps)])


Choose = Callable[[int, float], Array]


def every_step(total: int, step: float) -> Array:
    """Choose the state after each step."""
    return np.arange(total + 1)


def fly_run(
    model: Model,
    settings: TankSettings,
    control: str,
    tank: Array,
    random: np.random.Generator,
    release: Release | None = None,
    sent: SentLog | None = None,
    choose: Choose = every_step,
) -> TrueRun:
    """Fly one run.

    Args:
        model: the true vehicle, hidden effects included.
        settings: the campaign.
        control: 3dof or 6dof.
        tank: walls (3, 2) in NED, m.
        random: generator of this run.
        release: how it is let go, in place of a pilot.
        sent: commands that are sent in place of a pilot's.
        choose: told how many steps there are and their length, s, says after which of them (n,),
            rising, states are kept; called once all is drawn from `random` that the flight needs.

    Raises:
        LeftTank: the hidden effects are stronger than the pilot.
    """
    h, tick = 1.0 / settings.steps_per_second, 1.0 / settings.log.rate
    duration = sent.seconds if sent else settings.duration
    ticks, per_tick = round(duration / tick), round(tick / h)
    total = ticks * per_tick
    vehicle = _TrueVehicle(model, tank, settings, tick, h, duration)
    pilot = vehicle.pilot(control, tank, ticks, tick, random)
    turbulence = draw_turbulence(settings.turbulence, total, h, random, PUSHED * per_tick)
    currents = draw_currents(model, ticks, tick, random)
    state = (sent.start(tank, random) if sent else pilot.choose_start(random)) * vehicle.free
    if model.vehicle.floats:
        state[2] = vehicle.site.level
        tank = tank - [[0.0, 0.0], [0.0, 0.0], [np.inf, 0.0]]  # its middle is at the surface
    if release is not None:
        state = _let_go(state, release) * vehicle.free
    steps = choose(total, h)
    kept = _Kept(steps, state)
    for k in range(ticks):
        if k % PUSHED == 0:
            pushes = np.ascontiguousarray(next(turbulence) @ model.constants.M_inv[0].T)
        if sent:
            command = sent.at(k * tick)
        else:
            command = vehicle.log(np.zeros(6) if release else pilot.steer(k, state))
        rows = slice(k % PUSHED * per_tick, (k % PUSHED + 1) * per_tick)
        vehicle.set_current(currents[k])
        passed = vehicle.advance(k, command, state, pushes[rows])
        kept.take(passed)
        state = passed[-1]
        _stay_inside(state, tank, (k + 1) * tick)
    commands = Commands(vehicle.times, vehicle.commands, vehicle.kind)
    return TrueRun(steps, kept.state, commands, h, total)


class _Kept:
    """States (n, 13) after those steps (n,) that are asked for, as they pass."""

    def __init__(self, steps: Array, begin: Array) -> None:
        self.steps, self.state = steps, np.empty((len(steps), 13))
        self.passed, self.taken = -1, 0
        self.take(begin[None])

    def take(self, states: Array) -> None:
        """The next states (m, 13), one a step."""
        first, self.passed = self.passed + 1, self.passed + len(states)
        stop = int(np.searchsorted(self.steps, self.passed, side="right"))
        rows = slice(self.taken, stop)
        self.state[rows] = states[self.steps[rows] - first]
        self.taken = stop


def _let_go(rest: Array, release: Release) -> Array:
    """State (13,) as far from this one as a release says."""
    pose = np.array(release.pose)
    place = rest[:3] + rotate(rest[3:7], pose[:3])
    attitude = multiply(rest[3:7], from_euler(*pose[3:]))
    return np.concatenate([place, attitude, release.velocity])


class _TrueVehicle:
    """The true vehicle, tick by tick; remembers the commands and the thrusters' state."""

    def __init__(
        self,
        model: Model,
        tank: Array,
        settings: TankSettings,
        tick: float,
        h: float,
        duration: float,
    ) -> None:
        self.model, self.duration, self.tick, self.h = model, duration, tick, h
        site = Site(tank, HALF_TURN_X, float(tank[2, 0]))  # what floats rests at the surface
        self.free = np.concatenate([np.ones(7), model.body.free])
        self.allocation = Allocation(model.vehicle)
        self.pilot = Pilot if self.allocation.sideways else Helmsman
        self.kind: CommandKind = "demand" if settings.log.kind == "demand" else "thruster"
        model.check(site, self.kind)
        columns = model.thrust_path.columns(self.kind)
        ticks = round(duration / tick)
        self.times, self.commands = np.empty(ticks), np.empty((ticks, columns))
        self.begin = 0  # the first line of the log that may still act
        self.lag: list | None = None
        self.memory = np.zeros(6)
        self.site, self.batch = site, Batch([model], site)

    def set_current(self, current: Array) -> None:
        """Let the water move by (3,) m/s in NED on top of what the model knows."""
        if current.any():
            water = Current(north=current[0], east=current[1], down=current[2])
            self.batch = Batch([self.model + water], self.site)

    def log(self, demand: Array) -> Array:
        """What a demand (6,) leaves in the log: itself, or what the thrusters are told."""
        told = demand if self.kind == "demand" else self.allocation.command(demand)
        return round_as_logged(told, self.kind, self.model.vehicle)

    def _stamp(self, t: float) -> float:
        """Time at which the log puts a command that is given at t.

        No command acts before it is given: where the clocks say so, the log's clock is ahead.
        """
        stamp, effective = t, self.model.thrust_path.effective_time
        if not self.model.thrust_path.timings:
            return t
        for _ in range(FIXED_POINT):
            stamp += max(0.0, t - float(effective(np.array([stamp]))[0]))
        return stamp

    def advance(self, k: int, command: Array, state: Array, pushes: Array) -> Array:
        """Take the command of tick k; the states (steps, 13) up to the next tick."""
        self.times[k], self.commands[k] = self._stamp(k * self.tick), command
        path, t = self.model.thrust_path, k * self.tick
        middle = t + self.h * (0.5 + np.arange(len(pushes)))
        arrival = path.effective_time(self.times[self.begin : k + 1])
        acting = latest(arrival, middle)
        held = self.commands[self.begin + acting]
        self.begin += int(acting[0])
        static = path.at(Commands(middle, held, self.kind), 0.0, self.duration)
        force, self.lag = path.respond(static.force, self.h, self.lag)
        drive = Drive.by(self.model, replace(static, force=force), self.duration)
        return self.batch.advance_by_heun(drive, pushes, state, self.memory, t, self.h)


class LeftTank(BadInput):
    """The vehicle reached a wall, the floor or the surface."""


def _stay_inside(state: Array, tank: Array, t: float) -> None:
    if np.all((state[:3] > tank[:, 0]) & (state[:3] < tank[:, 1])):
        return
    if not np.isfinite(state).all():
        raise BadInput(
            f"the state is no number after {t:.1f} s: a force was none, or grew without bound",
            where="tank",
            expected="effects that give finite forces at every state",
            remedy="Look for a division by zero in effects of your own, or hide weaker ones.",
        )
    raise LeftTank(
        f"the vehicle left the tank after {t:.1f} s",
        where="tank",
        expected="a run that stays between walls, floor and surface",
        remedy="Hide weaker effects, or make the tank larger.",
    )
