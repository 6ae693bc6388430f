"""Choices on a screen, kept in its address: links open them, reload and *back* restore them."""

from dataclasses import dataclass, field
from typing import Any, Mapping, Sequence
from urllib.parse import urlencode

from nicegui import ui
from starlette.datastructures import QueryParams


@dataclass(eq=False)
class Place:
    """A screen in one browser tab.

    Attributes:
        screen: its name.
        query: choices that its address states.
        kept: last choices in this tab, by screen.
    """

    screen: str
    query: QueryParams = field(default_factory=QueryParams)
    kept: dict[str, dict[str, Any]] = field(default_factory=dict)
    _possible: dict[str, Sequence[Any]] = field(default_factory=dict)

    def choose(
        self, first: Mapping[str, Any], possible: Mapping[str, Sequence[Any]]
    ) -> dict[str, Any]:
        """Return the choices: those of the address, else the last ones in this tab, else `first`.

        Args:
            first: choices to begin with, by name; a list where several values may be chosen.
            possible: allowed values of each choice. Others are ignored: an address may be old.
        """
        chosen = {**first, **self.kept.get(self.screen, {})}
        self._possible |= possible
        for name, values in possible.items():
            is_list = isinstance(first[name], list)
            by_text = {str(value): value for value in values}
            requested = [by_text[text] for text in self.query.getlist(name) if text in by_text]
            previous = chosen[name] if is_list else [chosen[name]]
            valid = requested or [value for value in previous if value in by_text.values()]
            chosen[name] = valid if is_list else (valid or [first[name]])[0]
        self.kept[self.screen] = chosen
        return chosen

    def number(self, name: str) -> float | None:
        """Return a number that the address states; None if it states none."""
        try:
            return float(self.query[name])
        except (KeyError, ValueError):
            return None

    def tell(self, chosen: Mapping[str, Any]) -> None:
        """Write the choices into the address, without None where that is no possible value."""
        pairs = {
            name: value
            for name, value in chosen.items()
            if value is not None or None in self._possible.get(name, ())
        }
        ui.navigate.history.replace(f"/{self.screen}?{urlencode(pairs, doseq=True)}")
