"""Runs the MATLAB that `rovsim export to=mss` writes: matrices, functions, if and else; no more."""

import re

import numpy as np


class Matrix:
    """A matrix of MATLAB: counted from 1, `*` multiplies matrices, `@` stands for `.*`."""

    def __init__(self, values):
        self.a = np.atleast_2d(np.asarray(values, dtype=float))

    def __call__(self, *at):
        rows, columns = self._at(at)
        found = self.a[np.ix_(rows, columns)]
        return float(found[0, 0]) if all(np.isscalar(one) for one in at) else Matrix(found)

    def put(self, at, value):
        rows, columns = self._at(at)
        self.a[np.ix_(rows, columns)] = plain(value)
        return self

    def _at(self, at):
        if len(at) == 1:  # of a vector
            (k,) = at
            return (self._index(k, 0), [0]) if self.a.shape[1] == 1 else ([0], self._index(k, 1))
        return self._index(at[0], 0), self._index(at[1], 1)

    def _index(self, k, axis):
        if isinstance(k, slice):
            stop = self.a.shape[axis] if k.stop is END else int(k.stop)
            return np.arange(int(k.start) - 1, stop)
        return np.ravel(plain(k)).astype(int) - 1

    @property
    def T(self):
        return Matrix(self.a.T)

    def __neg__(self):
        return Matrix(-self.a)

    def __mul__(self, b):
        if not isinstance(b, Matrix):
            return Matrix(self.a * b)
        product = self.a @ b.a
        return float(product[0, 0]) if product.shape == (1, 1) else Matrix(product)

    def __rmul__(self, b):
        return Matrix(b * self.a)


def _elementwise(operator):
    return lambda self, b: Matrix(operator(self.a, plain(b)))


for _name, _operator in {
    "__add__": np.add,
    "__radd__": np.add,
    "__sub__": np.subtract,
    "__matmul__": np.multiply,
    "__rsub__": lambda a, b: b - a,
    "__mod__": np.divide,
    "__truediv__": np.divide,
    "__pow__": np.power,
    "__gt__": np.greater,
    "__lt__": np.less,
    "__ge__": np.greater_equal,
}.items():
    setattr(Matrix, _name, _elementwise(_operator))

END = object()


def plain(value):
    return value.a if isinstance(value, Matrix) else value


def built(rows):
    """A matrix from parts, rows of columns."""
    if not any(isinstance(v, Matrix) for row in rows for v in row):
        return Matrix(rows)
    return Matrix(np.vstack([np.hstack([np.atleast_2d(plain(v)) for v in row]) for row in rows]))


def each(function):
    return lambda *given: (
        Matrix(function(*map(plain, given)))
        if any(isinstance(one, Matrix) for one in given)
        else float(function(*given))
    )


def diag(value):
    a = plain(value)
    return Matrix(np.diag(a[:, 0])) if a.shape[1] == 1 else Matrix(np.diag(a)[:, None])


KNOWN = {
    "built": built,
    "span": slice,
    "END": END,
    "diag": diag,
    "eye": lambda n: Matrix(np.eye(int(n))),
    "zeros": lambda *n: Matrix(np.zeros(n)),
    "inv": lambda m: Matrix(np.linalg.inv(m.a)),
    "norm": lambda m: float(np.linalg.norm(m.a)),
    "length": lambda m: max(m.a.shape),
    "atan2": each(np.arctan2),
    "min": min,
    "max": max,
    "interp1": lambda x, y, c: float(np.interp(c, x.a[0], y.a[0])),
    **{name: each(getattr(np, name)) for name in ("abs", "cos", "sin", "tanh", "sign")},
}


def functions(text):
    """The functions of a file, by name; what they take and return are numbers and `Matrix`."""
    known = dict(KNOWN)
    exec("\n".join(_lines(text)), known)
    return known


def _lines(text):
    depth, outputs, blocks = 0, "", []
    for line in text.splitlines():
        line = line.partition("%")[0].strip()
        if line.startswith("function "):
            head = re.fullmatch(r"function (.*?) = (\w+)\((.*)\)", line)
            outputs, depth = head[1].strip("[]"), 1
            blocks.append("function")
            yield f"def {head[2]}({head[3]}):"
        elif line.startswith("if "):
            yield "  " * depth + f"if {expression(line[3:])}:"
            blocks.append("if")
            depth += 1
        elif line == "else":
            yield "  " * (depth - 1) + "else:"
        elif line == "end":
            if blocks.pop() == "function":
                yield f"  return {outputs}"
            else:
                depth -= 1
        else:
            for statement in filter(None, map(str.strip, split(line, ";"))):
                yield "  " * depth + assignment(statement)


def assignment(statement):
    left, _, right = statement.partition(" = ")
    if left.startswith("["):
        return f"{left.strip('[]')} = {expression(right)}"
    name, bracket, at = left.partition("(")
    if not bracket:
        return f"{name} = {expression(right)}"
    return f"{name} = {name}.put({expression('(' + at[:-1] + ',)')}, {expression(right)})"


def expression(text):
    """In Python, with the operators of `Matrix`."""
    text = text.replace("'", ".T").replace(".^", "**").replace("^", "**")
    text = text.replace(".*", "@").replace("./", "%")
    while "[" in text:  # innermost first; brackets of Python stand in for what is done
        start = text.rindex("[")
        stop = text.index("]", start)
        rows = [f"⟦{','.join(split(row, ','))}⟧" for row in split(text[start + 1 : stop], ";")]
        text = f"{text[:start]}built(⟦{', '.join(rows)}⟧){text[stop + 1 :]}"
    text = re.sub(r"(\w+):(\w+)", r"span(\1, \2)", text).replace("end", "END")
    return text.replace("⟦", "[").replace("⟧", "]")


def split(text, by):
    """At a separator outside of brackets."""
    parts, depth = [""], 0
    for letter in text:
        depth += (letter in "([⟦") - (letter in ")]⟧")
        if letter == by and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    return parts
