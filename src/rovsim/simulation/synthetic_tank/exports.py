"""Write a true run as raw exports: poses as Qualisys does, and the log of commands."""

from typing import TextIO

import numpy as np
from numpy import ndarray as Array

from rovsim.core import gauss_markov
from rovsim.core.axes import AXES
from rovsim.core.pwm import to_pulses
from rovsim.core.rotations import HALF_TURN_X, exp, matrix, multiply, to_euler
from rovsim.dynamics.mocap_view import MocapView
from rovsim.dynamics.vehicle import Vehicle
from rovsim.simulation.synthetic_tank.description import BODY_NAME
from rovsim.simulation.synthetic_tank.settings import Camera, Log
from rovsim.simulation.synthetic_tank.true_run import TrueRun

COLUMNS = (
    "X Y Z Roll Pitch Yaw Residual Rot[0] Rot[1] Rot[2] Rot[3] Rot[4] Rot[5] Rot[6] Rot[7] Rot[8]"
)


def choose_frames(camera: Camera, total: int, step: float) -> Array:
    """Indices (n,) of the integration steps after which the cameras take a frame.

    Args:
        camera: its rate.
        total: number of integration steps of the run.
        step: their length, s.
    """
    return np.arange(0, total, round(1.0 / (camera.rate * step)))


def export_poses(
    truth: TrueRun, camera: Camera, view: MocapView, random: np.random.Generator, file: TextIO
) -> None:
    """Write the poses as a Qualisys 6DOF export: z-up world, FLU body, mm and degrees.

    Args:
        truth: the run, with one state for each frame.
        camera: its noise and failures.
        view: what the motion capture reports of a motion.
        random: generator of its errors.
        file: what is written to.
    """
    frames = len(truth.state)
    position, attitude = _measure(truth.state[:, :7], camera, view, random)
    rows = _format_rows(position, attitude, random)
    rows[_lose_frames(frames, camera, random)] = [0.0] * 6 + [-1.0] + [0.0] * 9
    file.write(_header(frames, camera.rate))
    table = np.column_stack([np.arange(1, frames + 1), truth.time, rows])
    shape = ["%d", "%.5f", *["%.3f"] * 7, *["%.6f"] * 9]
    np.savetxt(file, table, fmt="\t".join(shape))


def _measure(
    eta: Array, camera: Camera, view: MocapView, random: np.random.Generator
) -> tuple[Array, Array]:
    """Add all errors of the motion capture to true poses (n, 7), NED and FRD.

    The low-pass of the motion capture smooths motion and noise; outliers are added after it.

    Returns:
        Positions (n, 3), m, and quaternions (n, 4), in the motion capture's axes: z-up and FLU.
    """
    n, flip, eta = len(eta), np.concatenate([[1.0], HALF_TURN_X]), view.poses(eta)
    rotation, shift = _draw_colour(n, camera, random)
    rotation += camera.attitude_noise * random.normal(size=(n, 3))
    shift += camera.position_noise * random.normal(size=(n, 3))
    attitude, position = multiply(eta[:, 3:7], exp(rotation)), eta[:, :3] + shift
    reported = view.smooth(np.hstack([position, attitude]), 1.0 / camera.rate)
    position, attitude = reported[:, :3], reported[:, 3:]
    for k in np.flatnonzero(random.random(n) < camera.outliers_per_minute / (60 * camera.rate)):
        direction = random.normal(size=3)
        size = random.uniform(*camera.outlier_size)
        position[k] += size * direction / np.linalg.norm(direction)
    # R_raw = S R S with S = diag(1, -1, -1): the quaternion's y and z change sign
    return position * HALF_TURN_X, attitude * flip


def _draw_colour(n: int, camera: Camera, random: np.random.Generator) -> tuple[Array, Array]:
    """Draw Gauss-Markov errors of n frames: rotations (n, 3) rad and shifts (n, 3) m."""
    (rng,) = random.spawn(1)  # a generator of its own: all other draws stay as they are without it
    coloured = gauss_markov.draw(n, 1.0 / (camera.rate * camera.colour_time), rng)
    return camera.colour_attitude * coloured[:, 3:], camera.colour_noise * coloured[:, :3]


def _format_rows(position: Array, attitude: Array, random: np.random.Generator) -> Array:
    """Format poses as rows (n, 16): mm, degrees, marker residual, rotation matrix by columns."""
    angles = np.degrees(to_euler(attitude))
    columns = np.swapaxes(matrix(attitude), -1, -2).reshape(-1, 9)
    residual = random.uniform(0.2, 0.7, size=(len(position), 1))
    return np.hstack([1000.0 * position, angles, residual, columns])


def _lose_frames(frames: int, camera: Camera, random: np.random.Generator) -> Array:
    """Draw the frames (n,) in which the body is not found: bursts of random length."""
    hidden = np.zeros(frames, dtype=bool)
    starts = np.flatnonzero(random.random(frames) < camera.bursts_per_minute / (60 * camera.rate))
    for start in starts:
        hidden[start : start + random.integers(1, camera.longest_burst + 1)] = True
    return hidden


def _header(frames: int, rate: float) -> str:
    """Header of a Qualisys 6DOF export; `rate` in Hz."""
    lines = {
        "NO_OF_FRAMES": frames,
        "NO_OF_CAMERAS": 12,
        "NO_OF_BODIES": 1,
        "FREQUENCY": f"{rate:g}",
        "NO_OF_ANALOG": 0,
        "ANALOG_FREQUENCY": 0,
        "DESCRIPTION": "--",
        "TIME_STAMP": "2026-01-01, 12:00:00.000\t0.0",
        "DATA_INCLUDED": "6D",
        "BODY_NAMES": BODY_NAME,
    }
    names = COLUMNS.split()
    column_line = "\t".join(["Frame", "Time", f"{BODY_NAME} {names[0]}", *names[1:]])
    return "".join(f"{key}\t{value}\n" for key, value in lines.items()) + column_line + "\n"


def export_commands(
    truth: TrueRun, log: Log, vehicle: Vehicle, random: np.random.Generator, file: TextIO
) -> None:
    """Write the command log: thruster PWM in us and angles in rad, or demands per axis.

    There is one line for each command of the pilot; some are lost, and time stamps jitter.
    """
    commands = truth.commands
    time = commands.time + log.jitter * random.normal(size=len(commands.time))
    kept = random.random(len(time)) >= log.missing
    kept[0] = True
    value, names = commands.value, list(AXES)
    formats = ["%.4f"] * value.shape[1]
    if commands.kind == "thruster":
        value = np.where(vehicle.angles, value, to_pulses(value))
        names = list(vehicle.command_columns)
        formats = ["%.4f" if angle else "%d" for angle in vehicle.angles]
    file.write(",".join(["time_s", *names]) + "\n")
    table = np.column_stack([time, value])[kept]
    np.savetxt(file, table, fmt=",".join(["%.4f", *formats]))
