"""Open a ROS 2 bag, list its topics, and read numbers of a topic on the clock of the bag."""

from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, Iterator, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput, nearest
from rovsim.core.extras import require
from rovsim.measurement.recording.foreign import read_by
from rovsim.measurement.recording.formats.rosbag2.definitions import store_for
from rovsim.measurement.recording.formats.rosbag2.stamps import on_bag_clock, stamp

EXPECTED_BAG = "a whole ROS 2 bag: its folder, or one .db3 or .mcap file"
REPAIR_BAG = "Check it with `ros2 bag info`; `ros2 bag reindex` or `mcap recover` repair a cut one."


Numbers = Callable[[Any], Sequence[float]]


@dataclass(frozen=True, eq=False)
class TopicSamples:
    """Numbers from the n messages of one topic.

    Attributes:
        topic: its name.
        kind: type of the messages.
        time: (n,) s, on the clock of the bag.
        value: (n, c), c numbers from each message.
        notes: sentences about the time stamps.
    """

    topic: str
    kind: str
    time: Array
    value: Array
    notes: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Bag:
    """An open bag: its path, and the reader of `rosbags`."""

    path: Path
    reader: Any

    @property
    def topics(self) -> dict[str, str]:
        """Message type of each topic that has messages."""
        return {c.topic: c.msgtype for c in self.reader.connections if c.msgcount}

    def first(self, topic: str, key: str) -> tuple[str, Any]:
        """Type of a topic and its first message; raises as `read` does."""
        for kind, _, message in self._messages(topic, key):
            return kind, message
        raise self._nothing(topic, key)

    def read(self, topic: str, key: str, numbers: Numbers, expected: str) -> TopicSamples:
        """Take numbers out of every message of a topic.

        Args:
            topic: its name.
            key: key of campaign.yaml that names the topic, for errors.
            numbers: takes the numbers out of a message.
            expected: what a message should hold, for errors.

        Raises:
            BadInput: no such topic, a type without definition, or messages that lack the numbers.
        """
        kind, rows = "", []
        for kind, arrived, message in self._messages(topic, key):
            try:
                rows.append((arrived, stamp(message), *map(float, numbers(message))))
            except (AttributeError, TypeError, ValueError, IndexError):
                raise self._other(topic, kind, expected) from None
        if not rows:
            raise self._nothing(topic, key)
        rows.sort(key=lambda row: row[0])
        clocks = np.array([row[:2] for row in rows], dtype=np.int64)
        value = np.array([row[2:] for row in rows], dtype=float)
        time, notes = on_bag_clock(topic, clocks[:, 0], clocks[:, 1])
        return TopicSamples(topic, kind, time, value, notes)

    def _messages(self, topic: str, key: str) -> Iterator[tuple[str, int, Any]]:
        """Yield type, time of arrival (ns) and content of each message of a topic."""
        connections = [c for c in self.reader.connections if c.topic == topic and c.msgcount]
        if not connections:
            raise self._nothing(topic, key)
        stores = {c.id: store_for(c, f"{self.path}, {topic}") for c in connections}
        for c, arrived, raw in self.reader.messages(connections):
            yield c.msgtype, arrived, stores[c.id].deserialize_cdr(raw, c.msgtype)

    def _other(self, topic: str, kind: str, expected: str) -> BadInput:
        return BadInput(
            f"messages of the type {kind}",
            where=f"{self.path}, {topic}",
            expected=expected,
            remedy="Name another topic, or republish it as a standard type.",
        )

    def _nothing(self, topic: str, key: str) -> BadInput:
        return BadInput(
            f"no messages of the topic '{topic}'",
            where=self.path,
            expected=f"the topic that '{key}' names",
            remedy=nearest(topic, self.topics),
        )


@contextmanager
def opened(path: Path, by: str) -> Iterator[Bag]:
    """Open a bag for reading; `by` says which key of campaign.yaml needs it.

    Raises:
        BadInput: it is no bag, or a damaged one.
    """
    require("recordings", by=by)
    from rosbags.rosbag2 import Reader

    storage = _storage(path)
    with read_by("rosbags", path, EXPECTED_BAG, REPAIR_BAG), Reader(storage) as reader:
        yield Bag(path, reader)


def _storage(path: Path) -> Path:
    """Path that `rosbags` can open: the bag, or the only file in a folder without metadata."""
    if not path.is_dir():
        if path.suffix in (".db3", ".mcap"):
            return path
        raise BadInput(
            f"a file that ends in '{path.suffix}'",
            where=path,
            expected=EXPECTED_BAG,
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
        expected=EXPECTED_BAG,
        remedy="Name one of its files, or `ros2 bag reindex` the folder.",
    )
