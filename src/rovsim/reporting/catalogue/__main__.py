"""Write the page and its pictures: python -m rovsim.reporting.catalogue [docs] [effect …]."""

import sys
from pathlib import Path

from rovsim.core.files import write_text
from rovsim.core.progress import reported
from rovsim.dynamics.catalogue import built_in
from rovsim.reporting.catalogue.entries import PAGE, PICTURES, page
from rovsim.reporting.catalogue.flight import seen, settings
from rovsim.reporting.figures.signature import draw_signature, write


def main(docs: Path, names: list[str]) -> None:
    """Write docs/catalogue.md, and the pictures of these effects (all if none is named)."""
    effects = {n: cls for n, cls in built_in().items() if cls.signature and n in (names or [n])}
    with reported("drawing") as progress:
        for k, (name, cls) in enumerate(effects.items()):
            progress(k, len(effects))
            if cls.signature:
                look = seen(cls.signature, settings(cls, cls.signature), built_in())
                write(draw_signature(look), docs / PICTURES / f"{name}.png")
        progress(len(effects), len(effects))
    write_text(docs / PAGE, page(built_in()))


if __name__ == "__main__":
    main(Path((sys.argv[1:] or ["docs"])[0]), sys.argv[2:])
