"""How far replays look ahead before they start anew, and what these horizons are called."""

OPEN_LOOP = "open_loop"  # once, over a whole run
WINDOW = 2.0  # s, the windows that ladder, figures and summaries are of
HORIZON = f"{WINDOW:g}"  # the same, as replays name them
