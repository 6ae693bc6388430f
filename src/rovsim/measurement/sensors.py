"""Where the sensors of a vehicle sit, and by how much their time stamps are late."""

from typing import Annotated

from pydantic import Field

from rovsim.core.schema import Number, Section

Position = Annotated[tuple[Number, Number, Number], Field()]  # m, FRD from CO


class Delays(Section):
    """Seconds by which each kind of channel is stamped after it was measured."""

    position: Number = 0.0
    attitude: Number = 0.0
    euler: Number = 0.0
    depth: Number = 0.0
    velocity: Number = 0.0
    rates: Number = 0.0
    specific_force: Number = 0.0
    voltage: Number = 0.0


class Sensors(Section):
    """The sensors of the channels.

    Attributes:
        velocity_at: place of the velocity sensor, m, FRD from CO; the others likewise.
        imu_at: place of the inertial unit.
        depth_at: place of the depth or pressure sensor.
        delay_s: delay of each kind of channel, s.
        surface_pressure: Pa; with `water_density` turns a logged pressure into a depth.
        water_density: kg/m3.
    """

    velocity_at: Position = (0.0, 0.0, 0.0)
    imu_at: Position = (0.0, 0.0, 0.0)
    depth_at: Position = (0.0, 0.0, 0.0)
    delay_s: Delays = Delays()
    # standard atmosphere, ISO 2533
    surface_pressure: Number = Field(default=101325.0, gt=0)
    # fresh water near 4 degrees; sea water has about 1025
    water_density: Number = Field(default=1000.0, gt=0)
