"""ArduPilot logs, dataflash (.BIN) and telemetry (.tlog): channels and commands.

logs        open a log by the ending of its name
dataflash   .BIN, which describes its own messages
telemetry   .tlog: MAVLink packets
series      the messages of one type as arrays
motion      measured channels
commands    outputs to thrusters, or the radio of the pilot
candidates  finds which of them a log holds
"""

from rovsim.measurement.recording.formats.ardupilot.candidates import find_commands
from rovsim.measurement.recording.formats.ardupilot.commands import read_commands
from rovsim.measurement.recording.formats.ardupilot.motion import MOCAP_READER
from rovsim.measurement.recording.readers import CommandReader

COMMAND_READER = CommandReader("ardupilot", read_commands, find_commands)

__all__ = ["COMMAND_READER", "MOCAP_READER"]
