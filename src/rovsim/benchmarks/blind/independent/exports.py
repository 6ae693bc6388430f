"""The exports of a run: poses as a QTM file, and commands as a CSV file."""

from pathlib import Path
from typing import Any, Mapping, Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.signal import lfilter
from scipy.spatial.transform import Rotation

from rovsim.benchmarks.blind.independent.vehicle import MOCAP_TO_NED, Hidden
from rovsim.core.files import write_text

BODY_NAME = "vehicle"


def write_poses(
    path: Path,
    places: Array,
    attitudes: Rotation,
    camera: Mapping[str, Any],
    hidden: Hidden,
    random: np.random.Generator,
) -> None:
    """Write poses as Qualisys Track Manager exports them, with the errors of the cameras.

    Args:
        path: of the tsv file.
        places: (n, 3) of CO at each frame, m, NED.
        attitudes: n rotations from body (FRD) to world.
        camera: its settings.
        hidden: parameters of the hidden effects.
        random: from which errors are drawn.
    """
    rate, count = float(camera["rate"]), len(places)
    places, attitudes = _sense(places, attitudes, hidden)
    coloured = _draw_lasting(count, 1.0 / (rate * camera["colour_time"]), random)
    shift = camera["position_noise"] * random.normal(size=(count, 3))
    turn = camera["attitude_noise"] * random.normal(size=(count, 3))
    places = places + shift + camera["colour_noise"] * coloured[:, :3]
    turn = turn + camera["colour_attitude"] * coloured[:, 3:]
    attitudes = attitudes * Rotation.from_rotvec(turn)
    places, attitudes = _smooth(places, attitudes, rate, hidden)
    outliers = random.random(count) < camera["outliers_per_minute"] / (60.0 * rate)
    direction = random.normal(size=(count, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    smallest, largest = camera["outlier_size"]
    size = random.uniform(smallest, largest, size=(count, 1))
    places = places + outliers[:, None] * size * direction
    rows = _format(places, attitudes, random)
    for first in np.flatnonzero(random.random(count) < camera["bursts_per_minute"] / (60 * rate)):
        gap = slice(first, first + int(random.integers(1, camera["longest_burst"] + 1)))
        rows[gap] = [*np.zeros(6), -1.0, *np.zeros(9)]
    write_text(path, _header(count, rate) + _table(rows, rate))


def _sense(places: Array, attitudes: Rotation, hidden: Hidden) -> tuple[Array, Rotation]:
    """Apply marker offset, marker misalignment and a tilted world to true poses."""
    offset, turn = hidden.get("marker_offset", {}), hidden.get("marker_misalignment", {})
    tilt = hidden.get("world_tilt", {})
    level = Rotation.from_rotvec([tilt.get("roll", 0.0), tilt.get("pitch", 0.0), 0.0])
    markers = attitudes.apply([offset.get(k, 0.0) for k in "xyz"])
    inner = Rotation.from_rotvec([turn.get(k, 0.0) for k in ("roll", "pitch", "yaw")])
    return level.apply(places + markers), level * attitudes * inner


def _smooth(
    places: Array, attitudes: Rotation, rate: float, hidden: Hidden
) -> tuple[Array, Rotation]:
    """Apply the pose filter: two equal first-order low-passes, attitudes along the geodesic."""
    if "pose_filter" not in hidden:
        return places, attitudes
    pole = float(np.exp(-2.0 * np.pi * hidden["pose_filter"]["cutoff"] / rate))
    for _ in range(2):
        first = places[:1]
        places = first + lfilter([1.0 - pole], [1.0, -pole], places - first, axis=0)
        smoothed = [attitudes[0]]
        for attitude in attitudes[1:]:
            lag = (smoothed[-1].inv() * attitude).as_rotvec()
            smoothed.append(smoothed[-1] * Rotation.from_rotvec((1.0 - pole) * lag))
        attitudes = Rotation.concatenate(smoothed)
    return places, attitudes


def _draw_lasting(count: int, step: float, random: np.random.Generator) -> Array:
    """Draw six stationary Ornstein-Uhlenbeck errors (count, 6) of unit variance.

    Args:
        count: samples.
        step: between samples, in time constants.
        random: from which they are drawn.
    """
    pole = np.exp(-step)
    innovations = np.sqrt(1.0 - pole**2) * random.normal(size=(count, 6))
    innovations[0] /= np.sqrt(1.0 - pole**2)
    return lfilter([1.0], [1.0, -pole], innovations, axis=0)


def _format(places: Array, attitudes: Rotation, random: np.random.Generator) -> Array:
    """Return the numbers (n, 16) of a QTM file, in its axes: z up, body axes forward, left, up.

    These are position in mm, roll, pitch and yaw in degrees, the residual, and the rotation matrix
    column by column.
    """
    flip = np.diag(MOCAP_TO_NED)
    R = flip @ attitudes.as_matrix() @ flip
    yaw_pitch_roll = Rotation.from_matrix(R).as_euler("ZYX", degrees=True)
    columns = np.swapaxes(R, 1, 2).reshape(-1, 9)
    residual = random.uniform(0.2, 0.7, size=(len(places), 1))
    return np.hstack([1000.0 * places * MOCAP_TO_NED, yaw_pitch_roll[:, ::-1], residual, columns])


def _header(frames: int, rate: float) -> str:
    fields = {
        "NO_OF_FRAMES": frames,
        "NO_OF_CAMERAS": 8,
        "NO_OF_BODIES": 1,
        "FREQUENCY": f"{rate:g}",
        "DESCRIPTION": "--",
        "DATA_INCLUDED": "6D",
        "BODY_NAMES": BODY_NAME,
    }
    names = ["Y", "Z", "Roll", "Pitch", "Yaw", "Residual", *(f"Rot[{k}]" for k in range(9))]
    lines = [f"{key}\t{value}" for key, value in fields.items()]
    return "\n".join([*lines, "\t".join(["Frame", "Time", f"{BODY_NAME} X", *names])]) + "\n"


def _table(rows: Array, rate: float) -> str:
    lines = (
        "\t".join(
            [
                str(k + 1),
                f"{k / rate:.5f}",
                *(f"{x:.4f}" for x in row[:7]),
                *(f"{x:.6f}" for x in row[7:]),
            ]
        )
        for k, row in enumerate(rows)
    )
    return "\n".join(lines) + "\n"


def write_commands(
    path: Path,
    stamps: Sequence[float],
    commands: Sequence[Array],
    log: Mapping[str, Any],
    random: np.random.Generator,
) -> None:
    """Write commands as pulse widths in whole microseconds, without the lines that get lost."""
    times = np.array(stamps) + log["jitter"] * random.normal(size=len(stamps))
    logged = random.random(len(times)) >= log["missing"]
    logged[0] = True
    lines = ["time_s," + ",".join(f"t{k + 1}" for k in range(len(commands[0])))]
    for time, command, is_logged in zip(times, commands, logged, strict=True):
        if is_logged:
            widths = np.rint(1500.0 + 400.0 * command).astype(int)
            lines.append(f"{time:.4f}," + ",".join(map(str, widths)))
    write_text(path, "\n".join(lines) + "\n")
