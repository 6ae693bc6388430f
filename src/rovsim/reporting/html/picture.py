"""Drawn figures as pictures for a page.

This module imports no drawing library: where another process draws, the first one can use the
results without loading Matplotlib.
"""

from base64 import b64encode
from dataclasses import dataclass
from pathlib import Path
from typing import Sequence

from rovsim.core.errors import BadInput
from rovsim.reporting.figures import find_figure

Wanted = tuple[str, str]  # figure and run; no run for a figure that is drawn once


@dataclass(frozen=True)
class Picture:
    """A drawn figure.

    Attributes:
        name: of the figure.
        png: content of the file.
        about: what it shows of a run, as "run 6dof-2, 2 s windows"; empty for all runs.
        run: that it shows; empty for all runs.
    """

    name: str
    png: bytes
    about: str = ""
    run: str = ""

    @staticmethod
    def read(path: Path, name: str, about: str = "", run: str = "") -> "Picture":
        """Read a PNG that `rovsim.reporting.figures.style.save` wrote.

        Raises:
            BadInput: the file cannot be read or is no PNG.
        """
        try:
            png = path.read_bytes()
        except OSError as error:
            problem = f"cannot be read ({error.strerror})"
        else:
            if png.startswith(b"\x89PNG"):
                return Picture(name, png, about, run)
            problem = "is not a PNG picture"
        remedy = "Draw the figure again."
        raise BadInput(problem, where=path, expected="a figure of the study", remedy=remedy)

    @property
    def source(self) -> str:
        """The picture as a data URL."""
        return f"data:image/png;base64,{b64encode(self.png).decode()}"

    @property
    def caption(self) -> str:
        """The caption of the figure, with the run that it shows."""
        text = find_figure(self.name).caption
        return f"{self.about[0].upper()}{self.about[1:]}. {text}" if self.about else text


@dataclass(frozen=True)
class Drawn:
    """A figure that was asked for (figure and run), as a picture and as files."""

    wanted: Wanted
    picture: Picture
    files: Sequence[Path]
