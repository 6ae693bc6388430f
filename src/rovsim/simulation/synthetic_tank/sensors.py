"""Readings of a true run by sensors on board or ashore, each at its own rate, without cameras."""

from dataclasses import dataclass
from typing import Mapping, Sequence, TextIO

import numpy as np
from numpy import ndarray as Array

from rovsim.core.rotations import exp, multiply, rotate, to_euler, unrotate
from rovsim.simulation.synthetic_tank.settings import Sensor, SensorKind
from rovsim.simulation.synthetic_tank.true_run import TrueRun

CHANNEL_COLUMNS: Mapping[SensorKind, Sequence[str]] = {
    "position": ("x_m", "y_m", "z_m"),
    "attitude": ("roll_rad", "pitch_rad", "yaw_rad"),
    "depth": ("depth_m",),
    "velocity": ("u_m_s", "v_m_s", "w_m_s"),
    "rates": ("p_rad_s", "q_rad_s", "r_rad_s"),
    "specific_force": ("ax_m_s2", "ay_m_s2", "az_m_s2"),
}


@dataclass(frozen=True, eq=False)
class Reading:
    """When a sensor measures in a run, and the noise of its m readings.

    Attributes:
        kind: what the sensor measures.
        sensor: its settings.
        steps: indices (m,) of the integration steps after which it measures.
        noise: white noise (m, c) of each component, in its unit.
    """

    kind: SensorKind
    sensor: Sensor
    steps: Array
    noise: Array


def draw_readings(
    sensors: Mapping[SensorKind, Sensor], total: int, step: float, random: np.random.Generator
) -> list[Reading]:
    """Draw the times and the noise of all readings in a run of `total` steps of `step` s."""
    readings = []
    for kind, sensor in sensors.items():
        steps = _draw_steps(sensor, total, step, random)
        shape = (len(steps), len(CHANNEL_COLUMNS[kind]))
        readings.append(Reading(kind, sensor, steps, sensor.noise * random.normal(size=shape)))
    return readings


def _draw_steps(sensor: Sensor, total: int, step: float, random: np.random.Generator) -> Array:
    """Draw the steps (m,) after which a sensor measures, at a random phase of its period."""
    stride = 1.0 / (sensor.rate * step)
    steps = np.round(np.arange(random.uniform(0.0, stride), total, stride))
    return np.unique(steps.astype(int))


def needed_steps(readings: Sequence[Reading], total: int) -> Array:
    """Indices (n,), rising, of the steps whose states the readings need.

    Neighbouring steps are included, because an acceleration is computed from three states.
    """
    indices = [reading.steps + k for reading in readings for k in (-1, 0, 1)]
    return np.unique(np.clip(np.concatenate(indices), 0, total))


def export_channels(
    truth: TrueRun, readings: Sequence[Reading], surface: float, gravity: float, file: TextIO
) -> None:
    """Write a csv in NED and FRD, with one line for each reading of each sensor.

    Args:
        truth: the run, with the states of `needed_steps`.
        readings: of every sensor.
        surface: coordinate z of the surface, m NED.
        gravity: m/s2.
        file: what is written to.
    """
    names = [name for reading in readings for name in CHANNEL_COLUMNS[reading.kind]]
    columns = [names.index(CHANNEL_COLUMNS[reading.kind][0]) for reading in readings]
    values = [_measure(reading, truth, surface, gravity) for reading in readings]
    time = [reading.steps * truth.step + reading.sensor.delay for reading in readings]
    sensors = np.repeat(np.arange(len(readings)), [len(times) for times in time])
    row = np.concatenate([np.arange(len(times)) for times in time])
    file.write(",".join(["time_s", *names]) + "\n")
    for k in np.lexsort([sensors, np.concatenate(time)]):
        sensor, line = sensors[k], row[k]
        cells = [f"{x:.6f}" for x in values[sensor][line]]
        blanks = len(names) - columns[sensor] - len(cells)
        filled = [*[""] * columns[sensor], *cells, *[""] * blanks]
        file.write(",".join([f"{time[sensor][line]:.4f}", *filled]) + "\n")


def _measure(reading: Reading, truth: TrueRun, surface: float, gravity: float) -> Array:
    """Values (m, c) that a sensor reports, with its noise, in NED or FRD and SI units."""
    state, position = truth.at(reading.steps), np.array(reading.sensor.at)
    q, nu = state[:, 3:7], state[:, 7:]
    if reading.kind == "attitude":
        return to_euler(multiply(q, exp(reading.noise)))
    value = {
        "position": lambda: state[:, :3],
        "depth": lambda: state[:, 2:3] + rotate(q, position)[:, 2:] - surface,
        "velocity": lambda: nu[:, :3] + np.cross(nu[:, 3:], position),
        "rates": lambda: nu[:, 3:],
        "specific_force": lambda: _specific_force(truth, reading.steps, position, gravity),
    }[reading.kind]()
    return np.asarray(value + reading.noise)


def _specific_force(truth: TrueRun, steps: Array, place: Array, gravity: float) -> Array:
    """Specific force (m, 3) at a place in the body: acceleration minus gravity, m/s2, FRD axes.

    Args:
        truth: the run, with the states of these steps and their neighbours.
        steps: (m,) after which it is measured.
        place: (3,) from CO in FRD, m.
        gravity: m/s2.
    """
    state = truth.at(steps)
    earlier, later = np.maximum(steps - 1, 0), np.minimum(steps + 1, truth.total)
    seconds = (later - earlier)[:, None] * truth.step
    nu, nu_dot = state[:, 7:], (truth.at(later) - truth.at(earlier))[:, 7:] / seconds
    spin, down = nu[:, 3:], np.array([0.0, 0.0, gravity])
    linear = nu_dot[:, :3] + np.cross(spin, nu[:, :3])
    rotational = np.cross(nu_dot[:, 3:], place) + np.cross(spin, np.cross(spin, place))
    return np.asarray(linear + rotational - unrotate(state[:, 3:7], down))
