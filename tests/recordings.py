"""Hand-written exports for tests: a short swim, written in any format and any axes."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import yaml
from numpy import ndarray as Array

import bags
import c3ds
import logs
from rovsim.core.rotations import axes_signs, from_euler, from_matrix, matrix, to_euler

TEXT = {"qtm_tsv": "poses.tsv", "csv": "poses.csv", "motive_csv": "take.csv"}
FORMATS = {**TEXT, "rosbag2": "poses", "ardupilot": "log.BIN", "c3d": "take.c3d"}
LOGS = {"csv": "commands.csv", "rosbag2": "outputs", "ardupilot": "log.BIN"}  # of commands
AXES = {"ardupilot": ("ned", "frd")}  # of formats that have no others
CLOCKS = {"rosbag2": bags.START}  # s, where a recording does not start at zero


@dataclass(frozen=True, eq=False)
class Swim:
    """Poses in the axes of a file: time (n,), position (n, 3) m, rotation (n, 3, 3)."""

    time: Array
    position: Array
    rotation: Array

    @staticmethod
    def ned(frames: int = 400, rate: float = 100.0) -> "Swim":
        """A smooth swim in NED and FRD that turns about every axis."""
        t = np.arange(frames) / rate
        position = np.stack([1 + 0.5 * np.sin(t), 2 + 0.4 * np.cos(t), 1 + 0.2 * np.sin(2 * t)], 1)
        q = from_euler(0.3 * np.sin(2 * t), 0.2 * np.cos(t), t - 1.0)
        return Swim(t, position, matrix(q))

    def along(self, world_axes: str, body_axes: str) -> "Swim":
        """The same swim in other axes, by plain matrices."""
        world, body = np.diag(axes_signs(world_axes)), np.diag(axes_signs(body_axes))
        return replace(self, position=self.position @ world, rotation=world @ self.rotation @ body)


def qtm_header(swim: Swim, bodies: list[str]) -> list[str]:
    """Header lines as QTM writes them."""
    return [
        f"NO_OF_FRAMES\t{len(swim.time)}",
        "NO_OF_CAMERAS\t12",
        f"NO_OF_BODIES\t{len(bodies)}",
        "FREQUENCY\t100",
        "DESCRIPTION\t--",
        "TIME_STAMP\t2026-05-12, 10:14:07.250\t81234.55012340",
        "DATA_INCLUDED\t6D",
        "\t".join(["BODY_NAMES", *bodies]),
    ]


def qtm_columns(bodies: list[str]) -> list[str]:
    """Column names of the bodies, without Frame and Time."""
    rest = ["Y", "Z", "Roll", "Pitch", "Yaw", "Residual", *(f"Rot[{k}]" for k in range(9))]
    return [column for body in bodies for column in [f"{body} X", *rest]]


def qtm_cells(position: Array, rotation: Array) -> list[str]:
    """Cells of one body in one frame. The Euler angles are nonsense on purpose."""
    euler = ["111.000", "22.000", "33.000"]
    stored = [f"{r:.6f}" for r in rotation.T.ravel()]  # column by column
    return [*(f"{1e3 * p:.3f}" for p in position), *euler, "0.350", *stored]


def qtm_lines(swim: Swim, body: str = "BlueROV2") -> list[str]:
    """All lines of a one-body export."""
    lines = [*qtm_header(swim, [body]), "\t".join(["Frame", "Time", *qtm_columns([body])])]
    for k, t in enumerate(swim.time):
        cells = [str(k + 1), f"{t:.5f}", *qtm_cells(swim.position[k], swim.rotation[k])]
        lines.append("\t".join(cells))
    return lines


def csv_lines(swim: Swim) -> list[str]:
    """All lines of a csv with Euler angles."""
    angles = to_euler(from_matrix(swim.rotation))
    rows = np.column_stack([swim.time, swim.position, angles])
    names = "time_s,x_m,y_m,z_m,roll_rad,pitch_rad,yaw_rad"
    return [names, *(",".join(f"{x:.7f}" for x in row) for row in rows)]


def motive_lines(swim: Swim, body: str = "BlueROV2") -> list[str]:
    """All lines of a Motive export of quaternions, mm, format version 1.23."""
    what = ["Rotation"] * 4 + ["Position"] * 3 + ["Mean Marker Error"]
    lines = [
        "Format Version,1.23,Take Name,Take 1,Capture Frame Rate,100.000000,Export Frame Rate,"
        f"100.000000,Total Exported Frames,{len(swim.time)},Rotation Type,Quaternion,Length Units,"
        "Millimeters,Coordinate Space,Global",
        "",
        ",".join([",Type", *["Rigid Body"] * 8]),
        ",".join([",Name", *[body] * 8]),
        ",".join([",ID", *["5F"] * 8]),
        ",".join([",Parent", *[""] * 8]),
        ",".join([",", *what]),
        "Frame,Time (Seconds),X,Y,Z,W,X,Y,Z,",
    ]
    q = from_matrix(swim.rotation)
    for k, t in enumerate(swim.time):
        w, x, y, z = q[k]
        cells = [*(f"{c:.6f}" for c in (x, y, z, w)), *(f"{1e3 * p:.6f}" for p in swim.position[k])]
        lines.append(",".join([str(k), f"{t:.6f}", *cells, "0.1"]))
    return lines


def pose_lines(name: str, swim: Swim) -> list[str]:
    """Lines of the swim in the format `name` of text."""
    return {"qtm_tsv": qtm_lines, "csv": csv_lines, "motive_csv": motive_lines}[name](swim)


def write_poses(folder: Path, name: str, swim: Swim) -> Path:
    """The swim in the format `name`; every registered format needs a way here."""
    path = folder / FORMATS[name]
    if name in TEXT:
        return write_lines(path, pose_lines(name, swim))
    write = {"rosbag2": bags.write_swim, "ardupilot": logs.write_dataflash, "c3d": c3ds.write_swim}
    return write[name](path, swim)


def command_lines(seconds: float = 4.0, name: str = "csv") -> list[str]:
    """Two PWM columns at 50 Hz, on the clock of recordings in the format `name`."""
    start = CLOCKS.get(name, 0.0)
    t = np.arange(0.0, seconds, 0.02)
    value = np.round(1500 + 200 * np.sin(3 * t))
    pairs = zip(t, value, strict=True)
    return ["time_s,t1,t2", *(f"{start + a:.4f},{b:.0f},{3000 - b:.0f}" for a, b in pairs)]


def write_commands(folder: Path, name: str) -> Path:
    """Pulses of outputs in the format `name`; every registered format needs a way here."""
    write = {
        "csv": lambda path: write_lines(path, command_lines()),
        "rosbag2": bags.write_outputs,
        "ardupilot": lambda path: logs.write_dataflash(path, Swim.ned()),
    }
    return write[name](folder / LOGS[name])


def write_lines(path: Path, lines: list[str], end: str = "\n") -> Path:
    """Write text lines with that line end."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes("".join(line + end for line in lines).encode())
    return path


