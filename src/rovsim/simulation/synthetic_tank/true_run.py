"""Simulate one run in the tank: pilot, thrusters, vehicle and turbulence in closed loop.

A replay integrates with Runge-Kutta 4 at 10 ms. Here it is Heun's method at 1 ms, so that the truth
does not come from the integrator that will be compared with it.
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

TICKS_PER_DRAW = 500  # of turbulence
FIXED_POINT_ITERATIONS = 5  # exact to a nanosecond: a clock's rate is within some per cent of 1


@dataclass(frozen=True, eq=False)
class TrueRun:
    """The true motion and commands of a run.

    Attributes:
        steps: indices (n,), rising, of the integration steps after which states were kept.
        state: states (n, 13) after these steps: pose in NED, body velocity in FRD.
        commands: as the pilot sent them.
        step: length of an integration step, s.
        total: number of integration steps of the run.
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
        """States (m, 13) after some of the kept `steps`: their indices (m,)."""
        return np.asarray(self.state[np.searchsorted(self.steps, steps)])


Choose = Callable[[int, float], Array]


def every_step(total: int, step: float) -> Array:
    """Choose to keep the state after each of `total` steps."""
    return np.arange(total + 1)


@dataclass(frozen=True, eq=False)
class Flight:
    """Who commands a flight: a pilot; or nobody, after a release; or a log.

    Attributes:
        control: 3dof or 6dof: the axes that a pilot moves.
        release: initial state of a vehicle that is let go.
        sent: commands that are sent in place of a pilot's.
    """

    control: str
    release: Release | None = None
    sent: SentLog | None = None


def fly_run(
    model: Model,
    settings: TankSettings,
    flight: Flight,
    random: np.random.Generator,
    choose: Choose = every_step,
) -> TrueRun:
    """Fly one run.

    Args:
        model: the true vehicle, hidden effects included.
        settings: of the campaign.
        flight: who commands it.
        random: generator of this run.
        choose: gets the number of steps and their length in s, and returns the indices (n,),
            rising, of those after which states are kept. It is called after all other draws from
            `random`, and may use it.

    Raises:
        LeftTank: the vehicle reached a wall, because the hidden effects overpower the pilot.
    """
    h, tick = 1.0 / settings.steps_per_second, 1.0 / settings.log.rate
    duration = flight.sent.seconds if flight.sent else settings.duration
    ticks, per_tick = round(duration / tick), round(tick / h)
    total = ticks * per_tick
    vehicle = _TrueVehicle(model, settings, tick, h, duration)
    # Drawn for every flight: what is drawn later does not depend on who commands.
    pilot = vehicle.pilot(flight.control, settings.tank.ned, ticks, tick, random)
    turbulence = draw_turbulence(settings.turbulence, total, h, random, TICKS_PER_DRAW * per_tick)
    currents = draw_currents(model, ticks, tick, random)
    state = _begin(flight, vehicle, pilot, random)
    steps = choose(total, h)
    record = _Kept(steps, state)
    for k in range(ticks):
        if k % TICKS_PER_DRAW == 0:
            accelerations = np.ascontiguousarray(next(turbulence) @ model.constants.M_inv[0].T)
        rows = slice(k % TICKS_PER_DRAW * per_tick, (k % TICKS_PER_DRAW + 1) * per_tick)
        vehicle.set_current(currents[k])
        command = _command(flight, vehicle, pilot, k, state)
        path = vehicle.advance(k, command, state, accelerations[rows])
        record.take(path)
        state = path[-1]
        _stay_inside(state, vehicle.room, (k + 1) * tick)
    commands = Commands(vehicle.times, vehicle.commands, vehicle.kind)
    return TrueRun(steps, record.state, commands, h, total)


def _begin(
    flight: Flight, vehicle: "_TrueVehicle", pilot: Pilot, random: np.random.Generator
) -> Array:
    """Draw the initial state (13,) of a flight."""
    sent, tank = flight.sent, vehicle.site.tank
    state = (sent.start(tank, random) if sent else pilot.choose_start(random)) * vehicle.free
    if vehicle.model.vehicle.floats:
        state[2] = vehicle.site.level
    return _let_go(state, flight.release) * vehicle.free if flight.release else state


def _command(flight: Flight, vehicle: "_TrueVehicle", pilot: Pilot, k: int, state: Array) -> Array:
    """The command (c,) of tick k, as it is logged."""
    if flight.sent:
        return flight.sent.at(k * vehicle.tick)
    return vehicle.log(np.zeros(6) if flight.release else pilot.steer(k, state))


