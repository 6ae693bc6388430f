"""ROS 2 bags, sqlite3 or MCAP, by `rosbags`: poses, other channels, commands.

bag          topics, and the numbers of one of them
definitions  types of messages: of ROS, of mavros, of the bag itself
messages     take numbers out of messages, by their fields
stamps       when a message was measured
motion       poses and channels
commands     pulses, arrays, wrenches, joysticks
candidates   finds the topics that hold some
topic_names  what names and types of topics tell
"""

from rovsim.measurement.recording.formats.rosbag2.candidates import find_commands
from rovsim.measurement.recording.formats.rosbag2.commands import read_commands
from rovsim.measurement.recording.formats.rosbag2.motion import MOCAP_READER
from rovsim.measurement.recording.readers import CommandReader

COMMAND_READER = CommandReader(
    "rosbag2", read_commands, find_commands, options={"topic": "the topic of a ROS 2 bag"}
)

__all__ = ["COMMAND_READER", "MOCAP_READER"]
