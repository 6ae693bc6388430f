"""How much of the runs takes part in an estimate."""

MAX_TRAIN_SECONDS = 600.0  # s of train runs: ten minutes at 100 Hz take 1.5 GB
