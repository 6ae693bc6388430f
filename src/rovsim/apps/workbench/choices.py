"""What is chosen on a screen: the controls that change it, and the address that says it."""

from typing import Any, Awaitable, Callable, Mapping, Sequence, TypeVar

from nicegui.elements.mixins.value_element import ValueElement

from rovsim.apps.workbench.place import Place
from rovsim.apps.workbench.traces import Span

Redraw = Callable[[], Awaitable[None]]
Control = TypeVar("Control", bound=ValueElement)
WHOLE: Span = (None, None)


class Choices:
    """What was chosen on a screen, by name; `redraw` shows it anew where a control changed it.

    `first` and `possible` are those of `Place.choose`. `span` is the part of the run that is shown:
    of a screen that `zooms`, the address says it, and another run is shown whole.
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
        self.span = (place.number("from"), place.number("to")) if zooms else WHOLE

    def __getitem__(self, name: str) -> Any:
        return self._chosen[name]

    def __setitem__(self, name: str, value: Any) -> None:
        self._chosen[name] = value

    def add(self, first: Mapping[str, Any], possible: Mapping[str, Sequence[Any]]) -> None:
        """Choices that are known only once others were made."""
        self._chosen = self.place.choose({**self._chosen, **first}, possible)

    def bind(
        self,
        name: str,
        control: Control,
        optional: bool = False,
        convert: Callable[[Any], Any] = lambda value: value,
        redraw: Redraw | None = None,
    ) -> Control:
        """Let a control show and change a choice; only an `optional` one may become empty.

        `redraw` takes the place of that of the screen.
        """
        control.value = self[name]
        control.classes("control").props("outlined dense options-dense")

        async def changed() -> None:
            if control.value or optional:
                self[name] = convert(control.value)
                self.span = WHOLE if name == "run" else self.span
                await (redraw or self.redraw)()

        control.on_value_change(changed)
        return control

    def put(self, name: str, value: Any) -> None:
        """Change a choice, and say so in the address."""
        self[name] = value
        self.tell()

    def zoom(self, span: Span) -> None:
        """Show a part of the run, and say so in the address."""
        self.span = span
        self.tell()

    def tell(self) -> None:
        """Let the address say what is shown."""
        self.place.tell({**self._chosen, "from": self.span[0], "to": self.span[1]})
