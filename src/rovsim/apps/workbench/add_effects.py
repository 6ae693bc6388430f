"""The effects on the screen Add: a card for each, with a tick box and its values on sliders."""

from html import escape
from typing import Any, Awaitable, Callable

from nicegui import ui

from rovsim.apps.workbench.draft import Draft, reach
from rovsim.apps.workbench.parts import Failure, Slider, alarm, text
from rovsim.apps.workbench.workbench import Workbench
from rovsim.core.rounding import rounded
from rovsim.dynamics.parameter_labels import label_parameter
from rovsim.reporting.units import unit
from rovsim.reporting.wording import tell_probability
from rovsim.reporting.words.totals import tell_total

SLIDER_STEPS = 400
OFFERED_EFFECTS = 5  # effects that are offered without being asked for

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
            for name in offered[:OFFERED_EFFECTS] + [
                n for n in offered[OFFERED_EFFECTS:] if n in self.draft.ticked
            ]:
                self._card(name)
            rest = [name for name in self.bench.catalogue if name not in offered[:OFFERED_EFFECTS]]
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
                ParameterRow(self, name, units[parameter], value.value)

    async def move(self, effect: str, parameter: str, value: float) -> None:
        """Give a parameter of an effect another value."""
        self.touched = effect
        self.draft.move(effect, parameter, value)
        await self.moved()

    async def reset(self, effect: str, parameter: str) -> None:
        """Give a parameter of an effect the value back that it began with."""
        self.draft.reset(effect, parameter)
        self.draw()
        await self.moved()

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


class ParameterRow:
    """The value of a parameter on a slider and as a number, with the total that it makes.

    Args:
        effects: told of each change.
        effect: whose parameter it is.
        parameter: what the effect declares of it.
        value: that it has now.
    """

    def __init__(self, effects: Effects, effect: str, parameter: Any, value: float) -> None:
        self.effects, self.effect, self.parameter = effects, effect, parameter
        self.unit = unit(parameter.unit)
        names = effects.bench.base.vehicle.thruster_names
        label = label_parameter(effect, parameter.name, names).replace('"', "'")
        with ui.row().classes("slider"):
            ui.label(label).classes("name")
            self._draw(f"{effect}, {label}", value)

    def _draw(self, label: str, value: float) -> None:
        low, high = reach(self.parameter, value)
        step = 1.0 if self.parameter.discrete else (high - low) / SLIDER_STEPS
        self.slider = Slider(min=low, max=high, step=step, value=value)
        self.slider.props(f'aria-label="{label}"')
        self.number = ui.number(value=rounded(value, 3), suffix=self.unit).classes("value")
        self.number.props(f'dense borderless aria-label="{label}, number"')
        back = ui.button(icon="settings_backup_restore").classes("reset")
        about = f"{label}: back to where it began"
        back.props(f'flat dense aria-label="{about}" title="{about}"')
        self.total = ui.html(self._format_total(value), sanitize=False).classes("total")
        self.slider.on("update:model-value", self._moved, throttle=0.05)
        self.number.on("change", self._typed)
        back.on_click(lambda: self.effects.reset(self.effect, self.parameter.name))

    def _format_total(self, value: float) -> str:
        body = self.effects.bench.base.body
        total = tell_total(body, self.effect, self.parameter.name, value, self.unit)
        return f"{escape(total.text)} {alarm(total.wrong)}".strip()

    async def _moved(self, event: Any) -> None:
        self.number.set_value(rounded(event.args, 3))
        await self._change(float(event.args))

    async def _typed(self) -> None:
        if self.number.value is not None:
            self.slider.set_value(self.number.value)
            await self._change(float(self.number.value))

    async def _change(self, value: float) -> None:
        if value == self.effects.draft.entry(self.effect).parameters[self.parameter.name].value:
            return  # a key tells its value twice, and the throttle tells the last one again
        self.total.content = self._format_total(value)
        await self.effects.move(self.effect, self.parameter.name, value)


def tell_doubt(effect: str, draft: Draft) -> str:
    """Say that the diagnosis did not select an effect, and its probability; empty if it did."""
    if draft.diagnosis is None or effect in {fitted.effect for fitted in draft.chosen}:
        return ""
    probabilities = {fitted.effect: fitted.probability for fitted in draft.diagnosis.ranking}
    if probabilities.get(effect) is None:
        return "the diagnosis did not select it; it may fit noise"
    odds = tell_probability(probabilities[effect])
    return f"the diagnosis did not select it: probability {odds}, were it missing alone"
