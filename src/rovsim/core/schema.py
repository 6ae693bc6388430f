"""Typed sections read from YAML: an unknown key is an error that names the nearest known one."""

import os
import re
import reprlib
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, TypeVar

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, Strict, ValidationError

from rovsim.core.errors import BadInput, closest, unlisted


class Section(BaseModel):
    """A section of a file or of the configuration: typed, immutable, without unknown keys.

    Attributes:
        described: the page of the documentation that shows an example.
    """

    described: ClassVar[str] = "docs/formats.md"

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


def _path(text: str) -> str:
    """Refuse paths that are invalid on any file system; using one would fail in various ways."""
    too_long = len(text) > 4000 or any(len(os.fsencode(p)) > 255 for p in text.split("/"))
    if too_long or "\x00" in text:
        raise ValueError("a path that a file system can name")
    return text


Axis = Literal["surge", "sway", "heave", "roll", "pitch", "yaw"]
PathText = Annotated[str, AfterValidator(_path)]
# A number that is written as one: true and '1.5' are refused.
Number = Annotated[float, Strict(), Field(allow_inf_nan=False)]

S = TypeVar("S", bound=Section)

# What pydantic expected, by its type of error, in words for a reader who does not know Python.
EXPECTED_WORDS = {
    **dict.fromkeys(("list_type", "tuple_type"), "a list, as [first, second]"),
    **dict.fromkeys(("float_type", "float_parsing"), "a number"),
    **dict.fromkeys(("int_type", "int_parsing", "int_from_float"), "a whole number"),
    **dict.fromkeys(("bool_type", "bool_parsing"), "true or false"),
    "finite_number": "a finite number",
    "string_type": "text (a number in quotes is one)",
}
BOUND_WORDS = ("greater than ", "less than ")


def checked(kind: type[S], content: Any, where: Path | str) -> S:
    """Build a section from plain values.

    Raises:
        BadInput: names the file, the place in it, what was found there and the remedy.
    """
    if not isinstance(content, dict):
        raise BadInput(
            f"holds {type(content).__name__} instead of keys and values",
            where=where,
            expected=f"the keys {', '.join(_names(kind))}",
            remedy=f"See {kind.described} for an example.",
        )
    try:
        return kind.model_validate(content)
    except ValidationError as error:
        raise _explained(error, kind, where) from None
    except OverflowError:
        raise BadInput(
            "holds a number with hundreds of digits",
            where=where,
            expected="numbers below 1e308",
            remedy="Correct that number.",
        ) from None


def _explained(error: ValidationError, kind: type[Section], where: Any) -> BadInput:
    """Turn pydantic's errors into one message about the first of them."""
    errors = error.errors(include_url=False)
    # A mistyped key gives two errors, unknown and missing; the unknown key tells what was meant.
    first = next((e for e in errors if e["type"] == "extra_forbidden"), errors[0])
    name = ".".join(str(part) for part in first["loc"] if not _is_type(part))
    if first["type"] == "extra_forbidden":
        key = str(first["loc"][-1])
        keys = _known_keys(kind, first["loc"][:-1])
        return unlisted(key, keys, found=f"unknown key '{name}'", where=where)
    if first["type"] == "missing" and isinstance(first["loc"][-1], int):
        return _too_few(errors, first, name, where)
    if first["type"] == "missing":
        return BadInput(
            f"'{name}' is missing",
            where=where,
            expected=f"a value for '{name}'",
            remedy=f"Add it; {kind.described} has an example.",
        )
    return BadInput(
        f"'{name}' is {reprlib.repr(first.get('input'))}",
        where=where,
        expected=_expected(first, kind),
        remedy=_remedy(first),
    )


def _too_few(errors: list[Any], first: Any, place: str, where: Any) -> BadInput:
    """Make the error for a row of numbers that is too short."""
    row = first["loc"][:-1]
    missing = [e for e in errors if e["type"] == "missing" and e["loc"][:-1] == row]
    return BadInput(
        f"'{place.rpartition('.')[0]}' is {reprlib.repr(first.get('input'))}",
        where=where,
        expected=f"{first['loc'][-1] + len(missing)} values",
        remedy="Add what is missing.",
    )


def _is_type(part: int | str) -> bool:
    """Whether a part of pydantic's location names a type of a union, which is not in the file."""
    return isinstance(part, str) and (part == "str" or "[" in part)


def _expected(error: Any, kind: type[Section]) -> str:
    """Say what was expected in the place of an error."""
    if error["type"] in ("model_type", "model_attributes_type", "dict_type"):
        keys = _known_keys(kind, error["loc"])
        return f"keys and values ({', '.join(keys)})" if keys else "keys and values"
    limits = error.get("ctx", {})
    if error["type"] == "too_short":
        return _several(limits["min_length"], "at least")
    if error["type"] == "too_long":
        return _several(limits["max_length"], "at most")
    text = _sentence(error["msg"])
    return EXPECTED_WORDS.get(
        error["type"], f"a number {text}" if text.startswith(BOUND_WORDS) else text
    )


def _several(count: int, bound: str) -> str:
    return f"{bound} {count} value{'' if count == 1 else 's'}"


def _remedy(error: Any) -> str:
    """Suggest the option that was probably meant, if the value must be one of several."""
    value = error.get("input")
    if error["type"] != "literal_error" or not isinstance(value, str):
        return "Correct that value."
    options = re.findall(r"'([^']*)'", error["msg"])
    text = value.casefold()
    matches = [o for o in options if text and (text.startswith(o) or o.startswith(text))]
    if len(matches) == 1:
        return f"Did you mean '{matches[0]}'?"
    return closest(text, options) or "Correct that value."


def _sentence(message: str) -> str:
    for prefix in ("Value error, ", "Input should be "):
        message = message.removeprefix(prefix)
    return message.rstrip(".")


def _known_keys(kind: type[BaseModel], place: tuple[Any, ...]) -> list[str]:
    """List the keys of the section at `place` inside the section `kind`.

    Args:
        kind: the outermost section.
        place: pydantic's location: keys, indices of list items, and the `kind` of union members.
    """
    choices = [kind]
    for part in place:
        tagged = [c for c in choices if _tag(c) == part]
        fields = [c.model_fields[part].annotation for c in choices if part in c.model_fields]
        inner = [section for field in fields for section in _sections_in(field)]
        choices = tagged or inner or choices
    return list(dict.fromkeys(name for choice in choices for name in _names(choice)))


def _names(kind: type[BaseModel]) -> list[str]:
    """List the keys of a section as they are written in the file."""
    return [field.alias or name for name, field in kind.model_fields.items()]


def _tag(kind: type[BaseModel]) -> Any:
    return kind.model_fields["kind"].default if "kind" in kind.model_fields else None


def _sections_in(annotation: Any) -> list[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    inner = getattr(annotation, "__args__", ())
    return [section for argument in inner for section in _sections_in(argument)]
