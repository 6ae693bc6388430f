"""A tether: it pulls when taut, and drags through the water."""

from math import sqrt

from rovsim.core.errors import BadInput
from rovsim.core.run import CommandKind, Site
from rovsim.dynamics.compilation.compiled import inlined
from rovsim.dynamics.effects.base import Parameter, Signature, Wrench
from rovsim.dynamics.engine.vectors import cross, dot3, into_body

ATTACHMENT_PARAMETERS = tuple(
    Parameter(f"attachment_{axis}", "m", f"{axis}_t", default=x, scale=0.1, fitted=False)
    for axis, x in zip("xyz", (-0.2, 0.0, 0.0), strict=True)  # aft, as a convention
)


def _anchor(default: float, fitted: bool) -> tuple[Parameter, ...]:
    """Parameters of the point where the tether leaves the tank, in MoCap world axes."""
    return tuple(
        Parameter(f"anchor_{axis}", "m", f"{axis}_a", default=default, scale=1.0, fitted=fitted)
        for axis in "xyz"
    )


@inlined
def attached(p, F):
    """Wrench (6) at CO of a force F (3) at the attachment, body axes."""
    moment = cross((p.attachment_x, p.attachment_y, p.attachment_z), F)
    return F[0], F[1], F[2], moment[0], moment[1], moment[2]


class TetherTension(Wrench):
    """A weightless elastic tether from a point on the vehicle to an anchor in the tank."""

    id = "tether_tension"
    differs_between_runs = True
    equation = r"F = k \max(0, L - L_0) \text{ towards the anchor}"
    symbols = (
        ("F", "force on the vehicle"),
        ("L", "distance from the attachment to the anchor"),
    )
    neglects = "weight, drag and dynamics of the tether"
    source = "Hooke's law"
    cause = "The tether came taut, or its floats pull."
    revealed_by = (
        "Visit all corners of the tank slowly, shallow and deep: tension points to the anchor and "
        "begins beyond the slack length, a current or buoyancy pushes alike everywhere."
    )
    signature = Signature(
        {"stiffness": 8.0, "slack_length": 0.8, "anchor_x": 2.0, "anchor_y": 1.1, "anchor_z": 2.0},
        "heave",
        "depth below the surface",
    )
    parameters = (
        Parameter("stiffness", "N/m", "k", low=0.0, scale=2.0),
        Parameter("slack_length", "m", "L_0", low=0.0, scale=0.5),
        *_anchor(0.0, fitted=True),
        *ATTACHMENT_PARAMETERS,
    )
    starts = tuple({"stiffness": 1.0, "slack_length": slack} for slack in (0.2, 1.0))

    @classmethod
    def starts_at(cls, site: Site) -> tuple[dict[str, float], ...]:
        """Anchors at the surface, over the middle and the corners of a known tank."""
        return tuple({**anchor, **start} for anchor in _over(site) for start in cls.starts)

    @staticmethod
    def wrench(at, p):
        """Pull at the attachment, and its moment about CO."""
        north = p.anchor_x * at.axes[0] - at.position[0]
        east = p.anchor_y * at.axes[1] - at.position[1]
        down = p.anchor_z * at.axes[2] - at.position[2]
        a, b, c = into_body(at.R, (north, east, down))
        # from the attachment to the anchor, in body axes
        a, b, c = a - p.attachment_x, b - p.attachment_y, c - p.attachment_z
        length = sqrt(a * a + b * b + c * c)
        pull = p.stiffness * max(0.0, length - p.slack_length) / max(length, 1e-9)
        return attached(p, (pull * a, pull * b, pull * c))


@inlined
def replace_nan(value, otherwise):
    """The value, or `otherwise` if it is NaN."""
    return value if value == value else otherwise


class TetherDrag(Wrench):
    """The wetted tether is towed along: the farther from its anchor, the more of it.

    An anchor coordinate that is not given is that of the middle of the tank at the surface.
    """

    id = "tether_drag"
    equation = r"F = -c\,r\,|v_r|\,v_r \text{ at the attachment}"
    symbols = (
        ("F", "force on the vehicle"),
        ("r", "distance to the anchor"),
        ("v_r", "velocity of CO through the water"),
    )
    neglects = "the tether's shape, and that its far end moves slower"
    source = "quadratic drag of a wetted length that grows with the distance from the anchor"
    cause = (
        "The wetted tether is towed along, and there is more of it the farther the vehicle is "
        "from its anchor."
    )
    revealed_by = (
        "Cross the tank at one steady speed, once close to the anchor and once far from it: the "
        "drag of a tether grows with the distance, that of the hull does not."
    )
    signature = Signature({"coefficient": 15.0}, "yaw", "sway speed")
    parameters = (
        # 1.2 (cylinder) * 1000 kg/m3 / 2 * 7.5 mm = 4.5 N s2/m3 if all of it moved at full speed
        Parameter("coefficient", "N s2/m3", "c", low=0.0, scale=2.0),
        *_anchor(float("nan"), fitted=False),
        *ATTACHMENT_PARAMETERS,
    )
    starts = ({"coefficient": 0.5}, {"coefficient": 2.0})

    def check(self, site: Site, kind: CommandKind) -> None:
        """Refuse a run where neither the tank nor the anchor is known."""
        if any(self[f"anchor_{axis}"] != self[f"anchor_{axis}"] for axis in _unknown(site)):
            raise BadInput(
                "tether_drag has no anchor, and the tank is not known",
                where="model",
                expected="anchor_x, anchor_y, anchor_z, or the walls of the tank",
                remedy="Give the anchor, or 'tank: {x: [low, high], …}' in campaign.yaml.",
            )

    @staticmethod
    def wrench(at, p):
        """Drag at the attachment, and its moment about CO."""
        (x0, x1), (y0, y1), surface = at.tank[0], at.tank[1], at.tank[2][0]
        north = replace_nan(p.anchor_x * at.axes[0], 0.5 * (x0 + x1)) - at.position[0]
        east = replace_nan(p.anchor_y * at.axes[1], 0.5 * (y0 + y1)) - at.position[1]
        down = replace_nan(p.anchor_z * at.axes[2], surface) - at.position[2]
        # 0, where the place is unknown: the coefficient is then 0
        r = replace_nan(sqrt(north * north + east * east + down * down), 0.0)
        v = at.nu_r[:3]
        drag = -p.coefficient * r * sqrt(dot3(v, v))
        return attached(p, (drag * v[0], drag * v[1], drag * v[2]))


def _unknown(site: Site) -> str:
    """World axes along which the walls of the tank are not known."""
    return "".join(axis for axis, wall in zip("xyz", site.tank[:, 0], strict=True) if wall != wall)


def _over(site: Site) -> list[dict[str, float]]:
    """Anchors at the surface over the middle and the corners of the tank, in MoCap axes, m."""
    if _unknown(site):
        return [{}]
    (x0, x1), (y0, y1), (surface, _) = site.tank
    points = [((x0 + x1) / 2, (y0 + y1) / 2), *((x, y) for x in (x0, x1) for y in (y0, y1))]
    return [
        {
            f"anchor_{axis}": float(v * s)
            for axis, v, s in zip("xyz", (*xy, surface), site.axes, strict=True)
        }
        for xy in points
    ]
