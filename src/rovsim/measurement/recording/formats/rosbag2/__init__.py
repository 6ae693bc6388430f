"""ROS 2 bags, sqlite3 or MCAP, by `rosbags`: poses, other channels, commands.

bag          topics, and the numbers of one of them
definitions  types of messages: of ROS, of mavros, of the bag itself
messages     take numbers out of messages, by their fields
stamps       when a message was measured
motion       poses and channels
commands     pulses, arrays, wrenches, joysticks
"""

from rovsim.measurement.recording.formats.rosbag2.commands import COMMAND_READER
from rovsim.measurement.recording.formats.rosbag2.motion import MOCAP_READER

__all__ = ["COMMAND_READER", "MOCAP_READER"]
