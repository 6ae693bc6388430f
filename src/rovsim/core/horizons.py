"""Horizons: how far replays look ahead before they restart from the measurement; their names."""

OPEN_LOOP = "open_loop"  # a single replay of the whole run
STANDARD_WINDOW = 2.0  # s, of replays in the ladder, in figures and in summaries


def name_horizon(seconds: float) -> str:
    """Name of the horizon of windows that last `seconds`."""
    return f"{seconds:g}"


STANDARD_HORIZON = name_horizon(STANDARD_WINDOW)  # as predictions and scores call it
