"""A bag: its topics, and the messages of one of them by the clock of the bag."""

from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Iterator

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput, nearest
from rovsim.core.extras import require
from rovsim.measurement.recording.foreign import read_by
from rovsim.measurement.recording.rosbag2.definitions import store_for
from rovsim.measurement.recording.rosbag2.stamps import on_bag_clock

WHOLE = "a whole ROS 2 bag: its folder, or one .db3 or .mcap file"
REPAIR = "Check it with `ros2 bag info`; `ros2 bag reindex` or `mcap recover` repair a cut one."


@dataclass(frozen=True, eq=False)
class Messages:
    """Messages of one topic: `time` (n,) s by the clock of the bag, and what each holds."""

    topic: str
    kind: str
    time: Array
    content: list[Any]
    notes: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Bag:
    """An open bag."""

    path: Path
    reader: Any

    @property
    def topics(self) -> dict[str, str]:
        """Type by topic, of those that hold messages."""
        return {c.topic: c.msgtype for c in self.reader.connections if c.msgcount}

    def messages(self, topic: str, key: str) -> Messages:
        """All messages of a topic, by time; `key` of campaign.yaml names it.

        Raises:
            BadInput: no such topic, or a type that nobody defines.
        """
        connections = [c for c in self.reader.connections if c.topic == topic and c.msgcount]
        if not connections:
            raise self._nothing(topic, key)
        stores = {c.id: store_for(c, f"{self.path}, {topic}") for c in connections}
        stamped = [
            (at, stores[c.id].deserialize_cdr(raw, c.msgtype))
            for c, at, raw in self.reader.messages(connections)
        ]
        if not stamped:
            raise self._nothing(topic, key)
        stamped.sort(key=lambda pair: pair[0])
        content = [message for _, message in stamped]
        arrived = np.array([at for at, _ in stamped], dtype=np.int64)
        time, notes = on_bag_clock(topic, arrived, content)
        return Messages(topic, connections[0].msgtype, time, content, notes)

    def _nothing(self, topic: str, key: str) -> BadInput:
        return BadInput(
            f"no messages of the topic '{topic}'",
            where=self.path,
            expected=f"the topic that '{key}' names",
            remedy=nearest(topic, self.topics),
        )


@contextmanager
def opened(path: Path, by: str) -> Iterator[Bag]:
    """Open a bag for reading.

    Raises:
        BadInput: it is no bag, or a damaged one.
    """
    require("recordings", by=by)
    from rosbags.rosbag2 import Reader

    place = _storage(path)
    with read_by("rosbags", path, WHOLE, REPAIR), Reader(place) as reader:
        yield Bag(path, reader)


def _storage(path: Path) -> Path:
    """What rosbags opens: the folder, or the one file in a folder without metadata."""
    if not path.is_dir():
        if path.suffix in (".db3", ".mcap"):
            return path
        raise BadInput(
            f"a file that ends in '{path.suffix}'",
            where=path,
            expected=WHOLE,
            remedy="Name the folder of the bag; a ROS 1 bag is turned by `rosbags-convert`.",
        )
    if (path / "metadata.yaml").exists():
        return path
    files = sorted(file for file in path.iterdir() if file.suffix in (".db3", ".mcap"))
    if len(files) == 1:
        return files[0]
    raise BadInput(
        f"a folder without metadata.yaml and with {len(files)} storage files",
        where=path,
        expected=WHOLE,
        remedy="Name one of its files, or `ros2 bag reindex` the folder.",
    )
