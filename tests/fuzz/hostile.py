"""What strangers put into files: values, trees of YAML and JSON, arrays."""

import copy
import itertools
from functools import reduce
from typing import Any, Iterator

import numpy as np

DEPTH = 3000  # levels of nesting, more than a parser's stack holds
VALUES: tuple[Any, ...] = (
    None, True, False, 0, -1, 1, 10**9, 10**30, -(10**400), 0.5, -0.0, 1e-320, 1e308, -1e308,
    float("nan"), float("inf"), float("-inf"), "", " ", "nan", "1e400", "none", "null", "~",
    "../../../../etc/passwd", "/dev/zero", "/dev/stdin", "/proc/self/mem", "con", "a\nb", "a\x00b",
    "\u202e\u200b", "\ud7ff\U0010ffff", "x" * 100_000, "<script>alert(1)</script>",
    "${oc.env:HOME}",
    "${HOME}", "$HOME", "{run}", "%s%n", "!!python/object/apply:os.system [echo]", "2026-11-22",
    [], [[]], [None], [1, "a"], list(range(5000)), [[1.0] * 6] * 6, {}, {"": None},
    {"a": {"a": {}}},
    {1: 2}, {"__class__": "x"},
)  # fmt: skip
# Files that no tree yields: each is put in the place of one that was expected.
TEXTS = {
    "bomb": "a: &a [x,x,x,x,x,x,x,x,x]\n"
    + "".join(
        f"{b}: &{b} [{','.join([f'*{a}'] * 9)}]\n" for a, b in itertools.pairwise("abcdefghi")
    )
    + "name: *i\n",
    "cycle": "&a\nname: *a\nruns: [*a]\nvehicle: *a\n",
    "merge": "a: &a {b: 1}\n<<: [*a, *a]\n? [1, 2]\n: 3\n",
    "deep": "runs: " + "[" * DEPTH + "]" * DEPTH,
    "deep JSON": '{"selected": ' + "[" * 100_000 + "]" * 100_000 + "}",
    "documents": "a: 1\n---\nb: 2\n",
    "digits": "name: " + "9" * 100_000,
    "tag": "name: !!python/object/new:os.system ['true']\nvehicle: !x y\n",
    "anchor": "name: *missing\n",
    "tabs": "\tname:\t\tx\n",
    "NUL": "name: a\x00b\n",
    "line": "name: '" + "x" * 3_000_000 + "'",
    "nothing": "",
    "scalar": "42",
}


def places(tree: Any, above: tuple = ()) -> Iterator[tuple]:
    """Every place in a tree, the root first."""
    yield above
    if isinstance(tree, dict):
        for key in tree:
            yield from places(tree[key], (*above, key))
    elif isinstance(tree, list):
        for k, item in enumerate(tree):
            yield from places(item, (*above, k))


def _scaled(value: Any, random: np.random.Generator) -> Any:
    """A number of another size, sign or kind; anything else is replaced."""
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return value * float(random.choice([-1.0, 0.0, 1e-12, 0.3, 10.0, 1e6, 1e200]))
    return value_of(random)


def value_of(random: np.random.Generator) -> Any:
    """One of the hostile values."""
    return copy.deepcopy(VALUES[int(random.integers(len(VALUES)))])


def changed(tree: Any, random: np.random.Generator) -> Any:
    """The tree with one to three faults: values replaced, scaled, lost, doubled or renamed."""
    tree = copy.deepcopy(tree)
    for _ in range(random.integers(1, 4)):
        found = [place for place in places(tree) if place]
        if found:
            _spoil(tree, found[int(random.integers(len(found)))], random)
    return tree


def _spoil(tree: Any, place: tuple, random: np.random.Generator) -> None:
    *above, last = place
    holder = reduce(lambda node, key: node[key], above, tree)
    fault = int(random.integers(6))
    if fault < 2:
        holder[last] = value_of(random)
    elif fault == 2:
        holder[last] = _scaled(holder[last], random)
    elif fault == 3:
        del holder[last]
    elif isinstance(holder, list):
        holder.insert(int(last), copy.deepcopy(holder[last]))
    elif fault == 4:
        holder[f"{last}x"] = holder.pop(last)
    else:
        holder[last] = [holder[last], holder[last]]


def changed_array(array: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """The array with other values, another shape or type."""
    array = array.copy()
    fault = int(random.integers(8))
    if fault < 4 and array.size and array.dtype.kind == "f":
        # a header stands in front: half of the faults go there
        last = min(array.size, 12) if random.random() < 0.5 else array.size
        value = random.choice([np.nan, np.inf, -1.0, 0.0, 0.5, 3.0, 64.0, 1e9, 1e18, 1e300])
        array.flat[int(random.integers(last))] = value
        return array
    shapes = (array[:-1], np.tile(array, 2), array[None], array[:0])
    kinds = (array.astype("f4"), array.astype("c16"), array.astype("S8"), np.array(7.0))
    return (*shapes, *kinds)[int(random.integers(8))]
