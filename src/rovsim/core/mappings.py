"""Nested mappings by dotted name."""

from typing import Any, Mapping


def flattened(content: Mapping[str, Any], above: str = "") -> dict[str, Any]:
    """Nested values by dotted name, sections included."""
    found: dict[str, Any] = {}
    for key, value in content.items():
        found[f"{above}{key}"] = value
        if isinstance(value, Mapping):
            found |= flattened(value, f"{above}{key}.")
    return found


def leaves(content: Mapping[str, Any]) -> dict[str, Any]:
    """Nested values by dotted name, without the sections themselves."""
    found = flattened(content)
    return {name: v for name, v in found.items() if not isinstance(v, Mapping) or not v}
