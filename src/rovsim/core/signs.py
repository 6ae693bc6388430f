"""Write negative numbers with a typographic minus sign."""


def minus(number: str) -> str:
    """Replace the hyphens of a formatted number by minus signs; a zero gets no sign."""
    return number.replace("-", "−") if number.strip("-0.") else number.lstrip("-")
