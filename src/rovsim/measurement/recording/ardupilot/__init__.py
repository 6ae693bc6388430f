"""ArduPilot logs, dataflash (.BIN) and telemetry (.tlog): channels and commands.

logs       a log by the ending of its name
dataflash  .BIN, which describes its own messages
telemetry  .tlog: MAVLink packets
series     what a log holds of one type of message
motion     what was measured
commands   outputs to thrusters, or the radio of the pilot
"""

from rovsim.measurement.recording.ardupilot.commands import read_commands
from rovsim.measurement.recording.ardupilot.motion import read_log

__all__ = ["read_commands", "read_log"]
