"""How results look in a notebook: headings, sentences, tables, pictures; nothing from outside."""

import base64
import io
from html import escape
from typing import Iterable

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from pandas import DataFrame

from rovsim.reporting.figures.style import styled
from rovsim.reporting.wording import significant

SCREEN = 110  # dots an inch: a text column is 650 pixels wide


def heading(text: str) -> str:
    """A heading; a notebook's own stand above it."""
    return f"<h4>{escape(text)}</h4>"


def sentences(lines: Iterable[str]) -> str:
    """A list of sentences; none, where there are none."""
    items = "".join(f"<li>{escape(line)}</li>" for line in lines)
    return f"<ul>{items}</ul>" if items else ""


def table(frame: DataFrame) -> str:
    """Numbers as the reports print them."""
    return str(frame.to_html(float_format=significant, na_rep="–", border=0))


def picture(figure: Figure, caption: str) -> str:
    """A figure with its caption, which is what a screen reader says as well."""
    data = base64.b64encode(png(figure)).decode()
    image = f'<img alt="{escape(caption, quote=True)}" src="data:image/png;base64,{data}">'
    return f"<figure>{image}<figcaption>{escape(caption)}</figcaption></figure>"


def png(figure: Figure) -> bytes:
    """A figure for the screen."""
    with styled():
        figure.set_dpi(SCREEN)
        buffer = io.BytesIO()
        FigureCanvasAgg(figure).print_png(buffer)
    return buffer.getvalue()


def displayed(figure: Figure) -> Figure:
    """The same figure, which a notebook shows by itself.

    IPython asks an object for `_repr_png_`; it knows Matplotlib's figures only once pyplot, which
    these do without, was imported.
    """
    vars(figure)["_repr_png_"] = lambda: png(figure)
    return figure
