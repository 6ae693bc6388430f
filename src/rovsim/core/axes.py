"""The six axes, and letters and units of velocities, forces and spectra along them."""

AXES = ("surge", "sway", "heave", "roll", "pitch", "yaw")
VELOCITY = ("u", "v", "w", "p", "q", "r")  # letters of Fossen 2021, table 2.1
FORCE = ("X", "Y", "Z", "K", "M", "N")
VELOCITY_UNITS = ("m/s",) * 3 + ("rad/s",) * 3
ACCELERATION_UNITS = ("m/s²",) * 3 + ("rad/s²",) * 3
FORCE_UNITS = ("N",) * 3 + ("N m",) * 3
DENSITY_UNITS = ("N²/Hz",) * 3 + ("N² m²/Hz",) * 3
