"""The choices on a screen, kept in step with its controls and with its address."""

from typing import Any, Awaitable, Callable, Mapping, Sequence, TypeVar

from nicegui.elements.mixins.value_element import ValueElement

from rovsim.apps.workbench.place import Place
from rovsim.apps.workbench.traces import Span

Redraw = Callable[[], Awaitable[None]]
Control = TypeVar("Control", bound=ValueElement)
WHOLE_RUN: Span = (None, None)


class Choices:
    """The present choices on a screen, by name.

    Args:
        place: the screen and its address.
        first: choices to begin with, see `Place.choose`.
        possible: values of each choice, see `Place.choose`.
        redraw: awaited after a control has changed a choice.
        zooms: whether the address also tells which part of the run is shown.

    Attributes:
        span: start and end of the part of the run that is shown, s; the whole after a change of
            run.
    """

    def __init__(
        self,
        place: Place,
        first: Mapping[str, Any],
        possible: Mapping[str, Sequence[Any]],
        redraw: Redraw,
        zooms: bool = False,
    ) -> None:
        self.place, self.redraw = place, redraw
        self._chosen = place.choose(first, possible)
        self.span = (place.number("from"), place.number("to")) if zooms else WHOLE_RUN

    def __getitem__(self, name: str) -> Any:
        return self._chosen[name]

    def __setitem__(self, name: str, value: Any) -> None:
        self._chosen[name] = value

    def add(self, first: Mapping[str, Any], possible: Mapping[str, Sequence[Any]]) -> None:
        """Add choices whose values depend on others, or replace them."""
        self._chosen = self.place.choose({**self._chosen, **first}, possible)

    def bind(
        self,
        name: str,
        control: Control,
        optional: bool = False,
        convert: Callable[[Any], Any] = lambda value: value,
        redraw: Redraw | None = None,
    ) -> Control:
        """Let a control show and change a choice.

        Args:
            name: of the choice.
            control: that shows it.
            optional: whether the choice may become empty.
            convert: from the value of the control to that of the choice.
            redraw: awaited after a change, in place of that of the screen.

        Returns:
            The control.
        """
        control.value = self[name]
        control.classes("control").props("outlined dense options-dense")

        async def changed() -> None:
            if control.value or optional:
                self[name] = convert(control.value)
                self.span = WHOLE_RUN if name == "run" else self.span
                await (redraw or self.redraw)()

        control.on_value_change(changed)
        return control

    def put(self, name: str, value: Any) -> None:
        """Change a choice, and write it into the address."""
        self[name] = value
        self.tell()

    def zoom(self, span: Span) -> None:
        """Remember which part of the run is shown, s, and write it into the address."""
        self.span = span
        self.tell()

    def tell(self) -> None:
        """Write all choices, and the part of the run, into the address."""
        self.place.tell({**self._chosen, "from": self.span[0], "to": self.span[1]})
