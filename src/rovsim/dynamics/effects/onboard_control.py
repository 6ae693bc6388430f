"""A control loop on board that the log does not show."""

from math import atan2, sqrt
from typing import Mapping

import numpy as np
from numpy import ndarray as Array

from rovsim.core.axes import AXES
from rovsim.core.errors import BadInput
from rovsim.core.run import CommandKind, Site
from rovsim.dynamics.compilation.compiled import inlined
from rovsim.dynamics.effects.base import Autopilot, Parameter, Signature, Wrench

SPEED_UNITS = ("m/s", "rad/s")
# Where a fit of loops on all axes begins: gains, the speed of this vehicle at full stick (Blue
# Robotics: 1.5 m/s forward), m/s and rad/s; and bandwidths, 1/s.
FULL_STICK_SPEED, INITIAL_BANDWIDTH = (1.0, 1.0, 1.0, 3.0, 3.0, 3.0), (1.0, 1.0, 1.0, 3.0, 3.0, 3.0)
ALL_LOOPS_START = {f"gain_{axis}": g for axis, g in zip(AXES, FULL_STICK_SPEED, strict=True)} | {
    f"bandwidth_{axis}": b for axis, b in zip(AXES, INITIAL_BANDWIDTH, strict=True)
}
ROTATION_AXES = ("roll", "pitch", "yaw")
TILT_AXES = np.array([0.0, 0.0, 0.0, 1.0, 1.0, 0.0])  # axes whose angle a loop may hold


@inlined
def held(inertia, bandwidth, nu, angle):
    """Force or moment by which a loop counteracts a velocity nu, and an angle if it holds one."""
    return -inertia * bandwidth * (nu + bandwidth * angle)


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
    symbols = (("M_{ii}", "inertia along axis i, with added mass"),)
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
            Parameter(
                f"gain_{axis}", SPEED_UNITS[i // 3], f"g_{{{axis}}}", scale=(0.3, 0.5)[i // 3]
            )
            for i, axis in enumerate(AXES)
        ),
        *(
            Parameter(f"bandwidth_{axis}", "1/s", f"b_{{{axis}}}", low=0.0, scale=1.0)
            for axis in AXES
        ),
        Parameter("attitude", "1", "a", low=0.0, high=1.0, scale=1.0, fitted=False, discrete=True),
    )
    starts = (
        {"gain_yaw": 1.0, "bandwidth_yaw": 2.0},
        *(
            {
                f"{name}_{axis}": x
                for axis in ROTATION_AXES
                for name, x in (("gain", g), ("bandwidth", b))
            }
            | extra
            for g, b, extra in ((1.0, 2.0, {}), (0.5, 3.0, {"attitude": 1.0}))
        ),
        {"gain_heave": 0.5, "bandwidth_heave": 1.0},
        ALL_LOOPS_START,
    )

    @classmethod
    def free_at(cls, start: Mapping[str, float]) -> tuple[str, ...]:
        """Parameters of the start alone: another loop would take its demand from the mixer."""
        return tuple(name for name in super().free_at(start) if name in start)

    def check(self, site: Site, kind: CommandKind) -> None:
        """Refuse a run whose log holds no demands."""
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

    def mixer_demand(self, demand: Array) -> Array:
        """The demands, with 0 for axes that have a loop."""
        return np.where(self._closed, 0.0, demand)

    def demanded_wrench(self, demand: Array, inertia: Array) -> Array:
        """Wrench (m, 6) by which the loops follow their set-points: M_ii b_i g_i demand_i.

        For roll and pitch in attitude mode, the demanded angle g_i demand_i times b_i is a rate.
        """
        gain, bandwidth = self.values[:6], self.values[6:12]
        by_angle = 1.0 + self["attitude"] * TILT_AXES * (bandwidth - 1.0)
        return np.where(self._closed, inertia * bandwidth * by_angle * gain * demand, 0.0)

    @staticmethod
    def wrench(at, p):
        """The feedback of the loops: damping, and stiffness in attitude mode."""
        M, nu = at.inertia, at.nu
        x, y, z = at.R[2]  # the world's down in body axes
        roll, pitch = p.attitude * atan2(y, z), p.attitude * atan2(-x, sqrt(y * y + z * z))
        return (
            held(M[0], p.bandwidth_surge, nu[0], 0.0),
            held(M[1], p.bandwidth_sway, nu[1], 0.0),
            held(M[2], p.bandwidth_heave, nu[2], 0.0),
            held(M[3], p.bandwidth_roll, nu[3], roll),
            held(M[4], p.bandwidth_pitch, nu[4], pitch),
            held(M[5], p.bandwidth_yaw, nu[5], 0.0),
        )