def campaign_content(name: str = "qtm_tsv") -> dict:
    """Keys of a one-run campaign with poses in the format `name`."""
    world_axes, body_axes = AXES.get(name, ("z_up", "flu"))
    return {
        "name": "hand-written",
        "vehicle": "bluerov2_heavy",
        "tank": {"x": [0, 10], "y": [0, 5], "z": [0, 3]},
        "mocap": {
            "format": name,
            "body": "/mocap/BlueROV2/pose" if name == "rosbag2" else "BlueROV2",
            "world_axes": world_axes,
            "body_axes": body_axes,
        },
        "commands": {"format": "csv", "kind": "pwm", "columns": ["t1", "t2"]},
        "runs": [
            {
                "id": "one",
                "control": "6dof",
                "split": "train",
                "mocap": FORMATS.get(name, "poses.any"),
                "commands": "commands.csv",
            }
        ],
    }


def write_campaign(folder: Path, content: dict) -> Path:
    """Write `campaign.yaml` and return its folder."""
    folder.mkdir(parents=True, exist_ok=True)
    text = yaml.safe_dump(content, allow_unicode=True)
    (folder / "campaign.yaml").write_text(text, encoding="utf-8")
    return folder


def write_run(folder: Path, name: str = "qtm_tsv", swim: Swim | None = None) -> Path:
    """A whole campaign of one run in that format; returns its folder."""
    content = campaign_content(name)
    axes = content["mocap"]["world_axes"], content["mocap"]["body_axes"]
    swim = (swim or Swim.ned()).along(*axes)
    write_poses(folder, name, swim)
    write_lines(folder / "commands.csv", command_lines(name=name))
    return write_campaign(folder, content)
