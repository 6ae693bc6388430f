"""Types passed between the compiled functions: SI, body FRD at CO, world NED, float64."""

from typing import Any, NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array

NO_RAMP = np.empty((0, 0, 6))
NO_MEMORY = np.empty((0, 6))

# Columns of `surfaces`: place m, normal and chord (3 each, body axes), half the density times the
# area (kg/m), slope of the lift coefficient per rad, drag coefficient of the profile, stall angle
# rad, column in `acting` of the thruster whose jet the surface stands in (-1: none), and by how
# much that jet increases the square of the flow speed, m2/s2 per N.
PLACE, NORMAL, CHORD = 0, 3, 6
HALF, SLOPE, PROFILE, STALL, WAKE, JET = range(9, 15)

Vector3 = tuple[float, float, float]
Vector6 = tuple[float, float, float, float, float, float]


class At(NamedTuple):
    """One instant, as floats and tuples: motion and surroundings that a wrench kernel reads.

    Attributes:
        t: time since the start of the recording, s.
        duration: of the whole recording, s.
        position: (3) of CO in NED, m.
        R: rotation matrix from body to world, three rows.
        nu: (6) velocity in body axes, m/s and rad/s.
        nu_r: (6) velocity relative to the water, m/s and rad/s.
        nu_c_dot: (6) rate of change of the current in body axes, m/s2.
        drag: (6) wrench of the diagonal linear and quadratic damping, N and N m.
        inertia: (6) diagonal of M = M_RB + M_A, kg and kg m2.
        demand: (6) pilot demand of each axis in [-1, 1]; NaN if it was not logged.
        tank: (low, high) position of the walls along each NED axis, m; NaN if unknown. The water
            surface is the low end in z.
        axes: (3) signs between the world axes of the MoCap and NED.
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


_UNMEASURED: Vector6 = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
# An arbitrary instant, at rest: to compile and try kernels on.
EXAMPLE = At(
    0.0,
    1.0,
    (0.0, 0.0, 0.0),
    ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
    _UNMEASURED,
    _UNMEASURED,
    _UNMEASURED,
    _UNMEASURED,
    _UNMEASURED,
    _UNMEASURED,
    ((-1.0, 1.0), (-1.0, 1.0), (-1.0, 1.0)),
    (1.0, -1.0, -1.0),
)


class State(NamedTuple):
    """Position in NED, m, unit quaternion (w, x, y, z) body to world, and nu; or their rates."""

    position: Vector3
    attitude: tuple[float, float, float, float]
    nu: Vector6


class Constants(NamedTuple):
    """Constants of the equation of motion for m parameter sets, stacked along the first axis.

    `rovsim.dynamics.body.Body` has the same quantities of one parameter set, with their units.

    Attributes:
        M_RB: (m, 6, 6) rigid-body inertia.
        M_A: (m, 6, 6) added mass.
        M_inv: (m, 6, 6) inverse of M_RB + M_A; zero in rows and columns of axes that are held.
        linear: (m, 6) linear damping, positive = drag.
        quadratic: (m, 6) quadratic damping, positive = drag.
        net_weight: (m,) weight minus buoyancy, N.
        restoring_lever: (m, 3) weight times r_CG minus buoyancy times r_CB, N m.
        current: (m, 3) velocity of the water in NED, m/s.
        advance: (m,) relative loss of thrust per inflow velocity, s/m.
        coupled: (m,) 0 where `coupling` is zero and need not be evaluated.
        coupling: (m, 2, 6, 6) linear and quadratic damping between axes.
        memory: (m, 6) force per remembered velocity (`Body.remember`).
        memory_decay: (m,) 1 / time constant of the fluid memory, 1/s; 0: no memory.
        B: (m, 6, n) allocation: wrench per force of each thruster component.
        directions: (n, 3) of positive thrust, body axes.
        uncommon: (m,) 0 where waterplane, products and surfaces are absent and need not be
            evaluated.
        waterplane: (m, 3) stiffness in heave, roll and pitch.
        products: (m, t) coefficients of products of velocities.
        factors: (t, 4) axis of the force and up to three velocities of each product.
        surfaces: (s, 15) control surfaces; the columns stand at the top of this module.
        lifting: (m, s) factor on the lift of each surface.
        free: (m, 6) 1 for axes that move, 0 for axes that are held.
        places: (n + s, 3) of thrusters, then surfaces, body axes, m.
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
        """Stack parameter sets of a vehicle along m; `VEHICLE_FIELDS` are those of the first."""
        first, names = sets[0], [name for name in Constants._fields if name not in VEHICLE_FIELDS]
        return first._replace(
            **{name: np.concatenate([getattr(c, name) for c in sets]) for name in names}
        )


