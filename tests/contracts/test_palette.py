"""Curves can be seen, on white and on the workbench's dark page, and told apart by everybody."""

import itertools

import numpy as np
import pytest
from matplotlib.colors import to_rgb

from rovsim.benchmarks.speed import plots
from rovsim.reporting.figures import budget
from rovsim.reporting.figures.palette import FAMILIES, MIN_CONTRAST, contrast, looks

MODELS = ("nominal", "refitted", "repaired", "new", "third", "fourth", "fifth", "knn_3dof",
          "knn_6dof", "effects+knn_6dof", "gp_6dof", "svgp_6dof", "zero_acceleration")  # fmt: skip
DARK = "#121212"  # --paper of style.css
# Machado, Oliveira and Fernandes (2009): what is seen without red, green or blue cones, linear RGB.
SEEN = {
    "all": np.eye(3),
    "no red": np.array(
        [
            [0.152286, 1.052583, -0.204868],
            [0.114503, 0.786281, 0.099216],
            [-0.003882, -0.048116, 1.051998],
        ]
    ),
    "no green": np.array(
        [
            [0.367322, 0.860646, -0.227968],
            [0.280085, 0.672501, 0.047413],
            [-0.011820, 0.042940, 0.968881],
        ]
    ),
    "no blue": np.array(
        [
            [1.255528, -0.076749, -0.178779],
            [-0.078411, 0.930809, 0.147602],
            [0.004733, 0.691367, 0.303900],
        ]
    ),
}
XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])


def linear(color):
    """Linear RGB (3,)."""
    c = np.array(to_rgb(color))
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)


def lab(color, seen):
    """CIE L*a*b* of what is seen of a colour."""
    x = XYZ @ np.clip(seen @ linear(color), 0.0, 1.0) / XYZ.sum(axis=1)
    f = np.where(x > 0.008856, np.cbrt(x), 7.787 * x + 16.0 / 116.0)
    return np.array([116.0 * f[1] - 16.0, 500.0 * (f[0] - f[1]), 200.0 * (f[1] - f[2])])


def on_the_dark_page(color):
    """A colour as `invert(0.93) hue-rotate(180deg)` of style.css leaves it (Filter Effects 1)."""
    grey = np.tile([0.213, 0.715, 0.072], (3, 1))
    inverted = 0.93 - 0.86 * np.array(to_rgb(color))
    return np.clip((2.0 * grey - np.eye(3)) @ inverted, 0.0, 1.0)


@pytest.mark.parametrize("name", MODELS)
def test_a_curve_can_be_seen_on_white_and_on_the_dark_page(name):
    color = looks(MODELS)[name].color
    assert contrast(color) >= MIN_CONTRAST
    assert contrast(DARK) / contrast(on_the_dark_page(color)) >= MIN_CONTRAST


@pytest.mark.parametrize(
    "color",
    [
        *(one.color for one in (*budget.PART_LOOKS.values(), *budget.ADDED_PART_LOOKS)),
        *plots.COLORS.values(),
        *(color for names in plots.PANEL_COLORS.values() for color in names.values()),
    ],
)
def test_other_curves_can_be_seen_too(color):
    assert contrast(color) >= MIN_CONTRAST


def test_parts_and_libraries_of_one_panel_are_told_apart():
    for drawn in (*plots.PANEL_COLORS.values(), plots.COLORS):
        assert len(set(drawn.values())) == len(drawn)
    looks = [
        (one.color, one.dash) for one in (*budget.PART_LOOKS.values(), *budget.ADDED_PART_LOOKS)
    ]
    assert len(set(looks)) == len(looks)
    for (one, dash), (other, same) in itertools.combinations(looks, 2):
        if dash == same:
            assert np.linalg.norm(lab(one, SEEN["all"]) - lab(other, SEEN["all"])) > 30.0


def test_members_of_a_family_differ_by_dashes_whatever_the_base():
    for names in (
        ("repaired", "new", "third", "fourth"),
        ("nominal", "refitted"),
        ("knn_6dof", "knn_3dof", "effects+knn_6dof"),
    ):
        dashes = [look.dash for look in looks(names).values()]
        assert len(set(dashes)) == len(names)


def test_effects_are_told_from_every_other_family_by_all_readers():
    own = FAMILIES["effects"].color
    for seen, (name, look) in itertools.product(SEEN.values(), FAMILIES.items()):
        if name != "effects":
            assert np.linalg.norm(lab(own, seen) - lab(look.color, seen)) > 20.0
