"""Equations as MathML: every browser shows it, nothing is fetched, nothing in it is ever run."""

from html import escape


def mathml(latex: str) -> str:
    """An equation in LaTeX as MathML; one that is none, or hides something, as it is written.

    Equations come from files, of strangers too. The converter passes text on as it is, so that
    `\\text{<img onerror=…>}` would be an element of the page, and knows links and styles.
    """
    from latex2mathml.converter import convert

    try:
        markup = convert(latex.replace("<", r"\lt ").replace(">", r"\gt "))
    except Exception:  # it has a dozen errors of its own, and raises IndexError and others besides
        markup = ""
    harmless = markup and " href=" not in markup and " style=" not in markup
    return markup if harmless else f"<code>{escape(latex)}</code>"
