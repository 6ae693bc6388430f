"""The colours of all figures: each family of models has one colour and one line style.

Colours: Okabe and Ito, "Color Universal Design" (2008), told apart by colour-blind readers. Brown,
sky and olive are their orange, sky blue and yellow made darker: as they are, they have 2.3:1, 2.3:1
and 1.3:1 on white, and an orange that is only a little darker looks like their vermilion to many.
"""

import re
from dataclasses import dataclass, replace
from typing import Any, Iterable

from rovsim.reporting.wording import list_learners

Dash = str | tuple[float, tuple[float, ...]]
Style = dict[str, Any]  # keyword arguments of a Matplotlib artist


AREA_OPACITY = 0.25  # of an area: what lies behind it can still be read
MIN_CONTRAST = 3.0  # contrast on white of all that is drawn (WCAG 2.1, criterion 1.4.11)
BLACK, GREY = "#000000", "#949494"
BLUE, VERMILION, GREEN, PURPLE = "#0072B2", "#D55E00", "#009E73", "#CC79A7"
BROWN, SKY, OLIVE = "#7A2E00", "#3A93CE", "#8C7A00"
LIGHTNESS_STEP = 0.05  # of lightness, until a colour has that


@dataclass(frozen=True)
class Look:
    """Colour, line style and (for bars) hatch of one model."""

    color: str
    dash: Dash
    hatch: str = ""

    width: float = 0.9

    def line(self) -> Style:
        """Keyword arguments for a line."""
        return {"color": self.color, "linestyle": self.dash, "linewidth": self.width}

    def area(self) -> Style:
        """Keyword arguments for an area behind lines."""
        return {"facecolor": self.color, "alpha": AREA_OPACITY, "linewidth": 0}

    def bar(self) -> Style:
        """Keyword arguments for a bar; the hatch is white on the colour."""
        return {"facecolor": self.color, "edgecolor": "white", "linewidth": 0, "hatch": self.hatch}


FAMILIES = {
    "measured": Look(BLACK, "-", width=1.4),
    "nominal": Look(VERMILION, (0, (4, 1.5))),
    "knn": Look(BLUE, (0, (6, 1, 1, 1))),
    "gp": Look(GREEN, (0, (2, 0.8))),
    "svgp": Look(PURPLE, (0, (3, 1, 1, 1, 1, 1))),
    "effects": Look(BROWN, "-"),
    "zero_acceleration": Look(GREY, (0, (1, 1.2))),
    "commanded": Look("#666666", "-"),
    "noise_floor": Look("#555555", (0, (8, 3))),
}
# For learners that have no colour of their own, in the order of their names.
FURTHER_LOOKS = (Look(SKY, (0, (5, 1, 1, 1))), Look(OLIVE, (0, (4, 1, 2, 1))))

# Members of a family differ by lightness, dash and hatch: (share of white or black, dash, hatch).
# A share of white is less where the colour would be too light to be seen.
_MEMBER_VARIATIONS: list[tuple[float, Dash | None, str]] = [
    (0.0, None, ""),
    (0.45, (0, (10, 2, 2, 2)), "////"),
    (-0.4, (0, (9, 1.5)), "...."),
    (0.25, (0, (2, 2)), "xxxx"),
    (-0.6, (0, (5, 3)), "----"),
]


def family(name: str) -> str:
    """Return the family of a model's name; a user's own model file counts as `effects`."""
    if name in FAMILIES:
        return name
    words = re.split(r"[^a-z0-9]+", name.lower())
    for kind in list_learners():
        if kind in words:
            return kind
    return "nominal" if words[0] in ("nominal", "refitted") else "effects"


def is_learned(name: str) -> bool:
    """Whether a model has a residual, by its name."""
    return family(name) in list_learners()


def family_look(name: str) -> Look:
    """Return the look that all models of a family vary."""
    kind = family(name)
    if kind in FAMILIES:
        return FAMILIES[kind]
    further = sorted(set(list_learners()) - set(FAMILIES))
    return FURTHER_LOOKS[further.index(kind) % len(FURTHER_LOOKS)]


def looks(names: Iterable[str]) -> dict[str, Look]:
    """Return a distinct look for each name; those of the study's own models never change."""
    taken: set[tuple[str, int]] = set()
    by_name = {}
    for name in names:
        kind = family(name)
        member = _member(name)
        while (kind, member) in taken and member < 40:
            member += 1
        taken.add((kind, member))
        by_name[name] = _variant(family_look(name), member)
    return by_name


def _member(name: str) -> int:
    if name in FAMILIES:
        return 0
    if re.match(r"(effects|\+)", name) and is_learned(name):
        return 2
    return 1 if "3dof" in name or family(name) == "nominal" else 0


def _variant(look: Look, member: int) -> Look:
    shade, dash, hatch = _MEMBER_VARIATIONS[member % len(_MEMBER_VARIATIONS)]
    while shade > 0.0 and contrast(_mix(look.color, shade)) < MIN_CONTRAST:
        shade -= LIGHTNESS_STEP
    return replace(look, color=_mix(look.color, shade), dash=dash or look.dash, hatch=hatch)


def _mix(color: str, share: float) -> str:
    """Mix a colour with a share of white, or of black where the share is negative."""
    from matplotlib.colors import to_hex, to_rgb

    target = 1.0 if share > 0.0 else 0.0
    return to_hex([c + (target - c) * abs(share) for c in to_rgb(color)])


def contrast(color: str) -> float:
    """Return the contrast of a colour with white, 1 to 21, as WCAG 2.1 defines it."""
    from matplotlib.colors import to_rgb

    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in to_rgb(color)]
    luminance = sum(w * c for w, c in zip((0.2126, 0.7152, 0.0722), linear, strict=True))
    return 1.05 / (luminance + 0.05)
