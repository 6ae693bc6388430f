"""Write the tables of a study from files that its steps wrote."""

from pathlib import Path

from rovsim.reporting.tables import tabulate_errors, tabulate_ladder
from rovsim.results.comparison import Comparison
from rovsim.results.ladder import Ladder

TABLE_QUANTITIES = ("velocity_rmse", "velocity_mae", "acceleration_rmse")


def write_tables(comparison: Path, ladder: Path, folder: Path) -> None:
    """Write the ladder and the errors on the test runs into a folder, as LaTeX and CSV."""
    tabulate_ladder(Ladder.read(ladder)).write(folder, "ladder")
    for quantity in TABLE_QUANTITIES:
        table = tabulate_errors(Comparison.read(comparison), quantity=quantity)
        table.write(folder, quantity)
