"""What happens between a command that has arrived and a thruster's force."""

from functools import cache
from typing import ClassVar

import numpy as np
import scipy
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.core.pwm import PULSE_SPAN_US
from rovsim.dynamics.body import Body
from rovsim.dynamics.effects.base import (
    STAMP_STEP,
    Actuated,
    Coefficients,
    CommandTransform,
    Effect,
    Parameter,
    Signature,
    ThrusterDynamics,
    ThrustScaling,
)

USUAL_COUNT = 8  # thrusters of the effect in the catalogue: those of a BlueROV2 Heavy


def name_gains(count: int) -> tuple[str, ...]:
    """Names of the gains of so many thrusters, t1 to tn, in the vehicle file's order."""
    return tuple(f"t{i}" for i in range(1, count + 1))


def _gains(count: int) -> tuple[Parameter, ...]:
    """Parameters: a gain for each of so many thrusters, and the common one, `all`."""
    names = (*name_gains(count), "all")
    return tuple(Parameter(name, "1", f"g_{{{name}}}", default=1.0, scale=0.1) for name in names)


# ESCs stop at 0.06 (25 us); five times that is more than anybody would fly with.
DEADBANDS = tuple(round(0.01 * k, 2) for k in range(1, 31))


class ThrusterDeadband(CommandTransform):
    """A thruster that does not start below a small command; above it the curve is unchanged."""

    id = "thruster_deadband"
    equation = r"F = 0 \text{ for } |c| \le w"
    symbols = (("c", "command, from −1 to 1"),)
    neglects = "hysteresis between starting and stopping"
    source = "definition"
    cause = "The speed controllers do not turn the propellers at small commands."
    revealed_by = (
        "Ramp one axis slowly through zero and back, up to a tenth of full thrust: inside a dead "
        "band nothing happens at all, a low gain answers weakly from the very start."
    )
    signature = Signature({"width": 0.15}, "surge", "surge thrust")
    # two steps of a log in whole microseconds: between them no command changes sides
    parameters = (
        Parameter(
            "width",
            "1",
            "w",
            low=0.0,
            high=1.0,
            scale=0.03,
            resolution=2 / PULSE_SPAN_US,
            tried=DEADBANDS,
        ),
    )
    starts = ({"width": 0.03}, {"width": 0.07})

    def thruster_command(self, command: Array) -> Array:
        """Set commands inside the band to zero."""
        return np.where(np.abs(command) <= self["width"], 0.0, command)


class ThrusterGain(ThrustScaling):
    """Thrusters stronger or weaker than the published curve; negative means reversed wiring.

    A parameter for each thruster of the vehicle, and one for all.
    """

    steady = True
    id = "thruster_gain"
    differs_between_runs = True
    equation = r"F_i \to g\,g_i\,F_i"
    symbols = (
        ("g", "gain of all"),
        ("g_i", "gain of thruster i"),
    )
    neglects = "a change of the curve's shape"
    source = "definition"
    cause = (
        "A propeller is fouled, damaged or of another kind, the battery has another voltage, or a "
        "thruster is wired the wrong way round."
    )
    revealed_by = (
        "Push with one axis, better one thruster, at a time for 3 s and then coast: a gain shows "
        "only under thrust, drag while coasting as well, and added mass only while the speed "
        "changes."
    )
    signature = Signature({"all": 0.7}, "surge", "surge thrust")
    parameters = _gains(USUAL_COUNT)
    called: ClassVar[tuple[str, ...]] = ()  # names of the thrusters in the vehicle file

    def __init__(self, **values: float) -> None:
        gains = dict(zip(self.called, name_gains(len(self.called)), strict=True))
        for name in set(values) & set(gains) - {p.name for p in self.parameters}:
            raise BadInput(
                f"'{name}' is no parameter, but the name of a thruster",
                where=f"effect {self.id}",
                expected=f"one of {', '.join(gains.values())}, all",
                remedy=f"Write {gains[name]}: gains count the thrusters of the vehicle file.",
            )
        super().__init__(**values)

    @classmethod
    def on(cls, vehicle: Actuated) -> type[Effect]:
        """With a gain for each thruster of the vehicle."""
        names = vehicle.thruster_names
        return cls if names == name_gains(USUAL_COUNT) else _gain_of(names)

    def scaled_force(self, force: Array, t: Array, duration: float) -> Array:
        """Multiply forces by each thruster's gain and the common one."""
        gains, values = np.ones(force.shape[1]), self.values[:-1][: force.shape[1]]
        gains[: len(values)] = values
        return force * (self["all"] * gains)


@cache
def _gain_of(names: tuple[str, ...]) -> type[ThrusterGain]:
    """The effect with a gain for each thruster of a vehicle, by their names in its file."""
    return ThrusterGain.adapted(parameters=_gains(len(names)), called=names)


class ThrustAsymmetry(ThrustScaling):
    """Propellers push less backwards than forwards."""

    steady = True
    id = "thrust_asymmetry"
    rank = 1
    equation = r"F \to a F \text{ where } F < 0"
    neglects = "a ratio that depends on speed"
    source = "definition"
    cause = "The blades are shaped for one direction, or the frame stands in the backward jet."
    revealed_by = (
        "Hold equal thrust forwards and backwards on each axis until the speed is steady: only an "
        "asymmetry makes the two speeds differ at every heading, a current does so at one."
    )
    signature = Signature({"ratio": 0.7}, "heave", "heave thrust")
    parameters = (Parameter("ratio", "1", "a", low=0.0, default=1.0, scale=0.1),)

    def scaled_force(self, force: Array, t: Array, duration: float) -> Array:
        """Multiply negative forces by the ratio."""
        return np.where(force < 0.0, self["ratio"] * force, force)


