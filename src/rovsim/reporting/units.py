"""Units as figures and tables print them."""


def unit(si: str | None) -> str:
    """A unit with its powers raised; 1 is no unit."""
    return "" if si in (None, "1") else si.replace("2", "²").replace("3", "³")
