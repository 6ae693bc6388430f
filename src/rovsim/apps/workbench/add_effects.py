"""The effects on the screen Add: a card for each, with a tick box and its values on sliders."""

from html import escape
from typing import Any, Awaitable, Callable

from nicegui import ui

from rovsim.apps.workbench.draft import Draft, reach
from rovsim.apps.workbench.parts import Failure, Slider, alarm, text
from rovsim.apps.workbench.workbench import Workbench
from rovsim.dynamics.effects.thrusters import name_parameter
from rovsim.reporting.units import unit
from rovsim.reporting.wording import rounded, tell_probability
from rovsim.reporting.words.totals import tell_total

STEPS = 400  # of a slider
FIRST = 5  # effects that are offered without being asked for

Changed = Callable[[], Awaitable[None]]


class Effects:
    """Cards of the effects that the diagnosis fitted, then of all others that were ticked.

    Args:
        bench: the open campaign with its draft.
        ticked: awaited after effects were added or left out.
        moved: awaited after a value of an effect was changed.
    """

    def __init__(self, bench: Workbench, ticked: Changed, moved: Changed) -> None:
        self.bench, self.draft = bench, bench.draft
        self.ticked, self.moved = ticked, moved
        self.touched = ""  # the effect that was changed last
        self.failure = Failure()  # shown where no card is to blame
        self.failures: dict[str, Failure] = {}  # by card
        self.list = ui.column().classes("area")
        self.draw()

    def draw(self) -> None:
        """Draw all cards anew."""
        self.list.clear()
        self.failures.clear()
        offered = list(dict.fromkeys([*self.draft.fitted, *self.draft.ticked]))
        with self.list:
            if self.draft.diagnosis is None:
                text("No diagnosis has said yet what is missing.", "soft")
                ui.link("Why: find what is missing, with its values", "/why")
            if unknown := self.draft.unknown:
                text(
                    f"The diagnosis also found {', '.join(unknown)}, which nobody knows here: open "
                    "the workbench with the effects_file=… it was made with.",
                    "warning",
                )
            for name in offered[:FIRST] + [n for n in offered[FIRST:] if n in self.draft.ticked]:
                self._card(name)
            rest = [name for name in self.bench.catalogue if name not in offered[:FIRST]]
            select = ui.select(rest, label="Another effect", with_input=True).classes(
                "control wide"
            )
            select.props("outlined dense")
            select.on_value_change(lambda e: self._another(e.value))
            undo = ui.button("Undo", icon="undo", on_click=self._undo).props("flat dense no-caps")
            undo.bind_enabled_from(self.draft, "changed")

    def tell(self, error: Exception) -> None:
        """Show on the card that was changed last why no model can be built."""
        self.forget()
        self.failures.get(self.touched, self.failure).tell(error)

    def forget(self) -> None:
        """Remove all messages: a model can be built again."""
        for failure in (self.failure, *self.failures.values()):
            failure.forget()

    def _card(self, name: str) -> None:
        with ui.column().classes("card"):
            ticked = name in self.draft.ticked
            checkbox = ui.checkbox(name, value=ticked)
            checkbox.on_value_change(lambda e: self._tick(name, e.value))
            self.failures[name] = Failure()
            cls = self.bench.catalogue[name]
            if ticked and (doubt := tell_doubt(name, self.draft)):
                ui.html(alarm(doubt), sanitize=False).classes("text")
            if not ticked:
                text((cls.__doc__ or "").split("\n")[0], "soft")
                return
            units = {p.name: p for p in cls.parameters}
            for parameter, value in self.draft.entry(name).parameters.items():
                self._slider(name, units[parameter], value.value)

    def _slider(self, effect: str, parameter: Any, value: float) -> None:
        low, high = reach(parameter, value)
        unit_text = unit(parameter.unit)
        names = self.bench.base.vehicle.thruster_names
        label = name_parameter(effect, parameter.name, names).replace('"', "'")

        def told(now: float) -> str:
            total = tell_total(self.bench.base.body, effect, parameter.name, now, unit_text)
            return f"{escape(total.told)} {alarm(total.wrong)}".strip()

        with ui.row().classes("slider"):
            ui.label(label).classes("name")
            step = 1.0 if parameter.discrete else (high - low) / STEPS
            slider = Slider(min=low, max=high, step=step, value=value)
            slider.props(f'aria-label="{effect}, {label}"')
            number = ui.number(value=rounded(value), suffix=unit_text).classes("value")
            number.props(f'dense borderless aria-label="{effect}, {label}, number"')
            back = ui.button(icon="settings_backup_restore").classes("reset")
            about = f"{effect}, {label}: back to where it began"
            back.props(f'flat dense aria-label="{about}" title="{about}"')
            total = ui.html(told(value), sanitize=False).classes("total")

        async def change(now: float) -> None:
            if now == self.draft.entry(effect).parameters[parameter.name].value:
                return  # a key tells its value twice, and the throttle tells the last one again
            self.touched = effect
            total.content = told(now)
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


def tell_doubt(effect: str, draft: Draft) -> str:
    """Say that the diagnosis did not select an effect, and its probability; empty if it did."""
    if draft.diagnosis is None or effect in {fitted.effect for fitted in draft.chosen}:
        return ""
    probabilities = {fitted.effect: fitted.probability for fitted in draft.diagnosis.ranking}
    if probabilities.get(effect) is None:
        return "the diagnosis did not select it; it may fit noise"
    odds = tell_probability(probabilities[effect])
    return f"the diagnosis did not select it: probability {odds}, were it missing alone"