VEHICLE_FIELDS = ("directions", "factors", "surfaces", "places")  # the same in all sets


class WrenchParameters(NamedTuple):
    """Parameters of all wrench effects, as the compiled engine reads them.

    Attributes:
        values: (m, k) for m parameter sets, or (k,) of one set. For each effect, first 1 or 0
            (whether it acts), then its parameters. The engine's own effects come first, then the
            attached ones.
        attached: compiled function with the sum of the attached effects, see
            `rovsim.dynamics.engine.modules`; None where there are none.
    """

    values: Array
    attached: Any = None


class Inputs(NamedTuple):
    """Actuation over each of k integration steps, in r variants that parameter sets can share.

    Attributes:
        wrench: (r, k, 6) mean thruster wrench over each step, body axes, N and N m.
        acting: (r, k, n + s) mean forces of the n thruster components, N, and angles of the s
            control surfaces, rad; then the further columns of
            `rovsim.dynamics.engine.kernel_inputs`.
        demand: (k, 6) pilot demands in [-1, 1].
        row: (m,) which of the r variants belongs to each of m parameter sets.
        duration: (k,) length of the recording that the step belongs to, s.
        ramp: (r, k, 6) change of the wrench from the beginning of a step to its end, N and N m;
            empty if it is constant over a step.
    """

    wrench: Array
    acting: Array
    demand: Array
    row: Array
    duration: Array
    ramp: Array = NO_RAMP


class Jobs(NamedTuple):
    """Trajectories to integrate, j of them.

    Attributes:
        state: (j, 13) initial states: position, quaternion, nu.
        first: (j,) index of the first step in `Inputs`.
        steps: (j,) number of steps.
        member: (j,) index of the parameter set.
        out: (j,) first row of the output.
        memory: (j, 6) initial state of the fluid memory, a velocity relative to the water; empty:
            zero.
    """

    state: Array
    first: Array
    steps: Array
    member: Array
    out: Array
    memory: Array = NO_MEMORY


class SiteArrays(NamedTuple):
    """The surroundings of a recording.

    Attributes:
        tank: (3, 2) low and high walls along each NED axis, m.
        axes: (3,) signs between the world axes of the MoCap and NED.
        level: z in NED at which a floating vehicle is at rest, m.
    """

    tank: Array
    axes: Array
    level: float = 0.0


class World(NamedTuple):
    """What moves vehicles, for m parameter sets: all that does not belong to single trajectories.

    Attributes:
        constants: of the equation of motion.
        inputs: actuation over the integration steps.
        parameters: of the wrench effects.
        residual: an exported learned residual; None if none acts.
        site: the surroundings.
    """

    constants: Constants
    inputs: Inputs
    parameters: WrenchParameters
    residual: Array | None
    site: SiteArrays


class Surroundings(NamedTuple):
    """`SiteArrays` as tuples: walls (low, high) along each NED axis, MoCap axes, level of rest."""

    tank: tuple[tuple[float, float], tuple[float, float], tuple[float, float]]
    axes: Vector3
    level: float


class Step(NamedTuple):
    """One integration step, with the inputs of one parameter set over it.

    Attributes:
        t: when it begins, s since the start of the recording.
        h: how long it is, s.
        thrust: (6) mean thruster wrench, N and N m.
        acting: (n + s) mean forces and angles, see `Inputs`.
        demand: (6) pilot demands in [-1, 1].
        duration: length of the recording, s.
        ramp: (6) change of the acceleration by the thrusters from its beginning to its end, m/s2
            and rad/s2.
    """

    t: float
    h: float
    thrust: Vector6
    acting: Array
    demand: Vector6
    duration: float
    ramp: Vector6


class Scratch(NamedTuple):
    """Arrays that the evaluation of a learned residual writes to.

    Attributes:
        features: of one sample, as many as there can be.
        a_res: (6,) its acceleration, m/s2 and rad/s2.
    """

    features: Array
    a_res: Array
