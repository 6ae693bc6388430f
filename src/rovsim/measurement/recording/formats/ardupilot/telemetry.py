"""Read telemetry logs (.tlog): MAVLink packets, each preceded by its time of reception."""

import re
import struct
from collections import defaultdict
from pathlib import Path
from typing import Any, Iterator

import numpy as np
from numpy import ndarray as Array

from rovsim.core.extras import require
from rovsim.measurement.recording.formats.ardupilot.series import ArduPilotLog, Series, no_log

# https://mavlink.io/en/guide/serialization.html: marker, bytes of a packet besides the payload
PACKET_OVERHEAD = {0xFD: 12, 0xFE: 8}
MARKER_PATTERN = re.compile(rb"[\xfd\xfe]")
SIGNED_FLAG, SIGNATURE_BYTES = 0x01, 13
WANTED_TYPES = ["HEARTBEAT", "ATTITUDE", "RAW_IMU", "VFR_HUD", "LOCAL_POSITION_NED", "SYS_STATUS"]
WANTED_TYPES += ["EKF_STATUS_REPORT", "SERVO_OUTPUT_RAW", "RC_CHANNELS"]
NO_AUTOPILOT, SUBMARINE = 8, 12  # MAV_AUTOPILOT_INVALID, MAV_TYPE_SUBMARINE
REBOOT_STEP_S = 1.0  # by which the time since boot may step back and still be a late packet

Received = tuple[float, Any]  # s since 1970, message


def read_telemetry(path: Path) -> ArduPilotLog:
    """Read the messages of the types in `WANTED_TYPES` that the vehicle itself sent.

    Raises:
        BadInput: not a telemetry log, or nothing in it can be read.
    """
    require("recordings", by="mocap.format: ardupilot with a .tlog")
    from pymavlink.dialects.v20 import ardupilotmega as dialect

    raw = path.read_bytes()
    numbers = {m.id for m in dialect.mavlink_map.values() if m.msgname in WANTED_TYPES}
    packets = list(_messages(raw, dialect, numbers))
    if not packets:
        problem = f"no message of a known type in {len(raw)} bytes" if raw else "the file is empty"
        raise no_log(path, problem)
    packets, submarine = _of_vehicle(packets)
    by_type: dict[str, list[Received]] = defaultdict(list)
    for received, message in packets:
        by_type[message.get_type()].append((received, message))
    offset, notes = _boot(packets)
    series = {name: _series(messages, offset) for name, messages in by_type.items()}
    return ArduPilotLog(path, "telemetry", series, submarine, notes)


def _messages(raw: bytes, dialect: Any, numbers: set[int]) -> Iterator[Received]:
    """Yield whole messages with these type numbers; damaged bytes are skipped."""
    decoder = dialect.MAVLink(None)
    offset = 0
    while offset + 8 + 6 < len(raw):
        length = _length(raw, offset + 8)
        packet = raw[offset + 8 : offset + 8 + length]
        if not length or len(packet) < length:
            marker = MARKER_PATTERN.search(raw, offset + 9)
            if marker is None:
                return
            offset = marker.start() - 8
            continue
        if _number(packet) not in numbers:
            # an unwanted packet is taken for a whole one if another packet follows it
            following = offset + 16 + length
            offset += (
                8 + length if following >= len(raw) or raw[following] in PACKET_OVERHEAD else 1
            )
            continue
        try:
            message = decoder.decode(bytearray(packet))
        except dialect.MAVError:
            offset += 1
            continue
        yield struct.unpack_from(">Q", raw, offset)[0] * 1e-6, message
        offset += 8 + length


def _length(raw: bytes, at: int) -> int:
    """Length in bytes of the packet at offset `at`; 0 where there is none."""
    around = PACKET_OVERHEAD.get(raw[at], 0)
    if not around:
        return 0
    signed = raw[at] == 0xFD and raw[at + 2] & SIGNED_FLAG
    return around + raw[at + 1] + (SIGNATURE_BYTES if signed else 0)


def _number(packet: bytes) -> int:
    return int.from_bytes(packet[7:10], "little") if packet[0] == 0xFD else packet[5]


def _of_vehicle(messages: list[Received]) -> tuple[list[Received], bool | None]:
    """Keep messages of the first autopilot (not of ground stations or cameras).

    Returns:
        The messages, and whether the vehicle is a submarine; None if there was no heartbeat.
    """
    beats = [m for _, m in messages if m.get_type() == "HEARTBEAT" and m.autopilot != NO_AUTOPILOT]
    if not beats:
        return messages, None
    heartbeat = beats[0]
    source = (heartbeat.get_srcSystem(), heartbeat.get_srcComponent())
    packets = [(t, m) for t, m in messages if (m.get_srcSystem(), m.get_srcComponent()) == source]
    return packets, heartbeat.type == SUBMARINE


def _since_boot(message: Any) -> float:
    """Time since boot in a message, s; NaN where there is none."""
    fields = message.get_fieldnames()
    if "time_boot_ms" in fields:
        return message.time_boot_ms * 1e-3
    return message.time_usec * 1e-6 if "time_usec" in fields else float("nan")


def _boot(messages: list[Received]) -> tuple[float, tuple[str, ...]]:
    """Find when the vehicle was booted, s since 1970; NaN where its clock cannot be used.

    It is the median of reception time less time since boot, so the usual delay of the radio link
    counts as zero.

    Returns:
        The time, and sentences about the clock.
    """
    received = np.array([t for t, _ in messages])
    boot = np.array([_since_boot(m) for _, m in messages])
    valid = np.isfinite(boot)
    if not valid.any():
        return float("nan"), ()
    boot, received = boot[valid], received[valid]
    steps = np.diff(boot)
    delay = received - boot
    if len(steps) and (
        steps.min() < -REBOOT_STEP_S or np.ptp(np.percentile(delay, [5, 95])) > REBOOT_STEP_S
    ):
        note = "The vehicle's clock does not go on (a reboot?): the times of reception hold."
        return float("nan"), (note,)
    return float(np.median(delay)), ()


def _series(messages: list[Received], offset: float) -> Series:
    time = np.array([t for t, _ in messages])
    if np.isfinite(offset):
        boot = np.array([_since_boot(m) for _, m in messages]) + offset
        time = np.where(np.isfinite(boot), boot, time)
    message = messages[0][1]
    names = [n for n in message.get_fieldnames() if isinstance(getattr(message, n), int | float)]
    return Series(time, {name: _values(messages, name) for name in names})


def _values(messages: list[Received], name: str) -> Array:
    return np.array([float(getattr(m, name)) for _, m in messages])
