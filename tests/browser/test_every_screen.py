"""Every screen: its size, its axes, its colours, and what axe-core says of it."""

import re

import pytest

from chromium import DARK
from screens import READY, have_diagnosed

pytestmark = pytest.mark.browser
# Least distance in px between the lower edge of a chart's legend and its icons, once all is drawn.
APART = """() => {
  const charts = [...document.querySelectorAll('.chart')].map(
    div => getElement(div.id.slice(1))?.chart?._componentsViews);
  if (charts.includes(undefined)) return null;  // what draws them is loaded on first use
  const box = view => {
    const rect = view.group.getBoundingRect().clone();
    rect.applyTransform(view.group.transform ?? [1, 0, 0, 1, 0, 0]);
    return rect;
  };
  return {px: Math.min(1e6, ...charts.flatMap(views => {
    const of = type => views.find(v => v.type == type);
    const [legend, icons] = [of("legend.scroll"), of("toolbox")];
    const middle = icons && box(icons).y + 0.5 * box(icons).height;  // room for labels is around
    return legend && icons ? [middle - 8 - box(legend).y - box(legend).height] : [];
  }))};
}"""


# What stands along the axes of every chart.
TICKS = """() => [...document.querySelectorAll('.chart')].flatMap(div => {
  const model = getElement(div.id.slice(1)).chart.getModel();
  return ['xAxis', 'yAxis'].flatMap(name => model.queryComponents({mainType: name})).flatMap(
    one => one.axis.getViewLabels().map(label => label.formattedLabel));
})"""
HYPHENED = re.compile(r"(?<![\w.-])-\d")  # a number below zero without a minus sign


@pytest.mark.parametrize("screen", ["compare", "where", "why", "add", "models"])
def test_numbers_below_zero_have_a_minus_sign(tab, screen):
    have_diagnosed(tab)
    tab.go(screen)
    tab.page.wait_for_selector(READY[screen])
    tab.page.wait_for_selector(".chart canvas")
    shown = [*tab.page.evaluate(TICKS), *tab.page.locator(".screen").inner_text().splitlines()]
    assert [one for one in shown if HYPHENED.search(one)] == []
    assert any("−" in one for one in shown)


@pytest.mark.parametrize("screen", ["compare", "where", "add", "models"])
def test_where_axes_are_shown_it_says_which_way_they_point(tab, screen):
    tab.go(screen)
    tab.page.get_by_text("heave down").wait_for()


@pytest.mark.parametrize("screen", READY)
def test_every_screen_fits_a_desk_and_a_phone(tab, phone, screen):
    for one in (tab, phone):
        if screen in ("why", "add", "ladder"):
            have_diagnosed(one)
        one.go(screen)
        page = one.page
        page.wait_for_selector(READY[screen])
        apart = page.wait_for_function(APART).json_value()["px"]
        assert apart > 0, f"{screen}: icons cover the legend by {-apart} px"
        wide = page.evaluate("document.scrollingElement.scrollWidth - innerWidth")
        assert wide <= 0, f"{screen} is {wide} px too wide"
        small = page.evaluate(
            "Math.min(...[...document.querySelectorAll('.screen *')].filter(e => e.offsetWidth"
            " && [...e.childNodes].some(n => n.nodeType == 3 && n.data.trim()))"
            ".map(e => parseFloat(getComputedStyle(e).fontSize)))"
        )
        assert small >= 11
    if screen == "why":
        phone.picture("phone-why")


def test_every_screen_is_accessible_in_light_and_dark(tab, planned):
    pytest.importorskip("axe_playwright_python")
    have_diagnosed(tab)
    broken, shades = [], set()
    for screen, ready in {
        **READY,
        "open": "h1",
        "gallery/thruster_lag": "h1",
        "gallery/onboard_control": "h1",  # the widest equation
        planned[0]: "ol",
    }.items():
        tab.go(screen)
        tab.page.wait_for_selector(ready)
        for scheme in tab.schemes():
            shades.add(tab.page.evaluate("getComputedStyle(document.body).backgroundColor"))
            broken += [f"{screen}, {scheme}: {one}" for one in tab.violations()]
    assert broken == []
    assert len(shades) == 2


def test_light_and_dark_turn_and_are_remembered(tab):
    tab.page.emulate_media(color_scheme="light")
    tab.go("gallery")
    assert not tab.page.evaluate(DARK)
    tab.picture("effects")
    tab.page.get_by_role("button", name="Light or dark").click()
    tab.page.wait_for_function(DARK)
    tab.go("gallery")
    tab.page.wait_for_function(DARK)
