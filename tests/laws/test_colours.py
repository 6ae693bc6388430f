"""What the workbench shows together, colour-blind readers can tell apart."""

from itertools import combinations

import numpy as np
import pytest
from matplotlib.colors import to_rgb

from rovsim.apps.workbench.charts import MARK_COLOR, styles
from rovsim.apps.workbench.where import FAINT_COLOR
from rovsim.reporting.figures.palette import BLUE

TOGETHER = ["measured", "nominal", "repaired", "knn_6dof", "gp_6dof", "zero_acceleration"]
# Machado, Oliveira and Fernandes 2009, table 1, severity 1.0; for linear RGB.
SEEN = {
    "fully": np.eye(3),
    "without red": [
        [0.152286, 1.052583, -0.204868],
        [0.114503, 0.786281, 0.099216],
        [-0.003882, -0.048116, 1.051998],
    ],
    "without green": [
        [0.367322, 0.860646, -0.227968],
        [0.280085, 0.672501, 0.047413],
        [-0.011820, 0.042940, 0.968881],
    ],
    "without blue": [
        [1.255528, -0.076749, -0.178779],
        [-0.078411, 0.930809, 0.147602],
        [0.004733, 0.691367, 0.303900],
    ],
}
TO_XYZ = [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]]  # sRGB, D65
NOTICED = 2.3  # CIE 1976 colour difference that is just noticed side by side (Mahy et al. 1994)


def lab(color, seen):
    """CIE L*a*b* of a colour as someone sees it."""
    rgb = np.array(to_rgb(color))
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    xyz = np.array(TO_XYZ) @ np.clip(np.array(seen) @ linear, 0, 1) / [0.9505, 1.0, 1.089]
    f = np.where(xyz > 0.008856, np.cbrt(xyz), 7.787 * xyz + 16 / 116)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


@pytest.mark.parametrize("who", SEEN)
def test_curves_shown_together_are_told_apart(who):
    for a, b in combinations(styles(TOGETHER).values(), 2):
        apart = np.linalg.norm(lab(a.color, SEEN[who]) - lab(b.color, SEEN[who]))
        assert apart > 3 * NOTICED, (a, b)
        assert a.dash != b.dash or apart > 10 * NOTICED, (a, b)


@pytest.mark.parametrize("who", SEEN)
@pytest.mark.parametrize("marked", [BLUE, MARK_COLOR])
def test_what_is_marked_stands_out_from_the_rest(who, marked):
    assert np.linalg.norm(lab(marked, SEEN[who]) - lab(FAINT_COLOR, SEEN[who])) > 10 * NOTICED
