"""A motion that does not follow its commands, or too late or too early."""

from numpy import ndarray as Array

from rovsim.evaluation.commanded_motion.cross_correlation import MIN_CORRELATION, CrossCorrelation

# A thruster answers within tenths of a second, a radio or an autopilot adds as much again; the peak
# of the correlation is known to about a tenth of a second.
EARLIEST, LATEST = -0.25, 0.6  # s
# Of periodic commands a peak some seconds away may be as high as that of the true lag.
CLEARER, AWAY = 0.03, 1.0  # correlation by which it must be higher, s beyond the usual lags
QUARTER = 900.0  # s: time zones differ by whole quarters of an hour
LOOSE = 60.0  # s by which clocks that were set by hand differ beside it
FITTED = 0.5  # s: from further away a fit of `input_delay` does not come back


def tell_following(found: CrossCorrelation, axes: Array) -> str:
    """That a motion hardly follows its commands, or too late or too early; else nothing.

    Body axes being `axes` (3, 3). Where commanded axes were not measured, a low likeness of the
    others tells nothing.
    """
    score, lag = found.best(axes)
    if score < MIN_CORRELATION and found.unseen:
        return ""
    if score < MIN_CORRELATION:
        return (
            f"the motion hardly follows its commands (likeness {score:.2f}): another log, another "
            "vehicle, a tether that pulls?"
        )
    beyond = max(EARLIEST - lag, lag - LATEST)
    usual = (found.lag >= EARLIEST) & (found.lag <= LATEST)
    near = found.along(axes)[usual].max(initial=-1.0)
    if beyond <= 0.0 or (beyond > AWAY and score < near + CLEARER):
        return ""
    how = "after" if lag > 0 else "before"
    zone = QUARTER * round(lag / QUARTER)
    if zone and abs(lag - zone) < LOOSE:
        rest = f" first, and look at the {lag - zone:+.1f} s that remain" if lag != zone else ""
        told = f"a time zone? Add {zone:+.0f} s to the times of the commands{rest}"
    else:
        told = (
            f"add {lag:+.1f} s to the times of the commands. That holds the answer of the "
            "thrusters too, some 0.2 s: an `input_delay` that a diagnosis then finds, of either "
            "sign, is what is left of the clock; add it as well"
        )
        if abs(lag) < FITTED:
            told = f"let `input_delay` find it, or {told}"
    return (
        f"the motion comes {abs(lag):.2f} s {how} its commands (likeness {score:.2f}): the clocks "
        f"differ; {told}."
    )