class VoltageSag(ThrustScaling):
    """The battery empties: thrust fades over the run.

    `fraction` is lost by the end of a run, however long it is; `rate` in every second. Fitted to
    runs of T seconds, a fraction is the rate fraction / T, which holds for runs of any length.
    """

    id = "voltage_sag"
    differs_between_runs = True
    rank = 2
    equation = r"F \to F\,\max(0,\ 1 - s\,t/T_\text{run} - r\,t)"
    symbols = ((r"T_\text{run}", "length of the run"),)
    neglects = "recovery at rest and sag under load"
    source = "definition"
    cause = "The battery empties during the run, and nothing corrects the commands for it."
    revealed_by = (
        "Repeat one manoeuvre at the start, in the middle and at the end of a run, and coast each "
        "time: sag weakens the thrust more and more, a gain is off from the start, and neither "
        "shows while coasting."
    )
    signature = Signature({"fraction": 0.4}, "sway", "time in the run", size=True)
    parameters = (
        Parameter("fraction", "1", "s", high=1.0, scale=0.1),
        # a tenth in a minute; in runs of one length it cannot be told from the fraction
        Parameter("rate", "1/s", "r", scale=0.1 / 60.0, fitted=False),
    )

    def needs_duration(self) -> bool:
        """Whether there is a fraction: it is lost over the duration of a run."""
        return self["fraction"] != 0.0

    def scaled_force(self, force: Array, t: Array, duration: float) -> Array:
        """Reduce the forces linearly with time."""
        loss = self["fraction"] * t / duration + self["rate"] * t
        return force * np.maximum(0.0, 1.0 - loss)[:, None]


class ThrusterLag(ThrusterDynamics):
    """Propellers take time to spin up: first order on the force."""

    id = "thruster_lag"
    equation = r"T \dot F + F = F_\text{static}"
    symbols = (
        (r"\dot F", "rate of change of F"),
        (r"F_\text{static}", "force that the curve gives for the command"),
    )
    neglects = "that spinning up and down differ"
    source = "Fossen 2021, sec. 9.4 (first-order actuator)"
    cause = "The propellers take time to spin up, or their controllers smooth the command."
    revealed_by = (
        "Step one axis at a time between thrust levels and hold 3 s: a lag delays the whole "
        "response by its time constant at any step size, added mass only slows the rise."
    )
    signature = Signature({"time_constant": 0.2}, "surge", "change of surge thrust")
    parameters = (Parameter("time_constant", "s", "T", low=0.0, scale=0.1, resolution=STAMP_STEP),)
    starts = ({"time_constant": 0.05}, {"time_constant": 0.2})

    def respond(self, force: Array, h: float, state: Array | None) -> tuple[Array, Array]:
        """Mean over each step of the exact response to forces that are constant over each step."""
        T = self["time_constant"]
        start = force[0] if state is None else state
        if T == 0.0:
            return force, force[-1]
        decay = np.exp(-h / T)
        ends, _ = scipy.signal.lfilter(
            [1.0 - decay], [1.0, -decay], force, axis=0, zi=decay * start[None]
        )
        begins = np.vstack([start[None], ends[:-1]])
        return force + (begins - force) * (T / h) * (1.0 - decay), ends[-1]


class AdvanceLoss(Coefficients):
    """A propeller that advances through the water pushes less; opposing inflow raises thrust."""

    id = "advance_loss"
    requires = "thrusters"
    equation = r"F \to F\,(1 - c\,\mathrm{sign}(F)\,d_i \cdot v_r)"
    symbols = (
        ("d_i", "direction of thruster i"),
        ("v_r", "velocity of CO through the water"),
    )
    neglects = (
        "the velocity of the thruster relative to CO, and of one that turns that its two "
        "components lose together"
    )
    source = "Fossen 2021, sec. 9.4 (linear in the advance speed)"
    cause = (
        "A propeller that moves along its own jet finds the water moving already; the published "
        "curve was measured at rest."
    )
    revealed_by = (
        "At full speed go on thrusting, then coast, then thrust backwards: the loss changes sign "
        "with the thrust and ends with it, drag of the hull does neither."
    )
    signature = Signature({"coefficient": 0.6}, "surge", "surge speed")
    parameters = (Parameter("coefficient", "s/m", "c", scale=0.2),)

    def enter(self, body: Body) -> None:
        """Add to the relative loss of thrust per inflow velocity, s/m."""
        body.advance += self["coefficient"]


class PropellerTorque(Coefficients):
    """The reaction moment of each propeller about its axis."""

    id = "propeller_torque"
    requires = "thrusters"
    equation = r"\tau_\text{rotation} \to \tau_\text{rotation} + q\,s_i F_i d_i"
    symbols = (
        (r"\tau_\text{rotation}", "moment on the vehicle"),
        ("s_i", "sense of rotation of propeller i"),
        ("d_i", "direction of thruster i"),
    )
    neglects = "the torque of spinning up"
    source = "Fossen 2021, sec. 9.4 (torque proportional to thrust)"
    cause = (
        "Each propeller turns the vehicle the other way, and a wrong pairing of left- and "
        "right-handed propellers leaves a rest."
    )
    revealed_by = (
        "Thrust one axis at a time from rest, 1 s at several levels: the torque of propellers is "
        "there at once and grows with the thrust, coupled damping needs speed first."
    )
    signature = Signature({"ratio": 0.03}, "roll", "yaw thrust")
    parameters = (Parameter("ratio", "m", "q", scale=0.01),)

    def enter(self, body: Body) -> None:
        """Add each propeller's moment to its column of the allocation."""
        body.B[3:] += self["ratio"] * (body.spin[:, None] * body.directions).T