class _Kept:
    """Collects the states (n, 13) after chosen steps (n,) while a run is simulated.

    Args:
        steps: indices of the chosen steps, rising.
        begin: initial state (13,).
    """

    def __init__(self, steps: Array, begin: Array) -> None:
        self.steps, self.state = steps, np.empty((len(steps), 13))
        self.passed, self.taken = -1, 0
        self.take(begin[None])

    def take(self, states: Array) -> None:
        """Keep the chosen ones of the next m states (m, 13), one for each step."""
        first, self.passed = self.passed + 1, self.passed + len(states)
        stop = int(np.searchsorted(self.steps, self.passed, side="right"))
        rows = slice(self.taken, stop)
        self.state[rows] = states[self.steps[rows] - first]
        self.taken = stop


def _let_go(rest: Array, release: Release) -> Array:
    """Displace a state (13,) at rest as a release says."""
    pose = np.array(release.pose)
    position = rest[:3] + rotate(rest[3:7], pose[:3])
    attitude = multiply(rest[3:7], from_euler(*pose[3:]))
    return np.concatenate([position, attitude, release.velocity])


class _TrueVehicle:
    """The true vehicle, simulated from one command to the next.

    It keeps the log of commands and the states of thrusters and fluid memory.

    Args:
        model: the true model.
        settings: of the campaign.
        tick: time between two commands, s.
        h: length of an integration step, s.
        duration: of the run, s.
    """

    def __init__(
        self, model: Model, settings: TankSettings, tick: float, h: float, duration: float
    ) -> None:
        self.model, self.duration, self.tick, self.h = model, duration, tick, h
        tank = settings.tank.ned
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
        above = [[0.0, 0.0], [0.0, 0.0], [np.inf, 0.0]]  # the middle of what floats is at 0
        self.room = tank - above if model.vehicle.floats else tank

    def set_current(self, current: Array) -> None:
        """Add a current (3,) in NED, m/s, to the one of the model, from now on."""
        if current.any():
            water = Current(north=current[0], east=current[1], down=current[2])
            self.batch = Batch([self.model + water], self.site)

    def log(self, demand: Array) -> Array:
        """Command that is logged for a demand (6,): itself, or the allocated actuator commands."""
        command = demand if self.kind == "demand" else self.allocation.command(demand)
        return round_as_logged(command, self.kind, self.model.vehicle)

    def _stamp(self, t: float) -> float:
        """Time stamp that the log gives to a command given at true time t, s.

        No command acts before it is given. Where the model's clocks say that it would, the log's
        clock is ahead, and the stamp is moved until the command takes effect at t.
        """
        stamp, effective = t, self.model.thrust_path.effective_time
        if not self.model.thrust_path.timings:
            return t
        for _ in range(FIXED_POINT_ITERATIONS):
            stamp += max(0.0, t - float(effective(np.array([stamp]))[0]))
        return stamp

    def advance(self, k: int, command: Array, state: Array, accelerations: Array) -> Array:
        """Take the command of tick k, and simulate up to the next tick.

        Args:
            k: number of the tick.
            command: (c,) as it is logged.
            state: at this tick (13,).
            accelerations: acceleration (n, 6) by turbulence in each of n steps, m/s2 and rad/s2.

        Returns:
            The states (n, 13) after each step.
        """
        self.times[k], self.commands[k] = self._stamp(k * self.tick), command
        path, t = self.model.thrust_path, k * self.tick
        middle = t + self.h * (0.5 + np.arange(len(accelerations)))
        arrival = path.effective_time(self.times[self.begin : k + 1])
        line = latest(arrival, middle)
        lines = self.commands[self.begin + line]
        self.begin += int(line[0])
        static = path.at(Commands(middle, lines, self.kind), 0.0, self.duration)
        force, self.lag = path.respond(static.force, self.h, self.lag)
        drive = Drive.by(self.model, replace(static, force=force), self.duration)
        return self.batch.advance_by_heun(drive, accelerations, state, self.memory, t, self.h)


class LeftTank(BadInput):
    """The vehicle reached a wall, the floor or the surface."""


def _stay_inside(state: Array, tank: Array, t: float) -> None:
    """Refuse a state (13,) outside the tank (3, 2), or one that is not finite, at t s."""
    if np.all((state[:3] > tank[:, 0]) & (state[:3] < tank[:, 1])):
        return
    if not np.isfinite(state).all():
        raise BadInput(
            f"the state is no number after {t:.1f} s: a force was none, or grew without bound",
            where="the simulated vehicle",
            expected="effects that give finite forces at every state",
            remedy="Look for a division by zero in effects of your own, or make others weaker.",
        )
    raise LeftTank(
        f"the vehicle left the tank after {t:.1f} s",
        where="tank",
        expected="a run that stays between walls, floor and surface",
        remedy="Hide weaker effects, or make the tank larger.",
    )
