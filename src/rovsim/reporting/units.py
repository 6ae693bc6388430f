"""Letters and units of the six axes, surge to yaw, as figures and tables print them; any unit."""

VELOCITY = ("u", "v", "w", "p", "q", "r")  # Fossen's letters
VELOCITY_UNITS = ("m/s",) * 3 + ("rad/s",) * 3
FORCE = ("X", "Y", "Z", "K", "M", "N")
FORCE_UNITS = ("N",) * 3 + ("N m",) * 3
DENSITY_UNITS = ("N²/Hz",) * 3 + ("N² m²/Hz",) * 3
ACCELERATION_UNITS = ("m/s²",) * 3 + ("rad/s²",) * 3


def unit(si: str | None) -> str:
    """A unit with its powers raised; 1 is no unit."""
    return "" if si in (None, "1") else si.replace("2", "²").replace("3", "³")
