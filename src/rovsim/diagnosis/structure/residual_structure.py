"""Test whether what the best model leaves still depends on something.

Unknown forces are tried on each axis: functions of state, place and time, periodic forces (of
constant amplitude, or growing with the speed squared), sudden pushes and single kicks. The filter
of the axis says how each would show in the innovations. A force that explains more than chance
allows, and enough to matter, is physics that the catalogue does not have.
"""

from rovsim.diagnosis.structure.regressors import find_dependence, tabulate
from rovsim.diagnosis.structure.residual import Structure, split_by_axis
from rovsim.diagnosis.structure.spectral_lines import find_lines
from rovsim.diagnosis.structure.sudden_pushes import find_kicks, find_sudden
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.filter_bank import FilterBank


def find_structure(fit: Fit, bank: FilterBank) -> list[Structure]:
    """Find structures beyond chance in the innovations of a fit, the most surprising first.

    Args:
        fit: whose innovations are tested.
        bank: filters of the runs that it was fitted to.
    """
    tables = [tabulate(run) for run in bank.runs]
    structures: list[Structure] = []
    for residual in split_by_axis(fit, bank):
        structures += find_dependence(residual, tables)
        structures += find_lines(residual)
        structures += find_sudden(residual)
        structures += find_kicks(residual)
    return sorted(structures, key=lambda one: -one.times_limit)
