"""Pieces that several screens share."""

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

from rovsim.apps.workbench.charts import Options, with_minus
from rovsim.reporting.formula import mathml
from rovsim.reporting.wording import significant, title
from rovsim.results.base import or_nan

FONT = "Roboto, system-ui, sans-serif"
# Functions of charts.js
SAVE = {"PNG": "savePicture", "SVG": "saveVectors", "CSV": "saveValues"}
Columns = Mapping[str, Any]  # what the columns of the CSV are called: see saveValues
NO_COLUMNS: Columns = MappingProxyType({})

# One thread computes: it uses all cores, and what was asked for first is shown first.
_thread = ThreadPoolExecutor(1)


async def in_thread(function: Callable, *given: Any) -> Any:
    """`function(*given)` in the computing thread, while pages stay alive."""
    return await asyncio.get_running_loop().run_in_executor(_thread, function, *given)


async def computed(function: Callable, *given: Any) -> Any:
    """The same for a screen: what was to follow ends where the screen was left meanwhile."""
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

    With NiceGUI's own, every value that reaches the server comes back and sets the slider to where
    it was by then: of five quick keys, two or three were lost.
    """

    LOOPBACK = False


def marked(words: str) -> str:
    """Text as HTML: what stands between backticks is what one types."""
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", escape(words))


class Failure(ui.html):
    """Why something failed, beside the control that was used: it stays until that has worked."""

    def __init__(self) -> None:
        super().__init__(sanitize=False)
        self.classes("text warning").props('role="alert"')
        self.visible = False

    def tell(self, error: Exception | str) -> None:
        """Show it."""
        self.content, self.visible = marked(str(error)), True

    def forget(self) -> None:
        """Show nothing: it has worked now."""
        self.content, self.visible = "", False


def heading(called: str, question: str) -> None:
    """Title of a screen, and the question it answers."""
    with ui.column().classes("heading"):
        ui.html(f"<h1>{escape(called)}</h1>", sanitize=False)
        ui.label(question).classes("question")


def text(words: str, classes: str = "") -> None:
    """A paragraph."""
    ui.html(f"<p>{marked(words)}</p>", sanitize=False).classes(f"text {classes}")


def about_axes(more: str = "") -> None:
    """What the axes are: the same words on every screen that shows some."""
    text(f"Axes are those of the body: surge ahead, sway to starboard, heave down{more}.", "soft")


def alarm(words: str) -> str:
    """A warning inside a line, as HTML: a sign and a colour of its own; empty without words."""
    if not words:
        return ""
    sign = '<i class="q-icon material-icons" aria-hidden="true">warning</i>'
    return f'<span class="alarm">{sign} Warning: {escape(words)}</span>'


def section(called: str) -> None:
    """A heading inside a screen."""
    ui.html(f"<h2>{escape(called)}</h2>", sanitize=False)


def paragraphs(called: str, sentences: Iterable[str]) -> None:
    """Sentences under a heading; nothing where there are none."""
    for place, words in enumerate(sentences):
        if not place:
            section(called)
        text(words)


def cell(value: float | None, name: str = "", told: str = "") -> str:
    """A number in a table, its full value in `data-value`, its name in `data-name`.

    `told`: the number in words, where three digits of it are not what people would write.
    """
    attribute = "" if value is None else f' data-value="{value!r}"'
    digits = str(value) if isinstance(value, int) else significant(or_nan(value))
    content = escape(told or digits)
    return f'<td class="number" data-name="{escape(name)}"{attribute}>{content}</td>'


def titled(models: Iterable[str]) -> dict[str, str]:
    """Names of models to choose from: as files call them, and as every screen does."""
    return {name: title(name) for name in models}


def head(words: str) -> str:
    """Text at the head of a column as HTML: a long name may go on in the next line."""
    return re.sub(r"([_+.])", r"\1<wbr>", escape(words))


def words(value: Any) -> str:
    """Text in a table."""
    return f"<td>{escape(str(value))}</td>"


def table(
    caption: str,
    heads: Sequence[str],
    rows: Sequence[tuple[str, Sequence[str]]],
    groups: Sequence[tuple[str, int]] = (),
) -> None:
    """A table of rows with a name and cells; it scrolls sideways where it is too wide.

    `groups`: what stands above the columns after the first, and above how many.
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
    """A number that matters."""
    return ui.html(tile_html(called, value, name, note), sanitize=False).classes("tile")


def tile_html(called: str, value: float | None, name: str, note: str = "") -> str:
    """The content of a tile, to be replaced when the number changes."""
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
    """An ECharts chart that says what it shows to those who do not see it.

    The CSV calls its `columns` as the axes are called, unless they are named.
    """
    common = {"animation": False, "textStyle": {"fontFamily": FONT}}
    element = ui.echart({**common, **with_minus(options)}, on_point_click)
    element.on("vnodeBeforeUnmount", js_handler="leftUndrawn")
    element.props.update({"role": "img", "aria-label": about})
    literal = json.dumps(dict(columns)).replace("<", "\\u003c")  # names of models are in it
    with ui.row().classes("keep"):
        for name, function in SAVE.items():
            arguments = f"getElement({element.id}).chart, {literal}"
            saving(name, about).on("click", js_handler=f"() => {function}({arguments})")
    return element.classes("chart").style(f"height:{height}px" if height else "")


def saving(kind: str, about: str) -> ui.button:
    """A button that saves what is shown as a file of this kind."""
    button = ui.button(kind).props("flat dense no-caps")
    button.props.update({"aria-label": f"{kind}: {about}"})
    return button


def png(path: Path, about: str) -> None:
    """A picture that lies in a file, to be saved as well."""
    content = b64encode(path.read_bytes()).decode()
    ui.html(
        f'<img src="data:image/png;base64,{content}" alt="{escape(about)}">', sanitize=False
    ).classes("picture")
    with ui.row().classes("keep"):
        saving("PNG", about).on_click(lambda: ui.download.file(path))


def bar(share: float, name: str = "") -> str:
    """A share of one as a bar in a table, its number beside it."""
    width = 100.0 * max(0.0, min(1.0, share))
    return (
        f'<td class="bar" data-name="{escape(name)}" data-value="{share!r}">'
        f'<div><i style="width:{width:.1f}%"></i></div><b>{100 * share:.0f} %</b></td>'
    )


def onward(label: str, path: str) -> None:
    """The way to the next question."""
    ui.button(label, icon="arrow_forward", on_click=lambda: ui.navigate.to(path)).props(
        "unelevated no-caps"
    ).classes("onward")


def in_a_terminal(line: str) -> None:
    """The command that does the same."""
    ui.label("The same in a terminal").classes("soft")
    code = ui.code(line, language="bash")
    code.copy_button.props('aria-label="Copy the command" title="Copy"')


def formula(latex: str) -> None:
    """An equation; a wide one scrolls sideways, with the keyboard too."""
    element = ui.html(mathml(latex), sanitize=False).classes("formula")
    element.props('role="group" tabindex="0" aria-label="Equation"')
