"""Fitted values of an effect, as `diagnosis.json` lists them."""

from typing import Mapping

from rovsim.core.rounding import rounded_or_none
from rovsim.estimation.observer.hypothesis import Term
from rovsim.results.fitted import FittedValue


def describe_values(term: Term, std: Mapping[str, float]) -> dict[str, FittedValue]:
    """List the fitted parameters of an effect, and any others that differ from their defaults.

    Args:
        term: the effect at its fitted values.
        std: standard deviations of the fitted parameters, by name, in their units.

    Returns:
        Values by the names of the parameters.
    """
    values = term.effect.given()
    units = {p.name: p.unit for p in term.effect.parameters}
    names = [p.name for p in term.effect.parameters if p.name in values or p.name in std]
    return {
        name: FittedValue(
            value=rounded_or_none(term.effect[name]),
            unit=units[name],
            **({"std": rounded_or_none(std[name])} if name in std else {}),
        )
        for name in names
    }
