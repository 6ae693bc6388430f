"""Order of the numbers in an exported residual: one flat float64 array, read by compiled kernels.

    header     FORMAT, KIND, BLOCKS, WIDTH d, POINTS n, OUTPUTS m, COUNT, WEIGHTING, RANK,
               FADING_RANK
    neighbours (COUNT = k): scaling, axes (d', d), boxes (b, 2, d', LANES) and points along these
               axes, rows (n'), points (n, d) as given, targets (n, m)
    expansion  (COUNT = p): mean (m), then p parts:
               identity, limit, prior (m / p), scaling, points, spectrum (r'), weights (w', n'),
               vectors (r', n')

scaling = shift (d), scale (d); points = (n' / LANES, d', LANES). n' is n filled up to whole blocks
of LANES; d', r' (of RANK) and w' (of m / p) are filled up to multiples of UNROLL; all with zeros.
An expansion of RANK 0 has no variance: it is a sum of kernels, but no Gaussian process.
"""

FORMAT, KIND, BLOCKS, WIDTH, POINTS, OUTPUTS, COUNT, WEIGHTING, RANK, FADING_RANK = range(10)
HEADER = 10
VERSION = 2.0
NEIGHBOURS, EXPANSION = 0.0, 1.0
UNIFORM, DISTANCE = 0.0, 1.0

LANES = 32  # points side by side: four AVX-512 or eight AVX2 registers of float64
UNROLL = 4  # features, or rows of a matrix, a pass: fewer, and loads outweigh arithmetic
MAX_NEIGHBOURS = 64  # bounds the scratch; more neighbours than this would only be an average
MAX_POINTS = 8192  # of an expansion, bounds the scratch: 64 KiB on the stack
MAX_LEVELS = 8  # of a tree: 32^9 points


def filled(count: int, unit: int) -> int:
    """Round a count up to a multiple of `unit`."""
    return -(-count // unit) * unit


def tree_levels(points: int) -> list[int]:
    """Number of blocks on each level of a tree of so many points: leaves first, one root last."""
    counts = [-(-points // LANES)]
    while len(counts) == 1 or counts[-1] > 1:
        counts.append(-(-counts[-1] // LANES))
    return counts
