"""Write a MATLAB or GNU Octave function with the signature of vehicles in Fossen's MSS toolbox.

    [xdot, U, M] = NAME(x, ui)

x = [nu; position; attitude] with Euler angles (12) or a unit quaternion (13), as in `remus100.m`.
The functions it needs stand in the same file, so the toolbox is not necessary.
"""

import re
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.application.export.equation import Equation
from rovsim.application.export.holding import (
    DAMPING_EFFECTS,
    INERTIA_EFFECTS,
    RIGID_EFFECTS,
    STATIC_THRUST_EFFECTS,
    nothing,
    unpowered,
    whole,
)
from rovsim.core.errors import one_line
from rovsim.dynamics.effects.base import Effect
from rovsim.dynamics.vehicle.cross_flow import parse_product
from rovsim.dynamics.vehicle.curves import ForceCurve
from rovsim.dynamics.vehicle.thrusters import Thrusters

TITLE = "MATLAB, as in Fossen's MSS"
SUFFIX = ".m"
SOURCE = "MSS (Marine Systems Simulator), CRAFT/AUV/models: states, inputs and signs"
TAKES = "ui are the commands of the thrusters in [-1, 1]; after that of one that turns, its angle."

MSS_EFFECTS = (
    "current",
    "waterplane_stiffness",
    "cross_flow",
    "lift",
    "cubic_damping",
    "dry_friction",
    "constant_wrench",
    "advance_loss",
    "propeller_torque",
    "held_axes",
)
WHOLE_EFFECTS = {
    *RIGID_EFFECTS,
    *DAMPING_EFFECTS,
    *INERTIA_EFFECTS,
    *STATIC_THRUST_EFFECTS,
    *MSS_EFFECTS,
}

MAX_NAME_LETTERS = 63  # namelengthmax

KINEMATICS = """
function [R, T] = attitude(a)
% Rotation matrix body to NED, and rate of the attitude per body rate (Fossen 2021, sec. 2.2):
% of a unit quaternion [w; x; y; z], or of Euler angles [phi; theta; psi].
if length(a) == 4
    S = skew(a(2:4));
    R = eye(3) + 2*a(1)*S + 2*S*S;
    T = 0.5*[-a(2:4)'; a(1)*eye(3) + S];
else
    c = cos(a);
    s = sin(a);
    Rx = [1, 0, 0; 0, c(1), -s(1); 0, s(1), c(1)];
    Ry = [c(2), 0, s(2); 0, 1, 0; -s(2), 0, c(2)];
    Rz = [c(3), -s(3), 0; s(3), c(3), 0; 0, 0, 1];
    R = Rz*Ry*Rx;
    T = [1, s(1)*s(2)/c(2), c(1)*s(2)/c(2); 0, c(1), -s(1); 0, s(1)/c(2), c(1)/c(2)];
end
end

function S = skew(r)
% skew(r)*x is the cross product of r and x (Fossen 2021, eq. 2.10).
S = [0, -r(3), r(2); r(3), 0, -r(1); -r(2), r(1), 0];
end

function tau = coriolis(M, nu)
% C(nu)*nu of a body with inertia M (Fossen 2021, eq. 6.43).
h = M*nu;
tau = [skew(nu(4:6))*h(1:3); skew(nu(1:3))*h(1:3) + skew(nu(4:6))*h(4:6)];
end
"""


def hold(effect: Effect) -> tuple[Effect, str]:
    """Return what the function can hold of an effect, and why not the rest."""
    if isinstance(effect, Thrusters):
        return unpowered(effect)
    return whole(effect) if effect.id in WHOLE_EFFECTS else nothing(effect)


