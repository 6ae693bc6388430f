"""The end of the screen Add: save the draft as a file, and show its error on the test runs."""

import shlex
from pathlib import Path

from nicegui import ui

from rovsim.apps.workbench.divergence import find_divergence
from rovsim.apps.workbench.parts import (
    Failure,
    computed,
    in_a_terminal,
    onward,
    section,
    text,
    tile,
)
from rovsim.apps.workbench.workbench import Workbench
from rovsim.core.errors import RovsimError
from rovsim.core.horizons import STANDARD_WINDOW
from rovsim.dynamics.model import Model


class Saving:
    """A field for the model file, a button that saves, and the result."""

    def __init__(self, bench: Workbench) -> None:
        self.bench = bench
        section("Save it")
        self.path = ui.input("Model file", value=str(bench.free_path())).classes("control wide")
        self.path.props("outlined dense")
        save = ui.button("Save, and open the test runs", icon="save", on_click=self._save)
        save.props("unelevated no-caps").classes("onward")
        save.bind_enabled_from(bench.draft, "ticked", backward=bool)
        hint = ui.label(f"Nothing was added to {bench.base.name} yet.").classes("soft")
        hint.bind_visibility_from(bench.draft, "ticked", backward=lambda names: not names)
        self.failure = Failure()
        self.result = ui.column().classes("area")

    async def _save(self) -> None:
        """Write the model file, and show the model's error on the test runs."""
        path = Path(self.path.value.strip())
        try:
            model = await computed(self.bench.save, path)
        except RovsimError as error:
            self.failure.tell(error)
            return
        self.failure.forget()
        before = (await computed(self.bench.replays.step, self.bench.base)).windows_2s
        after = (await computed(self.bench.replays.step, model)).windows_2s
        diverges = await computed(self._is_lost, model)
        openings = await computed(self.bench.note_opening, model)
        self.path.value = str(self.bench.free_path())
        self._tell(path, before, after, diverges, openings)

    def _is_lost(self, model: Model) -> bool:
        """Whether a replay of a test run diverges (2 s windows)."""
        replays, motions = self.bench.replays, self.bench.data.motions
        return any(
            find_divergence(motions[run].time, replays.prediction(model, run, STANDARD_WINDOW))
            is not None
            for run in self.bench.data.runs.of("test")
        )

    def _tell(
        self, path: Path, before: float | None, after: float | None, lost: bool, opened: int
    ) -> None:
        diagnosis = self.bench.diagnosis
        floor = diagnosis.error.noise_floor if diagnosis else None
        self.result.clear()
        with self.result:
            with ui.row().classes("tiles"):
                tile("Error before", before, "saved/before", "test runs")
                tile("Error now", after, "saved/after", "test runs")
                if floor is not None:
                    tile("Noise floor", floor, "saved/noise_floor", "of a perfect model, about")
            text(_sentence(before, after, lost))
            text(_say_openings(opened), "soft")
            words = (f"campaign={self.bench.settings.campaign}", f"model=[nominal,{path}]")
            in_a_terminal(f"rovsim compare {shlex.join(words)} out=COMPARED")
            onward("See the whole ladder", "/ladder")


def _sentence(before: float | None, after: float | None, lost: bool) -> str:
    if lost:
        return "Saved. On the test runs its replay diverges, so it has no error."
    if before is None or after is None:
        return "Saved. There is no test run to measure it on."
    if after < before:
        return f"Saved. On the test runs the error fell by {100 * (1 - after / before):.0f} %."
    return "Saved. On the test runs the error did not fall."


def _say_openings(opened: int) -> str:
    """Say for how many models the test runs were opened, and why that matters."""
    if opened == 1:
        return "The test runs were opened for one saved model: this one."
    return (
        f"The test runs were opened for {opened} saved models. Whoever chooses among these by the "
        "test runs has fitted to them: the error on new runs will be larger."
    )
