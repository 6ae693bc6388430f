"""Definitions of message types: those of ROS, of mavros, and those that a bag contains."""

import re
from functools import cache
from typing import Any

from rovsim.core.errors import BadInput

# Bags of sqlite3 before ROS 2 Iron hold no definitions, and rosbags knows only those of ROS itself.
# Fields as in github.com/mavlink/mavros, mavros_msgs/msg (branch ros2).
MAVROS_MESSAGES = {
    "mavros_msgs/msg/RCIn": "std_msgs/Header header\nuint8 rssi\nuint16[] channels\n",
    "mavros_msgs/msg/RCOut": "std_msgs/Header header\nuint16[] channels\n",
    "mavros_msgs/msg/OverrideRCIn": "uint16[18] channels\n",
    "mavros_msgs/msg/ManualControl": (
        "std_msgs/Header header\nfloat32 x\nfloat32 y\nfloat32 z\nfloat32 r\nuint16 buttons\n"
    ),
}
TYPE_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*(/[A-Za-z][A-Za-z0-9_]*)+")
FIELD_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")


@cache
def _known_types() -> Any:
    """Types of ROS 2 Humble (with the same layouts as in later versions) and of mavros."""
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    for name, text in MAVROS_MESSAGES.items():
        store.register(get_types_from_msg(text, name))
    return store


def store_for(connection: Any, where: str) -> Any:
    """Find a type store of `rosbags` that knows the message type of a connection of a bag.

    Raises:
        BadInput: neither ROS nor mavros nor the bag defines the type.
    """
    defined = connection.msgdef.data
    if defined:
        return _defined(connection.msgtype, connection.msgdef.format.name, defined, where)
    if connection.msgtype not in _known_types().fielddefs:
        raise BadInput(
            f"messages of the type {connection.msgtype}, which the bag does not define",
            where=where,
            expected="a type of ROS 2 or mavros, or a bag that holds its definition",
            remedy="Record with MCAP or ROS 2 Iron or later, which store definitions, or republish "
            "it as a standard type.",
        )
    return _known_types()


@cache
def _defined(name: str, language: str, text: str, where: str) -> Any:
    from rosbags.typesys import Stores, get_types_from_idl, get_types_from_msg, get_typestore

    if language == "IDL":
        parts = re.split(r"^=+\nIDL: [^\n]*\n", text, flags=re.MULTILINE)
        types: dict = {}
        for part in parts:
            types |= get_types_from_idl(part) if part.strip() else {}
    else:
        types = dict(get_types_from_msg(text, name))
    store = get_typestore(Stores.EMPTY)
    # rosbags writes Python code from definitions: only plain names may get there, and no values
    store.register({_plain(t, where): ([], _fields(of, where)) for t, of in types.items()})
    return store


def _fields(definition: Any, where: str) -> list:
    for field, _ in definition[1]:
        if not FIELD_NAME.fullmatch(field):
            raise _refused(field, where)
    for described in _named_types(definition[1]):
        _plain(described, where)
    return list(definition[1])


def _named_types(fields: Any) -> list[str]:
    """List the types that fields refer to by name, also as elements of arrays."""
    from rosbags.interfaces import Nodetype

    names = []
    for _, (kind, of) in fields:
        inner = (kind, of) if kind in (Nodetype.BASE, Nodetype.NAME) else of[0]
        if inner[0] == Nodetype.NAME:
            names.append(inner[1])
    return names


def _plain(name: str, where: str) -> str:
    if not TYPE_NAME.fullmatch(name):
        raise _refused(name, where)
    return name


def _refused(name: str, where: str) -> BadInput:
    return BadInput(
        f"a definition with the name {name!r}",
        where=where,
        expected="letters, digits and underscores in the names of a message",
        remedy="Record the bag again; this definition is damaged.",
    )
