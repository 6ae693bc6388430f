"""Labels of parameters for readers, with the names that a vehicle file gives its thrusters."""

from typing import Iterable, Sequence

from rovsim.dynamics.effects.thrusters import ThrusterGain, name_gains


def label_parameter(effect: str, parameter: str, thrusters: Sequence[str]) -> str:
    """Name of a parameter for readers: `bow (t3)` for the gain t3 if the third thruster is `bow`.

    In model files and results the gains are t1 to tn, in the order of the vehicle file.

    Args:
        effect: id of the effect.
        parameter: name of its parameter.
        thrusters: names of the thrusters in the vehicle file.
    """
    gains = name_gains(len(thrusters))
    if effect != ThrusterGain.id or parameter not in gains:
        return parameter
    name = thrusters[gains.index(parameter)]
    return parameter if name == parameter else f"{name} ({parameter})"


def label_parameters(parameters: Iterable[str], thrusters: Sequence[str]) -> list[str]:
    """Apply `label_parameter` to parameters with names of the form `effect.parameter`."""
    parts = (parameter.partition(".") for parameter in parameters)
    return [f"{effect}.{label_parameter(effect, name, thrusters)}" for effect, _, name in parts]