def text(equation: Equation, notes: Sequence[str]) -> str:
    """Return the text of the function, and of those that it calls."""
    name = _identifier(equation.model.name)
    lines = [
        f"function [xdot, U, M] = {name}(x, ui)",
        *map(_comment, notes),
        "%",
        "% x  = [u; v; w; p; q; r; north; east; down; phi; theta; psi], or with a unit quaternion",
        "%      [w; x; y; z] in place of the angles: SI, body axes FRD at CO, world NED.",
        _comment(f"ui = [{'; '.join(equation.model.vehicle.command_columns)}]"),
        "% xdot: rate of change of x; U: speed m/s; M: inertia with added mass.",
        *_constants(equation),
        *_motion(equation),
        *_forces(equation),
        *_thrust(equation),
        "xdot = [Minv*tau; R*nu(1:3); T*nu(4:6)];",
        "U = norm(nu(1:3));",
        "end",
    ]
    return "\n".join(lines) + "\n" + KINEMATICS


def _comment(text: str) -> str:
    """Make a comment of one line, since a second line would be a command."""
    return f"% {one_line(text)}".rstrip()


def _identifier(name: str) -> str:
    """Make a name that MATLAB accepts."""
    identifier = re.sub(r"\W", "_", name, flags=re.ASCII)
    return (identifier if identifier[:1].isalpha() else f"vehicle_{identifier}")[:MAX_NAME_LETTERS]


def _constants(equation: Equation) -> list[str]:
    body = equation.body
    return [
        "",
        f"MRB = {_matrix(body.M_RB)};",
        f"MA = {_matrix(body.M_A)};",
        f"Dl = {_matrix(equation.linear)};",
        f"Dq = {_matrix(equation.quadratic)};",
        "M = MRB + MA;",
        *_inverse(equation),
        f"W = {_number(body.weight)}; B = {_number(body.buoyancy)};  % N",
        f"r_bg = {_column(equation.rigid.center)}; r_bb = {_column(body.center_of_buoyancy)};  % m",
        f"v_c = {_column(body.current)};  % current, m/s NED",
    ]


def _inverse(equation: Equation) -> list[str]:
    free = equation.body.free
    if free.all():
        return ["Minv = inv(M);"]
    axes = ", ".join(str(k + 1) for k in np.flatnonzero(free))
    free_axes = f"free = [{axes}];  % the other axes are held"
    return [free_axes, "Minv = zeros(6, 6);", "Minv(free, free) = inv(M(free, free));"]


def _motion(equation: Equation) -> list[str]:
    return [
        "",
        "[R, T] = attitude(x(10:end));",
        *([] if equation.body.free.all() else ["x(1:6) = diag(sign(diag(Minv)))*x(1:6);"]),
        "nu = x(1:6);",
        "nu_c = [R'*v_c; zeros(3, 1)];",
        "nu_c_dot = [-skew(nu(4:6))*nu_c(1:3); zeros(3, 1)];",
        "nu_r = nu - nu_c;",
    ]


def _forces(equation: Equation) -> list[str]:
    lines = [
        "",
        "tau = MA*nu_c_dot - coriolis(MRB, nu) - coriolis(MA, nu_r);",
        "tau = tau - Dl*nu_r - Dq*(abs(nu_r).*nu_r);",
        "down = R(3, 1:3)';",
        "tau = tau + [(W - B)*down; skew(W*r_bg - B*r_bb)*down];",
    ]
    for name, c in equation.products.items():
        axis, *factors = parse_product(name)
        terms = [f"abs(nu_r({f - 5}))" if f >= 6 else f"nu_r({f + 1})" for f in factors if f >= 0]
        row = f"tau({axis + 1})"
        lines.append(f"{row} = {row} + {_number(c)}*{'*'.join(terms)};  % {name}")
    if equation.friction.any():
        lines.append(f"tau = tau - {_column(equation.friction)}.*tanh(nu_r/0.01);  % dry friction")
    if equation.constant.any():
        lines.append(f"tau = tau + {_column(equation.constant)};  % always there")
    stiffness = equation.body.waterplane
    if stiffness.any():
        lines += [
            "tilt = [x(9); atan2(down(2), down(3)); atan2(-down(1), norm(down(2:3)))];",
            f"tau(3:5) = tau(3:5) - {_column(stiffness)}.*tilt;  % at rest at a depth of 0",
        ]
    return lines


