"""Flatten nested mappings to dotted names."""

from typing import Any, Mapping


def flattened(content: Mapping[str, Any], above: str = "") -> dict[str, Any]:
    """Values of a nested mapping by dotted name, with the sections themselves.

    Args:
        content: the mapping.
        above: put in front of every name.
    """
    found: dict[str, Any] = {}
    for key, value in content.items():
        found[f"{above}{key}"] = value
        if isinstance(value, Mapping):
            found |= flattened(value, f"{above}{key}.")
    return found


def leaves(content: Mapping[str, Any]) -> dict[str, Any]:
    """Values of a nested mapping by dotted name, without the sections unless they are empty."""
    found = flattened(content)
    return {name: v for name, v in found.items() if not isinstance(v, Mapping) or not v}
