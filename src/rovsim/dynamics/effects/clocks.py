"""When a logged command takes effect."""

from numpy import ndarray as Array

from rovsim.dynamics.effects.base import STAMP_STEP, CommandTiming, Parameter, Signature


class InputDelay(CommandTiming):
    """Commands take effect late: transport delay, or a constant offset between two clocks."""

    id = "input_delay"
    differs_between_runs = True
    rank = 1
    equation = r"u(t - \delta)"
    neglects = "jitter"
    source = "definition"
    cause = (
        "Commands travel late (radio, network, autopilot), or the clocks of log and motion "
        "capture were set apart."
    )
    revealed_by = (
        "Step one axis from rest, several times in a run: a delay shifts the sharp beginning of "
        "the response, a lag rounds it, and with a drifting clock the shift grows during the run."
    )
    signature = Signature({"delay": 0.2}, "sway", "change of sway thrust")
    parameters = (Parameter("delay", "s", r"\delta", scale=0.05, resolution=STAMP_STEP),)
    # several starts: from no delay, derivatives do not lead to a step of a command 0.1 s later
    starts = ({}, {"delay": 0.1}, {"delay": 0.3}, {"delay": -0.1})

    def effective_time(self, time: Array) -> Array:
        """Delay every command by the same time."""
        return time + self["delay"]


class ClockDrift(CommandTiming):
    """The computer that logged the commands has a clock that runs fast."""

    id = "clock_drift"
    differs_between_runs = True
    equation = r"t_\text{command} = (1 + r)\,t"
    symbols = ((r"t_\text{command}", "time on the clock of the command log"),)
    neglects = "a rate that changes with temperature"
    source = "definition"
    cause = "Commands and motion are stamped by two computers whose clocks run at different rates."
    revealed_by = (
        "Make the same sharp step at the beginning, in the middle and at the end of a run of 5 "
        "min: drift shifts the response more and more, a delay always by the same time."
    )
    signature = Signature({"rate": 0.005}, "surge", "time in the run", size=True)
    parameters = (  # one stamp in a minute
        Parameter("rate", "1", "r", low=-0.5, high=0.5, scale=0.002, resolution=STAMP_STEP / 60.0),
    )
    # 0.2 s and 0.6 s after a minute; see InputDelay
    starts = ({}, {"rate": 0.003}, {"rate": -0.003}, {"rate": 0.01}, {"rate": -0.01})

    def effective_time(self, time: Array) -> Array:
        """Instant on the MoCap clock at which the command clock shows `time`."""
        return time / (1.0 + self["rate"])
