"""Equations as MathML, which browsers show without fetching or running anything."""

from html import escape


def mathml(latex: str) -> str:
    """Convert an equation from LaTeX to MathML; return it as code where it is invalid or unsafe.

    Equations come from files, also from those of strangers. The converter passes text on as it is,
    so that `\\text{<img onerror=…>}` would become an element of the page, and it knows links and
    styles.
    """
    from latex2mathml.converter import convert

    try:
        markup = convert(latex.replace("<", r"\lt ").replace(">", r"\gt "))
    except Exception:  # it has a dozen errors of its own, and raises IndexError and others besides
        markup = ""
    harmless = markup and " href=" not in markup and " style=" not in markup
    return markup if harmless else f"<code>{escape(latex)}</code>"
