"""Small ROS 2 bags, written by rosbags itself."""

import sqlite3
from pathlib import Path

import numpy as np
from rosbags.interfaces import Nodetype
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from rovsim.core.rotations import from_matrix
from rovsim.measurement.recording.formats.rosbag2.definitions import MAVROS_MESSAGES

START = 1_750_000_000.0  # s, arrival of the first message
POSE, ODOMETRY = "geometry_msgs/msg/PoseStamped", "nav_msgs/msg/Odometry"
OWN = "tank_msgs/msg/Thrust"
STORE = get_typestore(Stores.ROS2_HUMBLE)
for name, text in {
    **MAVROS_MESSAGES,
    OWN: "std_msgs/Header header\nfloat64 port\nfloat64[2] pods\n",
}.items():
    STORE.register(get_types_from_msg(text, name))


def message(kind, stamp=None, **fields):
    """A message of zeros with these fields (`pose__position__x=1.0`) and stamp in s."""
    made = _blank(kind)
    if stamp is not None:
        whole = int(np.floor(stamp))
        fields |= {"header__stamp__sec": whole}
        fields |= {"header__stamp__nanosec": round(1e9 * (stamp - whole))}
    for path, value in fields.items():
        *parents, last = path.split("__")
        inner = made
        for parent in parents:
            inner = getattr(inner, parent)
        setattr(inner, last, value)
    return made


def _blank(kind):
    fields = STORE.fielddefs[kind][1]
    return STORE.types[kind](**{field: _zero(*desc) for field, desc in fields})


def _zero(node, of):
    if node == Nodetype.NAME:
        return _blank(of)
    if node == Nodetype.BASE:
        return "" if "string" in of[0] else 0.0 if "float" in of[0] else 0
    (inner, kind), size = of
    count = size if node == Nodetype.ARRAY else 0
    if inner == Nodetype.BASE:
        return np.zeros(count, dtype=kind[0])
    return [_zero(inner, kind) for _ in range(count)]


def write_bag(path: Path, topics, storage="SQLITE3", compression="NONE") -> Path:
    """A bag of topic -> (type, [(arrival s, message), …]); returns its folder."""
    bag = Writer(path, version=9, storage_plugin=StoragePlugin[storage])
    bag.set_compression(CompressionMode[compression], CompressionFormat.ZSTD)
    with bag as writer:
        for topic, (kind, messages) in topics.items():
            connection = writer.add_connection(topic, kind, typestore=STORE)
            for arrival, content in messages:
                raw = STORE.serialize_cdr(content, kind)
                writer.write(connection, round(1e9 * arrival), raw)
    return path


def without_definitions(bag: Path) -> Path:
    """The storage file as ROS 2 Humble wrote it: no definitions, no metadata beside it."""
    file = next(bag.glob("*.db3"))
    with sqlite3.connect(file) as database:
        database.execute("UPDATE schema SET schema_version = 3")
        database.execute("DROP TABLE message_definitions")
    database.close()
    (bag / "metadata.yaml").unlink()
    return file


def poses(swim, kind=POSE, late=0.0, stamped=True):
    """Messages of a swim, that arrive `late` after their stamps."""
    prefix = "pose__pose" if kind == ODOMETRY else "pose"
    messages = []
    for t, p, q in zip(swim.time, swim.position, from_matrix(swim.rotation), strict=True):
        places = zip(("x", "y", "z"), p, strict=True)
        turns = zip(("w", "x", "y", "z"), q, strict=True)
        fields = {f"{prefix}__position__{axis}": float(x) for axis, x in places}
        fields |= {f"{prefix}__orientation__{axis}": float(x) for axis, x in turns}
        stamp = START + t if stamped else None
        messages.append((START + t + late, message(kind, stamp, **fields)))
    return kind, messages


def write_swim(path: Path, swim) -> Path:
    """A bag of one topic of poses."""
    return write_bag(path, {"/mocap/BlueROV2/pose": poses(swim)})


def write_outputs(path: Path) -> Path:
    """A bag of outputs to two thrusters, 50 times a second."""
    kind = "mavros_msgs/msg/RCOut"
    arrivals = START + np.arange(0.0, 4.0, 0.02)
    pulses = np.round(1500 + 200 * np.sin(3 * (arrivals - START))).astype(np.uint16)
    messages = [
        (t, message(kind, t, channels=np.array([pulse, 3000 - pulse], np.uint16)))
        for t, pulse in zip(arrivals, pulses, strict=True)
    ]
    return write_bag(path, {"/mavros/rc/out": (kind, messages)})
