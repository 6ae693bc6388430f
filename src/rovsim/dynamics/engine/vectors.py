"""Small vectors as tuples of floats: kept in registers, without an array's reference count."""

from rovsim.dynamics.compilation.compiled import inline_shared

ZERO6 = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@inline_shared
def cross(a, b):
    """Cross product of 3-vectors."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@inline_shared
def dot3(a, b):
    """Scalar product of 3-vectors."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@inline_shared
def dot6(a, b):
    """Scalar product of 6-vectors."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] + a[4] * b[4] + a[5] * b[5]


@inline_shared
def add3(a, h, b):
    """a + h b."""
    return a[0] + h * b[0], a[1] + h * b[1], a[2] + h * b[2]


@inline_shared
def add4(a, h, b):
    """a + h b."""
    return a[0] + h * b[0], a[1] + h * b[1], a[2] + h * b[2], a[3] + h * b[3]


@inline_shared
def add6(a, h, b):
    """a + h b."""
    return (
        a[0] + h * b[0],
        a[1] + h * b[1],
        a[2] + h * b[2],
        a[3] + h * b[3],
        a[4] + h * b[4],
        a[5] + h * b[5],
    )


@inline_shared
def each6(a, b):
    """Element-wise product of 6-vectors."""
    return a[0] * b[0], a[1] * b[1], a[2] * b[2], a[3] * b[3], a[4] * b[4], a[5] * b[5]


@inline_shared
def times6(M, v):
    """Matrix (six rows) times 6-vector."""
    return (
        dot6(M[0], v),
        dot6(M[1], v),
        dot6(M[2], v),
        dot6(M[3], v),
        dot6(M[4], v),
        dot6(M[5], v),
    )


@inline_shared
def into_body(R, x):
    """R' x: a world vector in body axes."""
    return (
        R[0][0] * x[0] + R[1][0] * x[1] + R[2][0] * x[2],
        R[0][1] * x[0] + R[1][1] * x[1] + R[2][1] * x[2],
        R[0][2] * x[0] + R[1][2] * x[1] + R[2][2] * x[2],
    )


@inline_shared
def into_world(R, x):
    """R x: a body vector in world axes."""
    return dot3(R[0], x), dot3(R[1], x), dot3(R[2], x)


@inline_shared
def vector3(a):
    """Tuple of an array (3,)."""
    return a[0], a[1], a[2]


@inline_shared
def vector6(a):
    """Tuple of an array (6,)."""
    return a[0], a[1], a[2], a[3], a[4], a[5]


@inline_shared
def matrix6(a):
    """Rows of an array (6, 6)."""
    return vector6(a[0]), vector6(a[1]), vector6(a[2]), vector6(a[3]), vector6(a[4]), vector6(a[5])
