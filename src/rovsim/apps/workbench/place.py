"""What a screen shows stands in its address: a link opens it, reload and *back* keep it."""

from dataclasses import dataclass, field
from typing import Any, Mapping, Sequence
from urllib.parse import urlencode

from nicegui import ui
from starlette.datastructures import QueryParams


@dataclass(eq=False)
class Place:
    """A screen in one browser tab.

    `query` is what its address asks for; `kept` what this tab has chosen on each screen.
    """

    screen: str
    query: QueryParams = field(default_factory=QueryParams)
    kept: dict[str, dict[str, Any]] = field(default_factory=dict)
    _possible: dict[str, Sequence[Any]] = field(default_factory=dict)

    def choose(
        self, first: Mapping[str, Any], possible: Mapping[str, Sequence[Any]]
    ) -> dict[str, Any]:
        """What is shown: as the address asks, else as it was left, else `first`.

        `possible` values of each choice that an address may name; of lists, several. What cannot
        be had is passed over: an address may be of another day.
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
        """A number that the address gives, None if it gives none."""
        try:
            return float(self.query[name])
        except (KeyError, ValueError):
            return None

    def tell(self, chosen: Mapping[str, Any]) -> None:
        """Write what is shown into the address; None is left out where it says that nothing is."""
        pairs = {
            name: value
            for name, value in chosen.items()
            if value is not None or None in self._possible.get(name, ())
        }
        ui.navigate.history.replace(f"/{self.screen}?{urlencode(pairs, doseq=True)}")
