"""Small ArduPilot logs: dataflash packed by hand, telemetry packed by pymavlink."""

import struct
from pathlib import Path

import numpy as np
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from rovsim.core.rotations import from_matrix, to_euler

CODES = {"Q": "Q", "f": "f", "B": "B", "H": "H", "h": "h", "c": "h", "I": "I", "Z": "64s", "M": "B"}
COMMANDED = "QHHHH", ["TimeUS", "C1", "C2", "C3", "C4"]
RECEIVED = 1_700_000_000.0  # s, when the vehicle was booted by the clock of the ground station


class Dataflash:
    """A .BIN that grows by messages of named types."""

    def __init__(self):
        self.raw, self.kinds = b"", {}
        self.declare("FMT", "BBnNZ", ["Type", "Length", "Name", "Format", "Columns"], 128)

    def declare(self, name, codes, columns, kind=None):
        kind = kind or len(self.kinds) + 1
        length = 89 if kind == 128 else 3 + struct.calcsize("<" + "".join(CODES[c] for c in codes))
        self.kinds[name] = kind, codes
        row = struct.pack(
            "<BB4s16s64s", kind, length, name.encode(), codes.encode(), ",".join(columns).encode()
        )
        self.raw += b"\xa3\x95\x80" + row

    def add(self, name, *values):
        kind, codes = self.kinds[name]
        packed = struct.pack("<" + "".join(CODES[c] for c in codes), *values)
        self.raw += b"\xa3\x95" + bytes([kind]) + packed

    def write(self, path: Path) -> Path:
        path.write_bytes(self.raw)
        return path


def angles(swim):
    """Roll, pitch and yaw (n, 3) in rad."""
    return to_euler(from_matrix(swim.rotation))


def dataflash(swim, vehicle="ArduSub V4.1.2", status=0b00011111) -> Dataflash:
    """A log of a swim: attitude, filter position with its status, and outputs at every frame."""
    log = Dataflash()
    log.declare("MSG", "QZ", ["TimeUS", "Message"])
    log.declare("ATT", "Qfff", ["TimeUS", "Roll", "Pitch", "Yaw"])
    log.declare("XKF1", "QBfff", ["TimeUS", "C", "PN", "PE", "PD"])
    log.declare("XKF4", "QBH", ["TimeUS", "C", "SS"])
    log.declare("RCOU", *COMMANDED)
    log.add("MSG", 0, vehicle.encode())
    log.add("XKF4", 0, 0, status)
    for t, p, a in zip(swim.time, swim.position, np.degrees(angles(swim)), strict=True):
        now = round(1e6 * t)
        log.add("ATT", now, *a)
        for core in (0, 1):  # the second is that of another filter
            log.add("XKF1", now, core, *(p + core))
        log.add("RCOU", now, 1500, 1900, 1100, 0)
    return log


def write_dataflash(path: Path, swim) -> Path:
    """A .BIN of a swim."""
    return dataflash(swim).write(path)


class Telemetry:
    """A .tlog that grows by packets of a vehicle and of a ground station."""

    def __init__(self):
        self.raw = b""
        self.vehicle = mavlink.MAVLink(None, srcSystem=1, srcComponent=1)
        self.station = mavlink.MAVLink(None, srcSystem=255, srcComponent=190)

    def add(self, since_boot, message, sender=None, delay=0.05):
        packet = message.pack(sender or self.vehicle)
        received = round(1e6 * (RECEIVED + since_boot + delay))
        self.raw += struct.pack(">Q", received) + packet

    def write(self, path: Path) -> Path:
        path.write_bytes(self.raw)
        return path


def telemetry(swim, vehicle=mavlink.MAV_TYPE_SUBMARINE, flags=16 + 8 + 32) -> Telemetry:
    """A log of a swim: everything that is read, at every frame."""
    log = Telemetry()
    for k, (t, p, a) in enumerate(zip(swim.time, swim.position, angles(swim), strict=True)):
        ms, us = round(1e3 * t), round(1e6 * t)
        if k % 20 == 0:
            beat = mavlink.MAVLink_heartbeat_message
            log.add(t, beat(6, 8, 0, 0, 0, 3), log.station)
            log.add(t, beat(vehicle, 3, 81, 19, 4, 3))
            log.add(t, mavlink.MAVLink_ekf_status_report_message(flags, 0, 0, 0, 0, 0))
        log.add(t, mavlink.MAVLink_attitude_message(ms, *a, 0.1, 0.2, 0.3))
        log.add(t, mavlink.MAVLink_local_position_ned_message(ms, *p, 0, 0, 0))
        log.add(t, mavlink.MAVLink_raw_imu_message(us, 0, 0, -1000, 0, 0, 0, 0, 0, 0))
        log.add(t, mavlink.MAVLink_vfr_hud_message(0, 0, 0, 0, -2.5, 0))
        log.add(t, mavlink.MAVLink_sys_status_message(0, 0, 0, 0, 16200, 0, 0, 0, 0, 0, 0, 0, 0))
        servos = [1500, 1900, 1100, 0, 1500, 1500, 1500, 1500]
        log.add(t, mavlink.MAVLink_servo_output_raw_message(us, 0, *servos))
        radio = [1500, 1600, *[65535] * 16]
        log.add(t, mavlink.MAVLink_rc_channels_message(ms, 18, *radio, 255))
    return log
