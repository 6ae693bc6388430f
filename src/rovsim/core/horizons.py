"""How far replays look ahead before they start anew, and what these horizons are called."""

OPEN_LOOP = "open_loop"  # once, over a whole run
WINDOW = 2.0  # s, the windows that ladder, figures and summaries are of


def name_horizon(seconds: float) -> str:
    """What replays call windows of so many seconds."""
    return f"{seconds:g}"


HORIZON = name_horizon(WINDOW)
