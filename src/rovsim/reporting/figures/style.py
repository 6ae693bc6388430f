"""The style of all figures: as wide as an A4 text column, 9 pt Times-like type, light grids.

Matplotlib's settings are global, so `styled` sets them under a lock and puts them back: figures
may be drawn from several threads and leave no state behind.
"""

import threading
import warnings
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from typing import Any, Iterator

import matplotlib
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_pdf import FigureCanvasPdf
from matplotlib.figure import Figure

from rovsim.core.errors import BadInput
from rovsim.core.files import write_bytes

WIDTH_MM = 150.0  # text width of an A4 page with 30 mm margins
FONT_SIZE_PT = 9.0  # one step below 11 pt body text
DPI = 200  # PNG only; the PDF is drawn as lines
MM = 1 / 25.4  # inches

# STIX (Times-like) comes with matplotlib, so a figure looks the same on every machine;
# DejaVu Serif steps in for letters STIX lacks.
RC_PARAMS: dict[str, Any] = {
    "font.family": ["STIXGeneral", "DejaVu Serif"],
    "mathtext.fontset": "stix",
    "text.parse_math": False,  # run and model names may hold a dollar sign
    "font.size": FONT_SIZE_PT,
    "axes.labelsize": FONT_SIZE_PT,
    "axes.titlesize": FONT_SIZE_PT,
    "figure.labelsize": FONT_SIZE_PT,
    "figure.titlesize": FONT_SIZE_PT,
    "legend.fontsize": FONT_SIZE_PT,
    "xtick.labelsize": FONT_SIZE_PT - 1,
    "ytick.labelsize": FONT_SIZE_PT - 1,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.5,
    "axes.linewidth": 0.6,
    "axes.edgecolor": "#444444",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.formatter.limits": (-4, 5),
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "lines.linewidth": 0.9,
    "hatch.linewidth": 0.6,
    "legend.frameon": False,
    "figure.constrained_layout.use": True,
    "pdf.fonttype": 42,  # TrueType, so that text stays text
    "svg.hashsalt": "rovsim",
}

_lock = threading.RLock()


@contextmanager
def styled() -> Iterator[None]:
    """Draw in the thesis style; usable as `@styled()` on a function."""
    with _lock, matplotlib.rc_context(RC_PARAMS), warnings.catch_warnings():
        # a run whose name has letters that neither font has is drawn with boxes
        warnings.filterwarnings("ignore", message="Glyph .* missing from")
        yield


def sheet(height: float) -> Figure:
    """Return an empty figure of the page's text width and `height` in mm."""
    return Figure(figsize=(WIDTH_MM * MM, height * MM), layout="constrained")


def save(figure: Figure, folder: Path, name: str) -> list[Path]:
    """Write `name`.pdf and `name`.png into `folder`; same figure, same bytes.

    Raises:
        BadInput: `name` is not a plain file name.
    """
    if Path(name).name != name:
        raise BadInput(
            f"'{name}' is not a file name",
            where=folder,
            expected="a name without folders",
            remedy="Leave out slashes.",
        )
    with styled():
        _lay_out(figure)
        return [_save(figure, folder / f"{name}.{kind}") for kind in _WRITERS]


def _lay_out(figure: Figure) -> None:
    """Lay out a figure once for both files; else each would do it again, for half of its time."""
    figure.set_dpi(DPI)
    engine = figure.get_layout_engine()
    if engine is not None:
        engine.execute(figure)
        figure.set_layout_engine("none")


# `Figure.savefig` draws twice, the first time in order to lay out; its canvases draw once.


def _draw_pdf(figure: Figure, content: BytesIO) -> None:
    # without this the file would hold the time of writing
    FigureCanvasPdf(figure).print_pdf(content, metadata={"CreationDate": None})


def _draw_png(figure: Figure, content: BytesIO) -> None:
    figure.set_dpi(DPI)  # the PDF's canvas has changed it
    FigureCanvasAgg(figure).print_png(content)


_WRITERS = {"pdf": _draw_pdf, "png": _draw_png}


def _save(figure: Figure, path: Path) -> Path:
    content = BytesIO()  # an error while writing to a file would leave the PDF's canvas in disorder
    _WRITERS[path.suffix[1:]](figure, content)
    write_bytes(path, content.getvalue())
    return path
