"""Commands that draw little, for tests of numbers; test_cli and the study draw all."""

import pytest

COMMANDS = "rovsim.apps.cli.commands"


def draw_few(patch: pytest.MonkeyPatch) -> None:
    """Let `compare` and `diagnose` draw one figure of each kind, in this process."""
    patch.setattr(f"{COMMANDS}.compare.ONCE", ("excitation",))
    patch.setattr(f"{COMMANDS}.compare.PER_RUN", ("velocities",))
    patch.setattr(f"{COMMANDS}.diagnose.EARLY", [])
    patch.setattr("rovsim.application.pipeline.shown_diagnosis.FIGURES", ("ranking",))
    patch.setattr("rovsim.core.second_process.usable_cores", lambda: 1)
