"""Try a user's effect on a vehicle before it is used in a simulation.

For each kind of effect, trials call its methods with examples of their arguments and check what
they return.
"""

import sys
import traceback
from dataclasses import fields
from functools import partial
from typing import Any, Callable, Iterator, NamedTuple, Protocol

import numpy as np
from numpy import ndarray as Array

from rovsim.core.rotations import Rigid
from rovsim.dynamics.body import Body
from rovsim.dynamics.effects.base import (
    Actuated,
    Autopilot,
    Coefficients,
    CommandTiming,
    CommandTransform,
    DemandTransform,
    Effect,
    FrameMisalignment,
    MeasurementFilter,
    StochasticCurrent,
    ThrustCurveShape,
    ThrusterDynamics,
    ThrustScaling,
    Wrench,
)
from rovsim.dynamics.user_effects.declarations import refused
from rovsim.dynamics.user_effects.kernel_trials import Actuating, largest_wrench

SAMPLES = 5  # number of samples that methods are tried with
TIME = np.arange(SAMPLES) / 10.0  # s
DURATION_SECONDS = 60.0  # s of a recording
WRENCH_TOLERANCE = 1e-9  # N, N m: rounding of two equal forces of opposite sign
FULL_THRUST = ((-40.0,), (50.0,))  # N of a thruster at full command backwards and forwards
SAME_BODY_EXPECTED = "constants of the body as they are: finite numbers of the same shape"
# Constants of a body to which an effect may add rows.
EXTENDABLE_CONSTANTS = ("products", "factors")


class Tried(Actuated, Protocol):
    """What trials need to know of a vehicle, in addition to what effects do."""

    @property
    def command_columns(self) -> tuple[str, ...]:
        """Names of the columns of a log of thruster commands."""

    def effects(self) -> tuple[Effect, ...]:
        """Its nominal effects."""


class Trial(NamedTuple):
    """A call of a method, what is expected of its result in words, and a check of that."""

    method: str
    call: Callable[[], Any]
    expected: str
    fits: Callable[[Any], bool]


def try_on(cls: type[Effect], vehicle: Tried) -> None:
    """Call the methods of an effect on this vehicle, at its defaults and where its fits begin.

    Raises:
        BadInput: a method fails, or returns something else than expected.
    """
    where = _place_of(cls)
    for start in ({}, *cls.starts):
        effect = cls(**start)
        for trial in _list_trials(effect, vehicle):
            try:
                result = trial.call()
                fits = trial.fits(result)
            except Exception as error:  # whatever a user's code raises
                fault = f"'{trial.method}' fails with {type(error).__name__}: {error}"
                raise refused(fault, where + _line_of(error, cls), trial.expected) from None
            if not fits:
                raise refused(
                    f"'{trial.method}' returns {_describe_result(result)}", where, trial.expected
                )


def _place_of(cls: type[Effect]) -> str:
    """The file and the id of an effect, for messages."""
    file = getattr(sys.modules.get(cls.__module__), "__file__", None)
    return f"{file}, effect {cls.id}" if file else f"effect {cls.id}"


def _line_of(error: Exception, cls: type[Effect]) -> str:
    """The line of the effect's own module in which it failed, for messages."""
    frames = traceback.walk_tb(error.__traceback__)
    lines = [line for frame, line in frames if frame.f_globals.get("__name__") == cls.__module__]
    return f", line {lines[-1]}" if lines else ""


def _list_trials(effect: Effect, vehicle: Tried) -> Iterator[Trial]:
    """Yield the trials of all kinds of effect that this effect belongs to."""
    for kind, trials in TRIALS.items():
        if isinstance(effect, kind):
            yield from trials(effect, vehicle)


def _try_coefficients(e: Coefficients, vehicle: Tried) -> Iterator[Trial]:
    body = Body(gravity=9.81)
    for effect in vehicle.effects():
        if isinstance(effect, Coefficients):
            effect.enter(body)
    shapes = _shapes(body)

    def enter() -> Any:
        e.enter(body)
        wrong = [name for name, shape in _shapes(body).items() if shape != shapes[name]]
        return ", ".join(f"body.{name}" for name in wrong) or "a body as it was"

    yield Trial("enter", enter, SAME_BODY_EXPECTED, lambda result: result == "a body as it was")
    yield Trial(
        "enter",
        lambda: body.least_inertia,
        "a body whose inertia is positive (this is its smallest eigenvalue)",
        lambda eigenvalue: eigenvalue > 0.0,
    )


def _shapes(body: Body) -> dict[str, tuple[int, ...] | None]:
    """Shape of each constant but `EXTENDABLE_CONSTANTS`, by name; None if not finite."""
    constants = {f.name: getattr(body, f.name) for f in fields(body)}
    fixed = {name: value for name, value in constants.items() if name not in EXTENDABLE_CONSTANTS}
    return {name: np.shape(v) if _is_finite(v) else None for name, v in fixed.items()}


def _is_finite(value: Any) -> bool:
    try:
        return bool(np.isfinite(np.asarray(value, float)).all())
    except (TypeError, ValueError):
        return False


def _try_current(e: StochasticCurrent, vehicle: Tried) -> Iterator[Trial]:
    yield _array("draw", partial(e.draw, SAMPLES, 0.1, np.random.default_rng(0)), (SAMPLES, 3))


