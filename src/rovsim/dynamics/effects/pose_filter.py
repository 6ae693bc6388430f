"""Motion capture software that smooths what it reports."""

from math import pi

from numpy import ndarray as Array

from rovsim.dynamics.effects.base import CommandTiming, MeasurementFilter, Parameter, Signature

MAX_HZ = 1e3  # Hz, ten times what cameras see: no filter at all
MAX_LATENCY = 0.2  # s, two frames of the slowest cameras


class PoseFilter(MeasurementFilter, CommandTiming):
    """The software of the motion capture smooths the poses it reports, and so reports them late.

    Position and attitude pass two equal first-order low-passes; a cutoff of 1000 Hz means none.
    Poses may come later than by these alone, by a `latency`: one frame where the software works
    between frames, or hands on the one before. Commands then seem late by as much.
    """

    id = "pose_filter"
    requires = "nothing"
    equation = (
        r"y_k = a\,y_{k-1} + (1 - a)\,x_k \text{ twice},\quad a = e^{-2 \pi f_c\,\Delta t},"
        r"\quad u(t - \delta_y)"
    )
    symbols = (
        ("y_k", "pose that is reported in frame k"),
        ("y_{k-1}", "pose before"),
        ("x_k", "pose without the filter"),
        ("a", "share of the pose before"),
        (r"\Delta t", "time between two frames"),
    )
    neglects = (
        "that it begins anew after frames in which the body was not found, and filters that look "
        "ahead"
    )
    source = "definition (exponential smoothing at the rate of the poses)"
    cause = "A smoothing or a low latency filter is switched on in the software or in its driver."
    revealed_by = (
        "Turn the vehicle by hand to and fro, faster and faster, with a gyroscope on board: the "
        "reported turns grow smaller and later than the measured ones. An input delay only shows "
        "under thrust."
    )
    signature = Signature({"cutoff": 2.0}, "surge", "change of surge thrust")
    parameters = (
        Parameter("cutoff", "Hz", "f_c", 0.1, MAX_HZ, default=MAX_HZ, scale=1.0, reciprocal=True),
        Parameter("latency", "s", r"\delta_y", -MAX_LATENCY, MAX_LATENCY, scale=0.01, fitted=False),
    )
    starts = ({"cutoff": 10.0}, {"cutoff": 4.0})

    def time_constants(self) -> tuple[float, ...]:
        """Time constants of the two low-passes, s; empty where there is no filter."""
        cutoff = self["cutoff"]
        return () if cutoff >= MAX_HZ else 2 * (1.0 / (2.0 * pi * cutoff),)

    def effective_time(self, time: Array) -> Array:
        """Delay by the latency: the poses' clock is late by it, so commands seem to act later."""
        return time + self["latency"]
