"""Units as figures and tables print them."""


def unit(si: str | None) -> str:
    """Return a unit with superscript powers, "m/s2" as "m/s²"; empty for "1" or None."""
    return "" if si in (None, "1") else si.replace("2", "²").replace("3", "³")
