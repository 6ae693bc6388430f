"""ArduPilot logs, dataflash (.BIN) and telemetry (.tlog): channels and commands."""

from rovsim.measurement.recording.ardupilot.commands import read_commands
from rovsim.measurement.recording.ardupilot.motion import read_log

__all__ = ["read_commands", "read_log"]
