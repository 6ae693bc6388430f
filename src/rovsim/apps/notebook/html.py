"""Results as HTML in a notebook: headings, sentences, tables and pictures, without downloads."""

import base64
import io
from html import escape
from typing import Iterable

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from pandas import DataFrame

from rovsim.reporting.figures.style import styled
from rovsim.reporting.wording import significant

SCREEN_DPI = 110  # a text column is 650 pixels wide


def heading(text: str) -> str:
    """Return a heading, smaller than those of the notebook itself."""
    return f"<h4>{escape(text)}</h4>"


def sentences(lines: Iterable[str]) -> str:
    """Return a list of sentences; empty where there are none."""
    items = "".join(f"<li>{escape(line)}</li>" for line in lines)
    return f"<ul>{items}</ul>" if items else ""


def table(frame: DataFrame) -> str:
    """Return a table with numbers as reports print them."""
    return str(frame.to_html(float_format=significant, na_rep="–", border=0))


def picture(figure: Figure, caption: str) -> str:
    """Return a figure with its caption, which screen readers read as well."""
    data = base64.b64encode(png(figure)).decode()
    image = f'<img alt="{escape(caption, quote=True)}" src="data:image/png;base64,{data}">'
    return f"<figure>{image}<figcaption>{escape(caption)}</figcaption></figure>"


def png(figure: Figure) -> bytes:
    """Draw a figure for the screen; returns the content of a PNG file."""
    with styled():
        figure.set_dpi(SCREEN_DPI)
        buffer = io.BytesIO()
        FigureCanvasAgg(figure).print_png(buffer)
    return buffer.getvalue()


def displayed(figure: Figure) -> Figure:
    """Return the same figure, made such that a notebook shows it by itself.

    IPython asks an object for `_repr_png_`; it knows Matplotlib's figures only after pyplot was
    imported, which these figures do not use.
    """
    vars(figure)["_repr_png_"] = lambda: png(figure)
    return figure
