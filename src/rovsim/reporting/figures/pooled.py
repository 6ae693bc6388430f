"""Pool the runs of a comparison: one error for each model and axis."""

from pandas import DataFrame, MultiIndex

from rovsim.core.axes import AXES
from rovsim.core.horizons import OPEN_LOOP, STANDARD_HORIZON
from rovsim.core.model_names import NOMINAL
from rovsim.reporting.wording import listed, title
from rovsim.results.comparison import Comparison


def tidy(comparison: Comparison, quantity: str, horizon: str, split: str) -> DataFrame:
    """Return one quantity at one horizon on the runs of a split, a row per model, run and axis."""
    rows = [
        (name, run, axis, value)
        for name, model in comparison.models.items()
        for run, errors in model.runs.items()
        if errors.split == split and (metrics := errors.at(horizon))
        for axis, value in zip(AXES, metrics.by_axis(quantity).array(), strict=True)
    ]
    return DataFrame(rows, columns=["model", "run", "axis", "value"])


def pool(
    comparison: Comparison, quantity: str, horizon: str = STANDARD_HORIZON, split: str = "test"
) -> DataFrame:
    """Return the mean error over the runs of a split, all with the same weight.

    A mean absolute error is averaged as it is, an RMSE is squared first. All models are compared on
    the same runs: a model without a value on a run where another has one gets NaN.

    Args:
        comparison: the errors of all models and runs.
        quantity: for instance "velocity_rmse".
        horizon: "open_loop", or the length of windows in s as in the file.
        split: "train" or "test".

    Returns:
        A row for each model, a column for each axis.
    """
    power = 2 if quantity.endswith("rmse") else 1
    models = list(comparison.models)
    table = tidy(comparison, quantity, horizon, split).pivot(
        index="run", columns=["model", "axis"], values="value"
    )
    table = table.reindex(columns=MultiIndex.from_product([models, AXES], names=["model", "axis"]))
    valid = table.notna().T.groupby("axis").any().T.reindex(columns=list(AXES), fill_value=False)
    runs = valid.sum().where(lambda n: n > 0)
    means = {
        name: (table[name].where(valid, 0.0) ** power).sum(skipna=False) / runs for name in models
    }
    return DataFrame(means, index=list(AXES)).T ** (1 / power)


def between_runs(
    comparison: Comparison, quantity: str, horizon: str = STANDARD_HORIZON, split: str = "test"
) -> tuple[DataFrame, DataFrame]:
    """Return the lowest and the highest value among the runs that `pool` averages.

    Each has a row for each model and a column for each axis; see `pool` for the arguments.
    """
    runs = tidy(comparison, quantity, horizon, split).groupby(["model", "axis"])["value"]
    shape = {"index": list(comparison.models), "columns": list(AXES)}
    return runs.min().unstack().reindex(**shape), runs.max().unstack().reindex(**shape)


def relate(errors: DataFrame, base: str = NOMINAL) -> DataFrame:
    """Divide the errors of all models by those of `base`; NaN where it has none."""
    reference = errors.reindex([base]).loc[base]
    return errors / reference.where(reference > 0)


def name_gaps(errors: DataFrame) -> str:
    """Say which models lack a value on some axis."""
    lacking = [title(model) for model in errors.index[errors.isna().any(axis=1)]]
    return f"No value on some axis or run: {listed(lacking)}." if len(lacking) else ""


def name_horizon(horizon: str) -> str:
    """Return a horizon as people say it."""
    return "open loop" if horizon == OPEN_LOOP else f"{horizon} s windows"
