"""Write YAML with the matrices and coefficients of Fossen's equation, for a user's own simulator.

The names are those that Fossen's Python Vehicle Simulator gives its matrices (`MRB`, `MA`, `W`,
`B`, `r_bg`, `r_bb`). It reads no file: a vehicle there is a class, and these are its constants.
"""

from typing import Any, Sequence

import numpy as np

from rovsim.application.export.equation import Equation
from rovsim.application.export.targets import mss
from rovsim.core.errors import one_line
from rovsim.core.files import plain
from rovsim.core.yaml_files import yaml_text
from rovsim.dynamics.effects.base import Effect

TITLE = "Fossen's matrices as YAML"
SUFFIX = ".yaml"
SOURCE = "Fossen 2021, eq. 6.1, with the names of the Python Vehicle Simulator"
TAKES = "Commands of the thrusters in [-1, 1]."

EQUATION = """
    MRB nu' + C(MRB, nu) nu + MA nu_r' + C(MA, nu_r) nu_r = tau, with nu_r = nu - [R' v_c; 0] and
    tau = - D_linear nu_r - D_quadratic (|nu_r| nu_r) + products - dry_friction tanh(nu_r / 0.01)
          + constant + weight and buoyancy - waterplane (depth, phi, theta) + T F
SI, body axes FRD at CO, world NED. A product such as Yuv is the coefficient of u v in Y; twice the
same velocity is v |v|. F of a thruster: its command (0 within deadband) through its curve, then
sign(F) full (|F| / full)^exponent, times gain, times backwards where F is then negative, then
F - advance |F| (direction . nu_r). Columns of T: one a thruster; those that turn have a second one
for what they push to starboard, at the end.
"""


def hold(effect: Effect) -> tuple[Effect, str]:
    """Return what the file can hold of an effect: the same as the MATLAB function (`mss`)."""
    return mss.hold(effect)


def text(equation: Equation, notes: Sequence[str]) -> str:
    """Return the text of the YAML file."""
    lines = [*notes, *EQUATION.strip("\n").splitlines()]
    return "".join(f"# {one_line(line)}".rstrip() + "\n" for line in lines) + yaml_text(
        plain(_write_terms(equation)), rows=True
    )


def _write_terms(equation: Equation) -> dict[str, Any]:
    body = equation.body
    return {
        "name": equation.model.name,
        "rho": equation.model.vehicle.density,
        "g": body.gravity,
        "MRB": body.M_RB,
        "MA": body.M_A,
        "D_linear": equation.linear,
        "D_quadratic": equation.quadratic,
        "products": equation.products,
        "W": body.weight,
        "B": body.buoyancy,
        "r_bg": equation.rigid.center,
        "r_bb": body.center_of_buoyancy,
        "v_c": body.current,
        "constant": equation.constant,
        "dry_friction": equation.friction,
        "waterplane": body.waterplane,
        "free": [bool(moves) for moves in body.free],
        "thrusters": _thrusters(equation),
    }


def _thrusters(equation: Equation) -> dict[str, Any]:
    units = equation.model.vehicle.thrusters.units
    return {
        "T": equation.body.B,
        "directions": equation.body.directions,
        "deadband": equation.deadband,
        "exponent": equation.exponent,
        "backwards": equation.backwards,
        "advance": equation.body.advance,
        "units": [
            {
                "name": unit.name,
                "command": equation.names[column],
                "turns": unit.azimuth,
                "curve": curve.model_dump(mode="json", by_alias=True, exclude_none=True),
                "full": {"backwards": reverse, "forwards": forward},
                "gain": gain,
            }
            for unit, column, curve, (reverse, forward), gain in zip(
                units,
                equation.columns,
                equation.curves,
                np.asarray(equation.full).T,
                equation.gain,
                strict=True,
            )
        ],
    }
