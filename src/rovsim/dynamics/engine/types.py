"""What the compiled engine passes around. SI units, body axes FRD at CO, world NED, float64."""

from typing import Any, NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array

NO_RAMP = np.empty((0, 0, 6))
NO_MEMORY = np.empty((0, 6))

# Columns of `surfaces`: place, normal and chord (3 each), half the density times the area, slope of
# the lift per rad, drag of the profile, stall rad, the thruster whose jet it stands in (-1: none),
# and by how much the square of the speed there grows per newton.
PLACE, NORMAL, CHORD = 0, 3, 6
HALF, SLOPE, PROFILE, STALL, WAKE, JET = range(9, 15)

Vector3 = tuple[float, float, float]
Vector6 = tuple[float, float, float, float, float, float]


class At(NamedTuple):
    """One instant, as a wrench kernel sees it: floats and tuples of floats.

    `t` s since the start of the recording, `duration` s of the whole recording, `position` (3),
    `R` rows of the rotation body to world, `nu` (6) velocity, `nu_r` (6) velocity through the
    water, `nu_c_dot` (6) acceleration of the current in body axes, `drag` (6) wrench of the six
    diagonal damping terms, `inertia` (6) diagonal of the whole M, `demand` (6) pilot demand per
    axis in [-1, 1] (NaN if not logged), `tank` (low, high) per world axis (NaN if unknown; the
    surface is the low end in z), `axes` (3) signs between MoCap world axes and NED.
    """

    t: float
    duration: float
    position: Vector3
    R: tuple[Vector3, Vector3, Vector3]
    nu: Vector6
    nu_r: Vector6
    nu_c_dot: Vector6
    drag: Vector6
    inertia: Vector6
    demand: Vector6
    tank: tuple[tuple[float, float], tuple[float, float], tuple[float, float]]
    axes: Vector3


_NONE: Vector6 = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
# Some instant: what a kernel can be tried on.
EXAMPLE = At(
    0.0,
    1.0,
    (0.0, 0.0, 0.0),
    ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
    _NONE,
    _NONE,
    _NONE,
    _NONE,
    _NONE,
    _NONE,
    ((-1.0, 1.0), (-1.0, 1.0), (-1.0, 1.0)),
    (1.0, -1.0, -1.0),
)


class State(NamedTuple):
    """Position NED m, quaternion body to world, body velocity; or their rates of change."""

    position: Vector3
    attitude: tuple[float, float, float, float]
    nu: Vector6


class Constants(NamedTuple):
    """Constants of the equation of motion for m parameter sets, stacked along the first axis.

    `M_RB`, `M_A`, `M_inv` (m, 6, 6); `linear`, `quadratic` (m, 6); `net_weight` (m,) weight minus
    buoyancy in N; `restoring_lever` (m, 3) weight at CG minus buoyancy at CB in N m; `current`
    (m, 3) NED; `advance` (m,) s/m; `coupling` (m, 2, 6, 6) linear and quadratic damping between
    axes, read only where `coupled` (m,) is not 0; `memory` (m, 6) force per remembered velocity,
    `memory_decay` (m,) 1/s (0: nothing is remembered); `B` (m, 6, n) thruster allocation;
    `directions` (n, 3) of positive thrust. Read only where `uncommon` (m,) is not 0, as in `Body`:
    `waterplane` (m, 3), `products` (m, t) and their `factors` (t, 4), `surfaces` (s, 15),
    `lifting` (m, s). `free` (m, 6) is 1 for axes that move, 0 where they are held; `places`
    (n + s, 3) of thrusters, then surfaces.
    """

    M_RB: Array
    M_A: Array
    M_inv: Array
    linear: Array
    quadratic: Array
    net_weight: Array
    restoring_lever: Array
    current: Array
    advance: Array
    coupled: Array
    coupling: Array
    memory: Array
    memory_decay: Array
    B: Array
    directions: Array
    uncommon: Array
    waterplane: Array
    products: Array
    factors: Array
    surfaces: Array
    lifting: Array
    free: Array
    places: Array

    @staticmethod
    def stacked(sets: "Sequence[Constants]") -> "Constants":
        """Those of several sets of one vehicle; what has no first axis m is the first one's."""
        first, several = sets[0], [name for name in Constants._fields if name not in OF_VEHICLE]
        return first._replace(
            **{name: np.concatenate([getattr(one, name) for one in sets]) for name in several}
        )


OF_VEHICLE = ("directions", "factors", "surfaces", "places")  # the same in all its parameter sets


class WrenchParameters(NamedTuple):
    """Parameters of wrench effects: `values` (m, k) for each of m sets, or (k,) of one set.

    Those of an engine's own effects come first, each behind 1 or 0: whether it acts. Values beyond
    them are those of `attached`, another chain of effects (`rovsim.dynamics.engine.modules`).
    """

    values: Array
    attached: Any = None


class Inputs(NamedTuple):
    """Mean thrust over each step: `wrench` (r, k, 6), `acting` (r, k, n + s), `demand` (k, 6).

    `acting`: forces N of the n thrusters, angles rad of the s control surfaces, then what some
    effects read (`rovsim.dynamics.engine.reading`).

    `row` (m,) says which of the r rows belongs to each parameter set; `duration` (k,) is the
    length in s of the recording the step belongs to. `ramp` (r, k, 6) is what the wrench grows by
    over each step, N and N m; empty: nothing.
    """

    wrench: Array
    acting: Array
    demand: Array
    row: Array
    duration: Array
    ramp: Array = NO_RAMP


class Jobs(NamedTuple):
    """Trajectories to integrate, j of them.

    `state` (j, 13) to start from; `first` (j,) step of the inputs, `steps` (j,) to take, `member`
    (j,) parameter set, `out` (j,) first row of the output. `memory` (j, 6) velocity through the
    water that the water remembers at the start; empty: none.
    """

    state: Array
    first: Array
    steps: Array
    member: Array
    out: Array
    memory: Array = NO_MEMORY


class SiteArrays(NamedTuple):
    """`tank` (3, 2) low and high walls in NED, `axes` (3,) signs of the MoCap axes.

    `level` m NED: where what floats is at rest.
    """

    tank: Array
    axes: Array
    level: float = 0.0