def _try_timing(e: CommandTiming, vehicle: Tried) -> Iterator[Trial]:
    yield Trial(
        "effective_time",
        partial(e.effective_time, _given(TIME.copy())),
        f"{SAMPLES} increasing instants for as many",
        lambda result: _is_array(result, TIME.shape) and bool((np.diff(result) > 0.0).all()),
    )


def _try_demands(e: DemandTransform | Autopilot, vehicle: Tried) -> Iterator[Trial]:
    yield _array("mixer_demand", partial(e.mixer_demand, _moving(6)), (SAMPLES, 6))


def _try_autopilot(e: Autopilot, vehicle: Tried) -> Iterator[Trial]:
    yield from _try_demands(e, vehicle)
    yield _array(
        "demanded_wrench", partial(e.demanded_wrench, _moving(6), np.ones(6)), (SAMPLES, 6)
    )


def _try_command(e: CommandTransform, vehicle: Tried) -> Iterator[Trial]:
    command = _moving(vehicle.thruster_count)
    yield _array("thruster_command", partial(e.thruster_command, command), command.shape)


def _try_curve(e: ThrustCurveShape, vehicle: Tried) -> Iterator[Trial]:
    force, full = _forces(vehicle), _given(np.tile(FULL_THRUST, vehicle.thruster_count))
    yield _array("reshaped_force", partial(e.reshaped_force, force, full), force.shape)


def _try_scaling(e: ThrustScaling, vehicle: Tried) -> Iterator[Trial]:
    force = _forces(vehicle)
    yield _array(
        "scaled_force", partial(e.scaled_force, force, TIME, DURATION_SECONDS), force.shape
    )


def _try_dynamics(e: ThrusterDynamics, vehicle: Tried) -> Iterator[Trial]:
    force = _forces(vehicle)

    def respond_twice() -> Any:
        _, state = e.respond(force, 0.01, None)
        return e.respond(force, 0.01, state)[0]

    yield _array("respond", respond_twice, force.shape, "forces and a state to go on from; forces")


def _try_frames(e: FrameMisalignment, vehicle: Tried) -> Iterator[Trial]:
    def fits(made: Any) -> bool:
        return (
            isinstance(made, tuple)
            and len(made) == 2
            and all(
                isinstance(r, Rigid) and _is_array(r.rotation, (4,)) and _is_array(r[1], (3,))
                for r in made
            )
        )

    yield Trial("transforms", e.transforms, "two Rigid, each a quaternion and a translation", fits)


def _try_filter(e: MeasurementFilter, vehicle: Tried) -> Iterator[Trial]:
    def fits(made: Any) -> bool:
        return isinstance(made, tuple) and all(T > 0.0 and np.isfinite(T) for T in made)

    expected = "a tuple of seconds above 0, and an empty one where nothing is smoothed"
    yield Trial("time_constants", e.time_constants, expected, fits)


def _try_wrench(e: Wrench, vehicle: Tried) -> Iterator[Trial]:
    actuating = Actuating(
        vehicle.thruster_count, len(vehicle.command_columns), len(vehicle.surface_names)
    )
    call = partial(largest_wrench, e, actuating)
    yield Trial("wrench", call, actuating.description, lambda _: True)
    if not e.given():
        yield Trial("wrench", call, "0 with its default values: then nothing acts", _is_none)


def _is_none(wrench: float) -> bool:
    """Whether the largest wrench is zero or NaN; a simulation reports a wrench that is NaN."""
    return not wrench > WRENCH_TOLERANCE


def _array(
    method: str, call: Callable[[], Any], shape: tuple[int, ...], expected: str = "a new array"
) -> Trial:
    return Trial(method, call, f"{expected} {shape}", lambda result: _is_array(result, shape))


def _is_array(made: Any, shape: tuple[int, ...]) -> bool:
    """Whether something is an array of finite numbers with this shape."""
    return np.shape(made) == shape and bool(np.isfinite(np.asarray(made, float)).all())


def _describe_result(made: Any) -> str:
    """Describe what a method returned, for messages."""
    if isinstance(made, np.ndarray):
        return f"an array {made.shape}" + ("" if np.isfinite(made).all() else " with NaN or inf")
    return repr(made)


def _moving(columns: int) -> Array:
    """Demands or commands (SAMPLES, columns) from -1 to 1."""
    return _given(np.tile(np.linspace(-1.0, 1.0, SAMPLES)[:, None], columns))


def _forces(vehicle: Tried) -> Array:
    """Examples of forces (SAMPLES, n), N, of the vehicle's thrusters."""
    return _given(FULL_THRUST[1][0] * _moving(vehicle.thruster_count))


def _given(values: Array) -> Array:
    """The values, read-only: in a simulation, a method gets the log itself."""
    values.setflags(write=False)
    return values


TRIALS: dict[type[Effect], Callable[[Any, Tried], Iterator[Trial]]] = {
    Coefficients: _try_coefficients,
    Wrench: _try_wrench,
    StochasticCurrent: _try_current,
    CommandTiming: _try_timing,
    DemandTransform: _try_demands,
    Autopilot: _try_autopilot,
    CommandTransform: _try_command,
    ThrustCurveShape: _try_curve,
    ThrustScaling: _try_scaling,
    ThrusterDynamics: _try_dynamics,
    FrameMisalignment: _try_frames,
    MeasurementFilter: _try_filter,
}
