"""One parameter set, one step and one state, as tuples out of the arrays of all of them."""

from rovsim.dynamics.compilation.compiled import inline_internal
from rovsim.dynamics.engine.types import Constants, State, Step, Surroundings, WrenchParameters
from rovsim.dynamics.engine.vectors import ZERO6, matrix6, times6, vector3, vector6


@inline_internal
def constants_of(constants, m):
    """Constants of parameter set m alone, as tuples."""
    return Constants(
        matrix6(constants.M_RB[m]),
        matrix6(constants.M_A[m]),
        matrix6(constants.M_inv[m]),
        vector6(constants.linear[m]),
        vector6(constants.quadratic[m]),
        constants.net_weight[m],
        vector3(constants.restoring_lever[m]),
        vector3(constants.current[m]),
        constants.advance[m],
        constants.coupled[m],
        constants.coupling[m],
        vector6(constants.memory[m]),
        constants.memory_decay[m],
        constants.B[m],
        constants.directions,
        constants.uncommon[m],
        vector3(constants.waterplane[m]),
        constants.products[m],
        constants.factors,
        constants.surfaces,
        constants.lifting[m],
        vector6(constants.free[m]),
        constants.places,
    )


@inline_internal
def surroundings_of(site):
    """`SiteArrays` as tuples."""
    tank = site.tank
    walls = ((tank[0, 0], tank[0, 1]), (tank[1, 0], tank[1, 1]), (tank[2, 0], tank[2, 1]))
    return Surroundings(walls, vector3(site.axes), site.level)


@inline_internal
def parameters_of(parameters, m):
    """Parameters of the wrench effects of set m alone."""
    return WrenchParameters(parameters.values[m], parameters.attached)


@inline_internal
def ramp_of(inputs, row, k, body):
    """Change of the acceleration by the thrusters over step k, (6)."""
    if inputs.ramp.size == 0:
        return ZERO6
    return times6(body.M_inv, vector6(inputs.ramp[row, k]))


@inline_internal
def even_step_of(inputs, row, k, t, h):
    """Step k, from t s on for h s, in variant `row` of the inputs, with an even wrench."""
    wrench, demand = vector6(inputs.wrench[row, k]), vector6(inputs.demand[k])
    return Step(t, h, wrench, inputs.acting[row, k], demand, inputs.duration[k], ZERO6)


@inline_internal
def step_of(inputs, row, k, t, h, body):
    """The same, with the wrench's change over the step."""
    wrench, demand = vector6(inputs.wrench[row, k]), vector6(inputs.demand[k])
    ramp = ramp_of(inputs, row, k, body)
    return Step(t, h, wrench, inputs.acting[row, k], demand, inputs.duration[k], ramp)


@inline_internal
def state_of(a):
    """State of an array (13,)."""
    return State((a[0], a[1], a[2]), (a[3], a[4], a[5], a[6]), vector6(a[7:]))


@inline_internal
def store(x, out):
    """Write a state into an array (13,)."""
    for i in range(3):
        out[i] = x.position[i]
    for i in range(4):
        out[3 + i] = x.attitude[i]
    for i in range(6):
        out[7 + i] = x.nu[i]
