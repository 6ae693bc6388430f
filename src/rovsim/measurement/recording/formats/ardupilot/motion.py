"""Read attitude, rates, specific force, depth, position and voltage of an ArduPilot log."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.core.rotations import from_euler
from rovsim.measurement.campaign_file import Mocap
from rovsim.measurement.recording.channels import Channel, measured
from rovsim.measurement.recording.exports import Export
from rovsim.measurement.recording.formats.ardupilot.logs import SIGNATURES, needs, open_log
from rovsim.measurement.recording.formats.ardupilot.series import ArduPilotLog, Series
from rovsim.measurement.recording.readers import FileAxes, MocapReader

DEGREE = np.pi / 180.0
MILLI_G = 9.80665e-3  # m/s2: RAW_IMU of ArduPilot is in milli-g
KF_POSITION = ("PN", "PE", "PD")


@dataclass(frozen=True)
class ChannelSource:
    """Where a channel stands: fields of a type of message, and their factor to SI units."""

    series: str
    fields: tuple[str, ...]
    factor: float = 1.0


# Kind of channel -> where it stands, the first that the log has. Altitudes are up.
CHANNEL_SOURCES = {
    "dataflash": {
        "attitude": [ChannelSource("ATT", ("Roll", "Pitch", "Yaw"), DEGREE)],
        "rates": [ChannelSource("IMU", ("GyrX", "GyrY", "GyrZ"))],
        "specific_force": [ChannelSource("IMU", ("AccX", "AccY", "AccZ"))],
        "depth": [ChannelSource("CTUN", ("BAlt",), -1.0), ChannelSource("BARO", ("Alt",), -1.0)],
        "position": [ChannelSource("XKF1", KF_POSITION), ChannelSource("NKF1", KF_POSITION)],
        "voltage": [ChannelSource("BAT", ("Volt",)), ChannelSource("CURR", ("Volt",))],
    },
    "telemetry": {
        "attitude": [ChannelSource("ATTITUDE", ("roll", "pitch", "yaw"))],
        "rates": [ChannelSource("ATTITUDE", ("rollspeed", "pitchspeed", "yawspeed"))],
        "specific_force": [ChannelSource("RAW_IMU", ("xacc", "yacc", "zacc"), MILLI_G)],
        "depth": [ChannelSource("VFR_HUD", ("alt",), -1.0)],
        "position": [ChannelSource("LOCAL_POSITION_NED", ("x", "y", "z"))],
        "voltage": [ChannelSource("SYS_STATUS", ("voltage_battery",), 1e-3)],
    },
}
# Where the autopilot's Kalman filter states its status, with the same bits in both kinds of log
# (nav_filter_status).
STATUS_FIELDS = {"dataflash": [("XKF4", "SS"), ("NKF4", "SS")]}
STATUS_FIELDS["telemetry"] = [("EKF_STATUS_REPORT", "flags")]
POSITION_KNOWN, POSITION_ASSUMED = 0b11000, 0b10000000  # relative or absolute; constant
NO_VOLTAGE = 65.535  # V: UINT16_MAX
MODES = {0: "STABILIZE", 1: "ACRO", 2: "ALT_HOLD", 3: "AUTO", 4: "GUIDED", 7: "CIRCLE"}
MODES |= {9: "SURFACE", 16: "POSHOLD", 19: "MANUAL", 20: "MOTOR_DETECT", 21: "SURFTRAK"}


def read_log(path: Path, mocap: Mocap) -> Export:
    """Read the channels of a log.

    Raises:
        BadInput: no such log, other axes than ArduPilot's, or nothing measured in it.
    """
    _check_axes(mocap, path)
    log = open_log(path)
    readings = {kind: _read(log, sources) for kind, sources in CHANNEL_SOURCES[log.kind].items()}
    channels = {
        kind: channel
        for kind, channel in readings.items()
        if channel is not None and len(channel.time)
    }
    if not channels:
        names = [
            source.series for options in CHANNEL_SOURCES[log.kind].values() for source in options
        ]
        raise needs(log, list(dict.fromkeys(names)), "nothing of the motion")
    notes = log.notes + _adapt(log, channels) + _modes(log)
    return Export.of_channels(channels, notes=notes)


def _check_axes(mocap: Mocap, path: Path) -> None:
    if (mocap.world_axes, mocap.body_axes) != ("ned", "frd"):
        raise BadInput(
            f"the axes {mocap.world_axes} and {mocap.body_axes} for an ArduPilot log",
            where=path,
            expected="world_axes: ned and body_axes: frd, which ArduPilot logs",
            remedy="Correct them in campaign.yaml.",
        )


def _read(log: ArduPilotLog, sources: list[ChannelSource]) -> Channel | None:
    source = next((s for s in sources if s.series in log.series), None)
    if source is None:
        return None
    series = log.series[source.series]
    return measured(series.time, series.of(source.fields) * source.factor)


def _adapt(log: ArduPilotLog, channels: dict[str, Channel]) -> tuple[str, ...]:
    """Convert angles to quaternions and remove values without meaning; say what was left out."""
    notes = []
    if "attitude" in channels:
        time, angles = channels["attitude"].time, channels["attitude"].value
        complete = np.isfinite(angles).all(axis=1)
        channels["attitude"] = Channel(time[complete], from_euler(*angles[complete].T))
    if "voltage" in channels:
        time, volts = channels["voltage"].time, channels["voltage"].value
        valid = (volts[:, 0] > 0.0) & (volts[:, 0] != NO_VOLTAGE)
        channels["voltage"] = Channel(time[valid], volts[valid])
    if "depth" in channels and log.submarine is False:
        del channels["depth"]
        notes.append("The vehicle is no submarine: its altitude is not read as a depth.")
    if "position" in channels:
        notes += _believed_position(log, channels)
    return tuple(notes)


def _believed_position(log: ArduPilotLog, channels: dict[str, Channel]) -> list[str]:
    """Keep positions of the Kalman filter that it says are known; z only if there is no depth."""
    position = channels.pop("position")
    valid = _find_known(log, position.time)
    if not valid.any():
        return ["The filter never knew where the vehicle was: its position is not measured."]
    value = position.value[valid]
    if "depth" in channels:  # the filter computes its height from the depth
        value = np.where([True, True, False], value, np.nan)
    channels["position"] = Channel(position.time[valid], value)
    left_out = int(np.sum(~valid))
    return [f"{left_out} positions that the filter did not know were left out."] if left_out else []


def _find_known(log: ArduPilotLog, time: Array) -> Array:
    """Mask (n,) of times at which the filter's last status said that it knows the position."""
    source = next(((s, f) for s, f in STATUS_FIELDS[log.kind] if s in log.series), None)
    if source is None:
        return np.zeros(len(time), bool)
    status = _in_order(log.series[source[0]])
    flags = np.nan_to_num(status.of([source[1]])[:, 0]).astype(np.int64)
    position_known = (flags & POSITION_KNOWN != 0) & (flags & POSITION_ASSUMED == 0)
    latest = np.searchsorted(status.time, time, side="right") - 1
    return np.where(latest >= 0, position_known[np.maximum(latest, 0)], False)


def _in_order(series: Series) -> Series:
    return series.where(np.argsort(series.time, kind="stable"))


def _modes(log: ArduPilotLog) -> tuple[str, ...]:
    """Sentence on the flight modes: in all but MANUAL the autopilot is in the loop."""
    name, field = ("MODE", "ModeNum") if log.kind == "dataflash" else ("HEARTBEAT", "custom_mode")
    if name not in log.series or log.submarine is False:
        return ()
    modes = log.series[name]
    number = modes.of([field if field in modes.fields else "Mode"])[:, 0]
    number = np.unique(number[np.isfinite(number)]).astype(int)
    if not len(number):
        return ()
    names = ", ".join(MODES.get(int(n), f"number {n}") for n in number)
    return (f"Flight modes in this log: {names}. In all but MANUAL the autopilot adds its own.",)


MOCAP_READER = MocapReader(
    "ardupilot",
    "an ArduPilot log",
    read_log,
    SIGNATURES,
    axes=FileAxes(("ned",), ("frd",), reason="ArduPilot logs in these axes"),
)
