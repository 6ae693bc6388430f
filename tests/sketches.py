"""Commands that draw little, for tests of numbers; test_cli and the study draw all."""

import pytest

from rovsim.reporting.figures import find_figure

REPORTING = "rovsim.reporting"


def few(data) -> list[str]:
    """One figure of a diagnosis, one of a comparison."""
    if data.diagnosis is not None:
        return ["ranking"]
    return ["excitation"] if data.comparison is not None else []


def draw_few(patch: pytest.MonkeyPatch) -> None:
    """Let `compare` and `diagnose` draw one figure of each kind, in this process."""
    patch.setattr(f"{REPORTING}.report_data.ReportData.figures", property(few))
    patch.setattr(f"{REPORTING}.html.folder.list_run_figures", lambda: [find_figure("velocities")])
    patch.setattr("rovsim.core.second_process.usable_cores", lambda: 1)
