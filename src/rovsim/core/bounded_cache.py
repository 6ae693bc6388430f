"""Caches of bounded size, for more values than memory holds: dropped ones are made again."""

from collections import OrderedDict
from dataclasses import fields, is_dataclass
from pathlib import Path
from threading import Lock
from typing import (
    Callable,
    Generic,
    Hashable,
    Iterable,
    Iterator,
    Mapping,
    Sequence,
    TypeVar,
    overload,
)

import numpy as np

T = TypeVar("T")
MAX_BYTES = 1 << 27  # fifteen runs of 5 min at 100 Hz


class Recent(Generic[T]):
    """Keeps the most recently used values, up to `most` bytes of arrays.

    The very last value is kept however large it is; with `most` 0 nothing is kept.
    """

    def __init__(self, most: int = MAX_BYTES) -> None:
        self._most, self._size = most, 0
        self._kept: OrderedDict[Hashable, tuple[T, int]] = OrderedDict()
        self._lock = Lock()  # several threads may ask
        self._making: dict[Hashable, Lock] = {}

    def get(self, key: Hashable, make: Callable[[], T]) -> T:
        """Return the value of a key, and make it if it is not kept.

        Values of different keys may be made at the same time.
        """
        with self._lock:
            if key in self._kept:
                return self._use(key)
            making = self._making.setdefault(key, Lock())
        with making:
            with self._lock:
                if key in self._kept:  # another thread made it meanwhile
                    return self._use(key)
            value = make()
            self.keep(key, value)
        with self._lock:
            self._making.pop(key, None)
        return value

    def _use(self, key: Hashable) -> T:
        self._kept.move_to_end(key)
        return self._kept[key][0]

    def keep(self, key: Hashable, value: T) -> None:
        """Keep a value, and drop the least recently used ones if there are too many bytes."""
        if not self._most:
            return
        with self._lock:
            _, old_size = self._kept.pop(key, (None, 0))
            self._kept[key] = value, size(value)
            self._size += self._kept[key][1] - old_size
            while len(self._kept) > 1 and self._size > self._most:
                self._size -= self._kept.popitem(last=False)[1][1]


class Remade(Mapping[str, T]):
    """Mapping of values by name; the most recently used are kept, the others are made again.

    Args:
        names: names of the values, in order.
        make: makes a value from its name, every time the same.
        most: bytes to keep.
        recent: the cache to use, if other values share its bytes.
    """

    def __init__(
        self,
        names: Iterable[str],
        make: Callable[[str], T],
        most: int = MAX_BYTES,
        recent: Recent[T] | None = None,
    ) -> None:
        self._names, self._make = dict.fromkeys(names), make
        self._recent: Recent[T] = recent or Recent(most)
        self._own = object()  # keeps these values apart from others of the same names in a cache

    def __getitem__(self, name: str) -> T:
        if name not in self._names:
            raise KeyError(name)
        return self._recent.get((self._own, name), lambda: self._make(name))

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def __contains__(self, name: object) -> bool:
        return name in self._names

    def keep(self, name: str, value: T) -> None:
        """Add a value that is already made."""
        self._names[name] = None
        self._recent.keep((self._own, name), value)


class ReadAgain(Sequence[T]):
    """Sequence of values in files, each read whenever it is used."""

    def __init__(self, paths: Sequence[Path], read: Callable[[Path], T]) -> None:
        self._paths, self._read = paths, read

    @overload
    def __getitem__(self, index: int) -> T: ...
    @overload
    def __getitem__(self, index: slice) -> "ReadAgain[T]": ...
    def __getitem__(self, index: int | slice) -> "T | ReadAgain[T]":
        if isinstance(index, slice):
            return ReadAgain(self._paths[index], self._read)
        return self._read(self._paths[index])

    def __len__(self) -> int:
        return len(self._paths)


def read_again(paths: Mapping[str, Path], read: Callable[[Path], T]) -> Remade[T]:
    """Make a mapping of values in files, each read whenever it is used."""
    return Remade(paths, lambda name: read(paths[name]), most=0)


def size(value: object) -> int:
    """Bytes of the arrays in a value: in mappings, tuples and dataclasses, at any depth."""
    if isinstance(value, np.ndarray):
        return value.nbytes
    if isinstance(value, Mapping):
        return sum(map(size, value.values()))
    if isinstance(value, tuple):
        return sum(map(size, value))
    if is_dataclass(value):
        return sum(size(getattr(value, field.name)) for field in fields(value))
    return 0
