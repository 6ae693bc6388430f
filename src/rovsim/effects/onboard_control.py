"""A control loop on board that the log does not show."""

from math import atan2, sqrt
from typing import Mapping

import numpy as np
from numpy import ndarray as Array

from rovsim import AXES
from rovsim.effects.base import Autopilot, Parameter, Wrench
from rovsim.effects.parameters import Signature
from rovsim.engine.vectors import inlined
from rovsim.errors import BadInput
from rovsim.recording.recording import CommandKind, Site

SPEEDS = ("m/s", "rad/s")
ROTATION = ("roll", "pitch", "yaw")


@inlined
def loop(inertia, bandwidth, rate, nu):
    """What a loop of that bandwidth does about a rate; without bandwidth there is no loop."""
    return inertia * bandwidth * (rate - nu) if bandwidth != 0.0 else 0.0


@inlined
def asked(demand, gain, bandwidth, angle, attitude):
    """Rate that is asked for: by a rate set-point (attitude 0) or an angle set-point (1)."""
    return (1.0 - attitude) * gain * demand + attitude * bandwidth * (gain * demand - angle)


class OnboardControl(Wrench, Autopilot):
    """The autopilot takes a demand as the set-point of a speed, a rate or an angle.

    Only axes with a bandwidth have such a loop; their demands do not reach the mixer. `attitude` 1
    makes the demands of roll and pitch angles: their gain is then in rad.
    """

    id = "onboard_control"
    equation = (
        r"\tau_i = M_{ii}\,b_i\,(g_i\,\text{demand}_i - \nu_i)"
        r"\text{ in place of the mixer; attitude mode: }"
        r"M_{ii}\,b_i\,(b_i\,(g_i\,\text{demand}_i - \text{angle}_i) - \nu_i)"
    )
    neglects = "saturation and lag of the thrusters that do it, and the loop's integral term"
    source = "a first-order loop, as in cascaded autopilots (Fossen 2021, ch. 15)"
    cause = (
        "The autopilot was in a stabilised mode: the log holds set-points, not demands on the "
        "thrusters."
    )
    revealed_by = (
        "Hold one stick still at three positions for 5 s each, then release it and push the "
        "vehicle by hand: a loop reaches a speed or angle in proportion and resists the hand, "
        "mere damping gives way; best, log the thruster outputs."
    )
    signature = Signature({"gain_yaw": 1.0, "bandwidth_yaw": 2.0}, "yaw", "yaw thrust")
    parameters = (
        *(
            Parameter(f"gain_{axis}", SPEEDS[i // 3], f"g_{{{axis}}}", scale=(0.3, 0.5)[i // 3])
            for i, axis in enumerate(AXES)
        ),
        *(
            Parameter(f"bandwidth_{axis}", "1/s", f"b_{{{axis}}}", low=0.0, scale=1.0)
            for axis in AXES
        ),
        Parameter("attitude", "1", "a", low=0.0, high=1.0, scale=1.0, fitted=False),
    )
    starts = (
        {"gain_yaw": 1.0, "bandwidth_yaw": 2.0},
        *(
            {
                f"{name}_{axis}": x
                for axis in ROTATION
                for name, x in (("gain", g), ("bandwidth", b))
            }
            | extra
            for g, b, extra in ((1.0, 2.0, {}), (0.5, 3.0, {"attitude": 1.0}))
        ),
        {"gain_heave": 0.5, "bandwidth_heave": 1.0},
    )

    @classmethod
    def free_at(cls, start: Mapping[str, float]) -> tuple[str, ...]:
        """Only the loops that are closed: a further one would take its demand from the mixer."""
        return tuple(name for name in super().free_at(start) if name in start)

    def check(self, site: Site, kind: CommandKind) -> None:
        """The log must hold demands."""
        if kind != "demand" and self._closed.any():
            raise BadInput(
                "onboard_control acts on demands, and this log holds none",
                where="model",
                expected="commands of the kind 'demand' in campaign.yaml",
                remedy="Log what the pilot asks for, or leave that effect out.",
            )

    @property
    def _closed(self) -> Array:
        return self.values[6:12] > 0.0

    def mixed(self, demand: Array) -> Array:
        """Demands of axes without a loop."""
        return np.where(self._closed, 0.0, demand)

    @staticmethod
    def wrench(at, p):
        """What the loops do."""
        M, nu, u, a = at.inertia, at.nu, at.demand, p.attitude
        x, y, z = at.R[2]  # the world's down in body axes
        roll = asked(u[3], p.gain_roll, p.bandwidth_roll, atan2(y, z), a)
        lean = atan2(-x, sqrt(y * y + z * z))
        pitch = asked(u[4], p.gain_pitch, p.bandwidth_pitch, lean, a)
        return (
            loop(M[0], p.bandwidth_surge, p.gain_surge * u[0], nu[0]),
            loop(M[1], p.bandwidth_sway, p.gain_sway * u[1], nu[1]),
            loop(M[2], p.bandwidth_heave, p.gain_heave * u[2], nu[2]),
            loop(M[3], p.bandwidth_roll, roll, nu[3]),
            loop(M[4], p.bandwidth_pitch, pitch, nu[4]),
            loop(M[5], p.bandwidth_yaw, p.gain_yaw * u[5], nu[5]),
        )
