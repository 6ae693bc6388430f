"""Text, tables, tiles and buttons that several screens share."""

import asyncio
import json
import re
from base64 import b64encode
from concurrent.futures import ThreadPoolExecutor
from html import escape
from pathlib import Path
from types import MappingProxyType
from typing import Any, Callable, Iterable, Mapping, Sequence

from nicegui import ui

from rovsim.apps.workbench.chart_axes import Options, with_minus
from rovsim.reporting.formula import mathml
from rovsim.reporting.wording import significant, title
from rovsim.results.base import or_nan

FONT = "Roboto, system-ui, sans-serif"
# Functions of charts.js
SAVE_FUNCTIONS = {"PNG": "savePicture", "SVG": "saveVectors", "CSV": "saveValues"}
Columns = Mapping[str, Any]  # what the columns of the CSV are called: see saveValues
NO_COLUMNS: Columns = MappingProxyType({})

# One thread computes: it uses all cores, and what was requested first is shown first.
_thread = ThreadPoolExecutor(1)


async def in_thread(function: Callable, *given: Any) -> Any:
    """Return `function(*given)`, computed in another thread, so that pages still respond."""
    return await asyncio.get_running_loop().run_in_executor(_thread, function, *given)


async def computed(function: Callable, *given: Any) -> Any:
    """As `in_thread`, for a screen: raises CancelledError if the screen was left meanwhile."""
    try:
        place = ui.context.slot.parent
    except RuntimeError:  # the control that was used has been drawn anew since
        place = None
    result = await in_thread(function, *given)
    if place is not None and place.is_deleted:
        raise asyncio.CancelledError
    return result


class Slider(ui.slider):
    """A slider that keeps up with a fast hand or key.

    NiceGUI's own slider sends every value back from the server, which resets the slider to that
    older position: of five quick key presses, two or three were lost.
    """

    LOOPBACK = False


def marked(words: str) -> str:
    """Return text as HTML; what stands between backticks is shown as code."""
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", escape(words))


class Failure(ui.html):
    """A message beside a control that failed; it stays until the control has worked."""

    def __init__(self) -> None:
        super().__init__(sanitize=False)
        self.classes("text warning").props('role="alert"')
        self.visible = False

    def tell(self, error: Exception | str) -> None:
        """Show the message."""
        self.content, self.visible = marked(str(error)), True

    def forget(self) -> None:
        """Remove the message."""
        self.content, self.visible = "", False


def heading(called: str, question: str) -> None:
    """Show the title of a screen, and the question it answers."""
    with ui.column().classes("heading"):
        ui.html(f"<h1>{escape(called)}</h1>", sanitize=False)
        ui.label(question).classes("question")


def text(words: str, classes: str = "") -> None:
    """Show a paragraph."""
    ui.html(f"<p>{marked(words)}</p>", sanitize=False).classes(f"text {classes}")


def about_axes(more: str = "") -> None:
    """Explain the axes, with the same words on every screen."""
    text(f"Axes are those of the body: surge ahead, sway to starboard, heave down{more}.", "soft")


def alarm(words: str) -> str:
    """Return a warning inside a line as HTML, with a sign and a colour; empty without words."""
    if not words:
        return ""
    sign = '<i class="q-icon material-icons" aria-hidden="true">warning</i>'
    return f'<span class="alarm">{sign} Warning: {escape(words)}</span>'


def section(called: str) -> None:
    """Show a heading inside a screen."""
    ui.html(f"<h2>{escape(called)}</h2>", sanitize=False)


def paragraphs(called: str, sentences: Iterable[str]) -> None:
    """Show sentences under a heading; nothing where there are none."""
    for place, words in enumerate(sentences):
        if not place:
            section(called)
        text(words)


def cell(value: float | None, name: str = "", text: str = "") -> str:
    """Return a table's cell with a number, as HTML.

    Args:
        value: in full in the attribute `data-value`; None is shown as a dash.
        name: in the attribute `data-name`, by which tests find the number.
        text: shown in place of three significant digits.
    """
    attribute = "" if value is None else f' data-value="{value!r}"'
    digits = str(value) if isinstance(value, int) else significant(or_nan(value))
    content = escape(text or digits)
    return f'<td class="number" data-name="{escape(name)}"{attribute}>{content}</td>'


def titled(models: Iterable[str]) -> dict[str, str]:
    """Return the titles of models, by the names that their files have."""
    return {name: title(name) for name in models}


def head(words: str) -> str:
    """Return a column's heading as HTML, with places where a long name may break."""
    return re.sub(r"([_+.])", r"\1<wbr>", escape(words))


def words(value: Any) -> str:
    """Return a table's cell with text, as HTML."""
    return f"<td>{escape(str(value))}</td>"


