"""ROS 2 bags, sqlite3 or MCAP, by `rosbags`: poses, other channels, commands."""

from rovsim.measurement.recording.rosbag2.commands import read_commands
from rovsim.measurement.recording.rosbag2.motion import read_bag

__all__ = ["read_bag", "read_commands"]
