"""Hydrostatic stiffness of a surface vehicle."""

from rovsim.dynamics.body import Body
from rovsim.dynamics.effects.base import Coefficients, Parameter, Signature


class WaterplaneStiffness(Coefficients):
    """The waterplane rights a floating vehicle more or less stiffly than the vehicle file says."""

    id = "waterplane_stiffness"
    requires = "waterplane"
    equation = r"\tau = -\Delta k \cdot (z - z_0,\ \phi,\ \theta)"
    symbols = (
        (r"\Delta k", "stiffness that is missing"),
        ("z", "depth"),
        ("z_0", "depth at rest"),
        (r"\phi", "roll"),
        (r"\theta", "pitch"),
    )
    neglects = "large angles, coupling of heave and pitch, waves, and sides that are not vertical"
    source = "Fossen 2021, sec. 4.2 (the diagonal of G, small angles)"
    cause = (
        "Floats were moved or added, or the load lies higher or lower than when the metacentric "
        "height was found."
    )
    revealed_by = (
        "Push it down, list it and trim it by hand, one after the other, and let go: stiffness "
        "changes the period of each oscillation, damping only how soon it dies out."
    )
    signature = Signature({"roll": 600.0}, "roll", "roll angle")
    parameters = (
        Parameter("heave", "N/m", r"\Delta k_z", scale=100.0),
        Parameter("roll", "N m/rad", r"\Delta k_\phi", scale=5.0),
        Parameter("pitch", "N m/rad", r"\Delta k_\theta", scale=10.0),
    )

    def enter(self, body: Body) -> None:
        """Add to the stiffness."""
        body.waterplane = body.waterplane + self.values
