"""What sensors on board or ashore report of a true run, each at its own rate, without cameras."""

import io
from typing import Mapping, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.rotations import exp, multiply, rotate, to_euler, unrotate
from rovsim.measurement.signals.clock import time_step
from rovsim.simulation.synthetic_tank.settings import Sensor, SensorKind
from rovsim.simulation.synthetic_tank.true_run import TrueRun

COLUMNS: Mapping[SensorKind, Sequence[str]] = {
    "position": ("x_m", "y_m", "z_m"),
    "attitude": ("roll_rad", "pitch_rad", "yaw_rad"),
    "depth": ("depth_m",),
    "velocity": ("u_m_s", "v_m_s", "w_m_s"),
    "rates": ("p_rad_s", "q_rad_s", "r_rad_s"),
    "specific_force": ("ax_m_s2", "ay_m_s2", "az_m_s2"),
}


def export_channels(
    truth: TrueRun, sensors: Mapping[SensorKind, Sensor], surface: float, gravity: float,
    random: np.random.Generator,
) -> str:  # fmt: skip
    """A csv in NED and FRD: one line for each time at which a sensor measured.

    Args:
        truth: the run.
        sensors: by kind of channel.
        surface: coordinate z of the surface, m NED.
        gravity: m/s2.
        random: generator of this run.
    """
    names = [name for kind in sensors for name in COLUMNS[kind]]
    lines: list[tuple[float, int, list[str]]] = []
    for kind, sensor in sensors.items():
        rows = _choose_rows(truth, sensor, random)
        values = _measure(kind, sensor, truth, rows, surface, gravity, random)
        place = names.index(COLUMNS[kind][0])
        for time, value in zip(truth.time[rows] + sensor.delay, values, strict=True):
            lines.append((float(time), place, [f"{x:.6f}" for x in value]))
    text = io.StringIO()
    text.write(",".join(["time_s", *names]) + "\n")
    for time, place, cells in sorted(lines):
        after = len(names) - place - len(cells)
        text.write(",".join([f"{time:.4f}", *[""] * place, *cells, *[""] * after]) + "\n")
    return text.getvalue()


def _choose_rows(truth: TrueRun, sensor: Sensor, random: np.random.Generator) -> Array:
    """Samples at which it measures, the first anywhere in its first period."""
    stride = 1.0 / (sensor.rate * time_step(truth.time))
    rows = np.round(np.arange(random.uniform(0.0, stride), len(truth.time) - 1, stride))
    return np.unique(rows.astype(int))


def _measure(
    kind: SensorKind, sensor: Sensor, truth: TrueRun, rows: Array, surface: float, gravity: float,
    random: np.random.Generator,
) -> Array:  # fmt: skip
    """What it reports (m, c) at these samples, its white noise on it."""
    state, place = truth.state[rows], np.array(sensor.at)
    q, nu = state[:, 3:7], state[:, 7:]
    if kind == "attitude":
        return to_euler(multiply(q, exp(sensor.noise * random.normal(size=(len(rows), 3)))))
    value = {
        "position": lambda: state[:, :3],
        "depth": lambda: state[:, 2:3] + rotate(q, place)[:, 2:] - surface,
        "velocity": lambda: nu[:, :3] + np.cross(nu[:, 3:], place),
        "rates": lambda: nu[:, 3:],
        "specific_force": lambda: _specific_force(truth, place, gravity)[rows],
    }[kind]()
    return np.asarray(value + sensor.noise * random.normal(size=value.shape))


def _specific_force(truth: TrueRun, place: Array, gravity: float) -> Array:
    """Acceleration less gravity (n, 3) of a place in the body, along FRD."""
    nu, step = truth.state[:, 7:], time_step(truth.time)
    nu_dot = np.gradient(nu, step, axis=0)
    spin, down = nu[:, 3:], np.array([0.0, 0.0, gravity])
    moved = nu_dot[:, :3] + np.cross(spin, nu[:, :3])
    turned = np.cross(nu_dot[:, 3:], place) + np.cross(spin, np.cross(spin, place))
    return np.asarray(moved + turned - unrotate(truth.state[:, 3:7], down))
