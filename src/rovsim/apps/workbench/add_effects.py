"""The effects of the Add screen: a card each, its tick, and its values on sliders or typed."""

from typing import Any, Awaitable, Callable

from nicegui import ui

from rovsim.apps.workbench.draft import reach
from rovsim.apps.workbench.parts import Failure, Slider, text
from rovsim.apps.workbench.totals import tell_total
from rovsim.apps.workbench.workbench import Workbench
from rovsim.reporting.catalogue.entries import unit
from rovsim.reporting.wording import rounded

STEPS = 400  # of a slider
FIRST = 5  # effects that are offered without being asked for

Changed = Callable[[], Awaitable[None]]


class Effects:
    """What the diagnosis found, then whatever else was ticked.

    `ticked` is awaited after another choice of effects, `moved` after another value of one.
    """

    def __init__(self, bench: Workbench, ticked: Changed, moved: Changed) -> None:
        self.bench, self.draft = bench, bench.draft
        self.ticked, self.moved = ticked, moved
        self.touched = ""  # the effect that was changed last
        self.failure = Failure()  # where no card is to blame
        self.failures: dict[str, Failure] = {}  # by card
        self.list = ui.column().classes("area")
        self.draw()

    def draw(self) -> None:
        """All cards, anew."""
        self.list.clear()
        self.failures.clear()
        offered = list(dict.fromkeys([*self.draft.fitted, *self.draft.ticked]))
        with self.list:
            if unknown := self.draft.unknown:
                text(
                    f"The diagnosis also found {', '.join(unknown)}, which nobody knows here: open "
                    "the workbench with the effects_file=… it was made with.", "warning",
                )  # fmt: skip
            for name in offered[:FIRST] + [n for n in offered[FIRST:] if n in self.draft.ticked]:
                self._card(name)
            rest = [name for name in self.bench.catalogue if name not in offered[:FIRST]]
            more = ui.select(rest, label="Another effect", with_input=True).classes("control wide")
            more.props("outlined dense")
            more.on_value_change(lambda e: self._another(e.value))
            undo = ui.button("Undo", icon="undo", on_click=self._undo).props("flat dense no-caps")
            undo.bind_enabled_from(self.draft, "changed")

    def tell(self, error: Exception) -> None:
        """Say why no such model can be, on the card that was changed last."""
        self.forget()
        self.failures.get(self.touched, self.failure).tell(error)

    def forget(self) -> None:
        """Such a model can be."""
        for failure in (self.failure, *self.failures.values()):
            failure.forget()

    def _card(self, name: str) -> None:
        with ui.column().classes("card"):
            ticked = name in self.draft.ticked
            box = ui.checkbox(name, value=ticked)
            box.on_value_change(lambda e: self._tick(name, e.value))
            self.failures[name] = Failure()
            known = self.bench.catalogue[name]
            if ticked and self._unasked(name):
                text("Not among what the diagnosis found missing: it may fit noise.", "soft")
            if not ticked:
                text((known.__doc__ or "").split("\n")[0], "soft")
                return
            units = {p.name: p for p in known.parameters}
            for parameter, value in self.draft.entry(name).parameters.items():
                self._slider(name, units[parameter], value.value)

    def _unasked(self, name: str) -> bool:
        """Whether there is a diagnosis, and it did not select the effect."""
        return self.draft.diagnosis is not None and name not in {
            e.effect for e in self.draft.chosen
        }

    def _slider(self, effect: str, parameter: Any, value: float) -> None:
        low, high = reach(parameter, value)
        shown = unit(parameter.unit)
        with ui.row().classes("slider"):
            ui.label(parameter.name).classes("name")
            slider = Slider(min=low, max=high, step=(high - low) / STEPS, value=value)
            slider.props(f'aria-label="{effect}, {parameter.name}"')
            number = ui.number(value=rounded(value), suffix=shown).classes("value")
            number.props(f'dense borderless aria-label="{effect}, {parameter.name}, number"')
            back = ui.button(icon="settings_backup_restore").classes("reset")
            about = f"{effect}, {parameter.name}: back to where it began"
            back.props(f'flat dense aria-label="{about}" title="{about}"')
            total = ui.label(self._total(effect, parameter.name, value)).classes("total")

        async def change(now: float) -> None:
            if now == self.draft.entry(effect).parameters[parameter.name].value:
                return  # a key tells its value twice, and the throttle tells the last one again
            self.touched = effect
            total.text = self._total(effect, parameter.name, now)
            self.draft.move(effect, parameter.name, now)
            await self.moved()

        async def moved(event: Any) -> None:
            number.set_value(rounded(event.args))
            await change(float(event.args))

        async def typed() -> None:
            if number.value is not None:
                slider.set_value(number.value)
                await change(float(number.value))

        async def reset() -> None:
            self.draft.reset(effect, parameter.name)
            self.draw()
            await self.moved()

        slider.on("update:model-value", moved, throttle=0.05)
        number.on("change", typed)
        back.on_click(reset)

    def _total(self, effect: str, parameter: str, value: float) -> str:
        return tell_total(self.bench.base.body, effect, parameter, value)

    async def _tick(self, name: str, yes: bool) -> None:
        self.touched = name
        self.draft.tick(name, yes)
        self.draw()
        await self.ticked()

    async def _undo(self) -> None:
        self.draft.undo()
        self.draw()
        await self.ticked()

    async def _another(self, name: str | None) -> None:
        if name:
            await self._tick(name, True)
