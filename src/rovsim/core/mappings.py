"""Flatten nested mappings to dotted names."""

from typing import Any, Mapping


def flattened(content: Mapping[str, Any], above: str = "") -> dict[str, Any]:
    """Values of a nested mapping by dotted name, with the sections themselves.

    Args:
        content: the mapping.
        above: put in front of every name.
    """
    values: dict[str, Any] = {}
    for key, value in content.items():
        values[f"{above}{key}"] = value
        if isinstance(value, Mapping):
            values |= flattened(value, f"{above}{key}.")
    return values


def leaves(content: Mapping[str, Any]) -> dict[str, Any]:
    """Values of a nested mapping by dotted name, without the sections unless they are empty."""
    values = flattened(content)
    return {name: v for name, v in values.items() if not isinstance(v, Mapping) or not v}