def _thrust(equation: Equation) -> list[str]:
    thrusters = equation.model.thrust_path.thrusters
    if not thrusters.count:
        return []
    starts = np.arange(thrusters.count) + np.cumsum(thrusters.turning) - thrusters.turning
    indices = (starts + 1)[equation.columns]
    lines = ["", f"c = ui([{', '.join(map(str, indices))}]);"]
    if equation.deadband:
        lines.append(f"c = c.*(abs(c) > {_number(equation.deadband)});")
    lines.append(f"F = {_static(equation.curves)};  % N")
    if equation.exponent != 1.0:
        reverse, forward = (_column(full) for full in equation.full)
        lines.append(f"full = {reverse}.*(F < 0) + {forward}.*(F >= 0);")
        lines.append(f"F = sign(F).*full.*(abs(F)./full).^{_number(equation.exponent)};")
    if (equation.gain != 1.0).any():
        lines.append(f"F = {_column(equation.gain)}.*F;")
    if equation.backwards != 1.0:
        lines.append(f"F = F.*(1 - {_number(1.0 - equation.backwards)}*(F < 0));")
    if thrusters.turning.any():
        angles = ", ".join(str(k + 2) for k in starts[thrusters.turning])
        turns = ", ".join(str(k + 1) for k in np.flatnonzero(thrusters.turning))
        lines += [
            f"a = ui([{angles}]); aside = F([{turns}]);  % rad, of those that turn",
            f"F([{turns}]) = aside.*cos(a);",
            "F = [F; aside.*sin(a)];",
        ]
    if equation.body.advance:
        inflow = f"({_matrix(equation.body.directions)}*nu_r(1:3))"
        lines.append(f"F = F - {_number(equation.body.advance)}*abs(F).*{inflow};  % advance")
    return [*lines, f"tau = tau + {_matrix(equation.body.B)}*F;", ""]


def _static(curves: Sequence[ForceCurve]) -> str:
    """Write the forces of commands c; a polynomial that all thrusters share is written once."""
    if curves[0].odd_polynomial and all(curve == curves[0] for curve in curves):
        return _polynomial(curves[0].odd_polynomial, "c", ".^")
    return f"[{'; '.join(_curve(curve, k) for k, curve in enumerate(curves))}]"


def _polynomial(coefficients: Sequence[float], c: str, power: str) -> str:
    terms = enumerate(coefficients)
    return " + ".join(f"{_number(a)}*{c}{f'{power}{2 * n + 1}' if n else ''}" for n, a in terms)


def _curve(curve: ForceCurve, k: int) -> str:
    """Write the force of thruster k as a function of its command."""
    c = f"c({k + 1})"
    if curve.table is not None:
        command, force = (_row(v) for v in (curve.table.command, curve.table.force_))
        low, high = (_number(v) for v in (curve.table.command[0], curve.table.command[-1]))
        return f"interp1({command}, {force}, min(max({c}, {low}), {high}))"
    if curve.quadratic is not None:
        q = curve.quadratic
        share = f"(max(abs({c}) - {_number(q.deadband)}, 0)/{_number(1.0 - q.deadband)})"
        size = f"({_number(q.forward)}*({c} >= 0) - {_number(q.reverse)}*({c} < 0))"
        return f"{size}*{share}^2"
    return _polynomial(curve.odd_polynomial or (0.0,), c, "^")


def _matrix(values: Array) -> str:
    return "[" + "; ".join(", ".join(_number(v) for v in row) for row in values) + "]"


def _column(values: Array) -> str:
    return _matrix(np.asarray(values)[:, None])


def _row(values: Sequence[float]) -> str:
    return _matrix(np.asarray(values)[None])


def _number(value: float) -> str:
    """Write a number, in brackets where it is negative, so that it may follow any sign."""
    digits = f"{float(value) + 0.0:.15g}"
    return f"({digits})" if digits.startswith("-") else digits
