"""Write names and numbers as people do."""

import math
import re
from typing import TYPE_CHECKING, Iterable, Mapping, Sequence

from rovsim.core.model_names import (
    EFFECTS,
    NOISE_FLOOR,
    NOMINAL,
    PROPOSED,
    REFITTED,
    ZERO_ACCELERATION,
)
from rovsim.core.rounding import rounded
from rovsim.core.signs import minus

if TYPE_CHECKING:
    from rovsim.learning.learner import Learner

MAX_NAME_LETTERS = 40  # of a name before its middle is left out
# The study's own models; a user's keep the name of their file.
TITLES = {
    ZERO_ACCELERATION: "constant velocity",
    REFITTED: "nominal, refitted",
    EFFECTS: "nominal + effects",
    NOISE_FLOOR: "noise floor",
}
MEANINGS = {
    ZERO_ACCELERATION: "a vehicle that keeps its velocity; no model should be worse",
    NOMINAL: "the vehicle file as it is",
    REFITTED: "nominal; drag, added mass, buoyancy and gain of thrust fitted to the train runs",
    EFFECTS: "nominal, and the effects that the diagnosis selected",
    NOISE_FLOOR: "what a perfect model would show, because the measurement is noisy",
}
CONTROL_TITLES = {"3dof": "3-DoF", "6dof": "6-DoF", "all": "all runs"}
LADDER_STEP = re.compile(r"\+(\w+)")  # of a diagnosis' ladder
# The one error by which models are ranked (`windows_2s` in files), wherever it is shown.
ERROR_NAME = "2 s error"
ERROR_MEANING = (
    "The 2 s error is the RMSE of the predicted velocity, the model restarted from the measured "
    "state every 2 s, in standard deviations of the measured velocity, averaged over the axes "
    "that moved"
)
LADDER_NOTE = "Rows stand side by side; only a row that begins with + builds on the row above it."
FLOOR_COUNTS_ALL = (
    "The noise floor, {}, counts what is unexplained as noise: a model that knew it could be below."
)
MIN_SHOWN_SHARE = 0.01  # share of the error below which an effect by itself is not shown
# a probability below this, or as near to one, is told as no more than that
MIN_TOLD_PROBABILITY = 0.001
MAX_LISTED_NAMES = 8  # a line of run ids


def list_learners() -> Mapping[str, "Learner"]:
    """Return every learner by kind, with its title and meaning."""
    from rovsim.learning.learner import learners  # imports Numba, which most sentences need not

    return learners()


def _learned() -> re.Pattern[str]:
    """Return the pattern of names of the study's models with a residual: BASE+KIND_CONTROL."""
    return re.compile(rf"(?:(.*)\+)?({'|'.join(list_learners())})_({'|'.join(CONTROL_TITLES)})")


def short(name: str, length: int = MAX_NAME_LETTERS) -> str:
    """Return `name`, its middle left out where it is longer than `length` letters."""
    if len(name) <= length:
        return name
    return f"{name[: length // 2]}…{name[-(length // 2 - 1) :]}"


def title(model: str, length: int = MAX_NAME_LETTERS) -> str:
    """Return a model's name as people say it: `effects+knn_6dof` is "effects + KNN (6-DoF)"."""
    if learned := _learned().fullmatch(model):
        base, kind, control = learned.groups()
        learner = f"{list_learners()[kind].title} ({CONTROL_TITLES[control]})"
        return short(f"{base} + {learner}" if base else learner, length)
    if effect := LADDER_STEP.fullmatch(model):
        return short(f"+ {effect[1]}", length)
    return short(TITLES.get(model, model), length)


def explain_model(model: str) -> str:
    """Say what a model of the study is; empty for a model that its user made."""
    if learned := _learned().fullmatch(model):
        base, kind, control = learned.groups()
        condition = "" if control == "all" else f" under {CONTROL_TITLES[control]} control"
        meaning = list_learners()[kind].meaning
        return (
            f"{title(base or 'nominal')}, and {meaning} that learned the rest of the acceleration "
            f"from the train runs{condition}"
        )
    if model == f"+{PROPOSED}":
        return "the proposed equation, and the effects that act beside it"
    if LADDER_STEP.fullmatch(model):
        return "the step above, and this effect"
    return MEANINGS.get(model, "")


def percent(share: float | None) -> str:
    """Return a share as a whole number of percent."""
    return "an unknown share" if share is None else f"{100 * share:.0f}\u202f%"


def several(names: Sequence[str]) -> str:
    """Return names as text; of very many the first few, and how many more there are."""
    if len(names) <= MAX_LISTED_NAMES + 1:
        return ", ".join(names)
    return f"{', '.join(names[:MAX_LISTED_NAMES])} and {len(names) - MAX_LISTED_NAMES} more"


def listed(names: Iterable[str]) -> str:
    """Return names or phrases as people list them: a, b and c. Long names: `short` them first."""
    *first, last = [*names] or [""]
    return f"{', '.join(first)} and {last}" if first else last


def fit(error: float) -> float:
    """Convert an error in standard deviations to the NRMSE fit of system identification, %."""
    return 100.0 * (1.0 - error)


def number_or_dash(value: float | None) -> str:
    """Return a number as `significant` writes it, and a dash for None."""
    return "–" if value is None else significant(value)


def tell_probability(probability: float | None) -> str:
    """Return a probability to three decimals; near 0 or 1 as "below 0.001" or "above 0.999"."""
    if probability is None:
        return "–"
    if probability < MIN_TOLD_PROBABILITY:
        return f"below {MIN_TOLD_PROBABILITY:g}"
    certain = 1 - MIN_TOLD_PROBABILITY
    return f"above {certain:g}" if probability > certain else f"{probability:.3f}"


def significant(value: float, digits: int = 3) -> str:
    """Return `value` to so many significant figures, without an exponent where it is readable."""
    if not math.isfinite(value):
        return "–"
    if value == 0:
        return "0"
    if not 1e-4 <= abs(value) < 1e6:
        return minus(f"{value:.{digits - 1}e}")
    places = digits - 1 - math.floor(math.log10(abs(rounded(value, digits))))
    return minus(f"{round(value, places):.{max(places, 0)}f}")