def table(
    caption: str,
    heads: Sequence[str],
    rows: Sequence[tuple[str, Sequence[str]]],
    groups: Sequence[tuple[str, int]] = (),
) -> None:
    """Show a table, which scrolls sideways where it is too wide.

    Args:
        caption: of the table.
        heads: heading of each column.
        rows: name and cells, as HTML, of each row.
        groups: headings above the columns after the first, each with its number of columns.
    """
    numeric = [
        "",
        *(c.startswith('<td class="number') and "number" for c in (rows or [("", ())])[0][1]),
    ]
    top = "".join(
        f'<th scope="col" class="{kind or ""}">{head(h)}</th>'
        for h, kind in zip(heads, numeric, strict=False)
    )
    above = "".join(
        f'<th scope="colgroup" colspan="{wide}">{escape(name)}</th>' for name, wide in groups
    )
    above = f"<tr><td></td>{above}</tr>" if groups else ""
    body = "".join(
        f'<tr><th scope="row">{escape(name)}</th>{"".join(cells)}</tr>' for name, cells in rows
    )
    ui.html(
        f'<div class="scroll" role="region" tabindex="0" aria-label="{escape(caption)}"><table>'
        f"<caption>{escape(caption)}</caption><thead>{above}<tr>{top}</tr></thead>"
        f"<tbody>{body}</tbody></table></div>",
        sanitize=False,
    )


def tile(called: str, value: float | None, name: str, note: str = "") -> ui.html:
    """Show a tile with an important number."""
    return ui.html(tile_html(called, value, name, note), sanitize=False).classes("tile")


def tile_html(called: str, value: float | None, name: str, note: str = "") -> str:
    """Return the content of a tile as HTML, for when its number changes."""
    attribute = "" if value is None else f' data-value="{value!r}"'
    return (
        f"<span>{escape(called)}</span><strong data-name='{escape(name)}'{attribute}>"
        f"{significant(or_nan(value))}</strong><small>{escape(note)}</small>"
    )


def chart(
    options: Options,
    about: str,
    height: int = 0,
    on_point_click: Callable | None = None,
    columns: Columns = NO_COLUMNS,
) -> ui.echart:
    """Show an ECharts chart, with buttons that save it as PNG, SVG and CSV.

    Args:
        options: of ECharts.
        about: what the chart shows, for screen readers.
        height: px; 0: as the style sheet says.
        on_point_click: called with the event of a click on a point.
        columns: headings of the CSV; those of the axes unless given.
    """
    common = {"animation": False, "textStyle": {"fontFamily": FONT}}
    element = ui.echart({**common, **with_minus(options)}, on_point_click)
    element.on("vnodeBeforeUnmount", js_handler="leftUndrawn")
    element.props.update({"role": "img", "aria-label": about})
    literal = json.dumps(dict(columns)).replace("<", "\\u003c")  # names of models are in it
    with ui.row().classes("keep"):
        for name, function in SAVE_FUNCTIONS.items():
            arguments = f"getElement({element.id}).chart, {literal}"
            saving(name, about).on("click", js_handler=f"() => {function}({arguments})")
    return element.classes("chart").style(f"height:{height}px" if height else "")


def saving(kind: str, about: str) -> ui.button:
    """Return a button that saves what is shown as a file of this kind."""
    button = ui.button(kind).props("flat dense no-caps")
    button.props.update({"aria-label": f"{kind}: {about}"})
    return button


def png(path: Path, about: str) -> None:
    """Show a PNG file, with a button that saves it."""
    content = b64encode(path.read_bytes()).decode()
    ui.html(
        f'<img src="data:image/png;base64,{content}" alt="{escape(about)}">', sanitize=False
    ).classes("picture")
    with ui.row().classes("keep"):
        saving("PNG", about).on_click(lambda: ui.download.file(path))


def bar(share: float, name: str = "") -> str:
    """Return a table's cell with a share (0 to 1) as a bar and in percent, as HTML."""
    width = 100.0 * max(0.0, min(1.0, share))
    return (
        f'<td class="bar" data-name="{escape(name)}" data-value="{share!r}">'
        f'<div><i style="width:{width:.1f}%"></i></div><b>{100 * share:.0f} %</b></td>'
    )


def onward(label: str, path: str) -> None:
    """Show a button that leads to the screen of the next question."""
    ui.button(label, icon="arrow_forward", on_click=lambda: ui.navigate.to(path)).props(
        "unelevated no-caps"
    ).classes("onward")


def in_a_terminal(line: str) -> None:
    """Show the command that does the same in a terminal."""
    ui.label("The same in a terminal").classes("soft")
    code = ui.code(line, language="bash")
    code.copy_button.props('aria-label="Copy the command" title="Copy"')


def formula(latex: str) -> None:
    """Show an equation; a wide one scrolls sideways, with the keyboard too."""
    element = ui.html(mathml(latex), sanitize=False).classes("formula")
    element.props('role="group" tabindex="0" aria-label="Equation"')
