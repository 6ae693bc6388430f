"""Numbers below zero as people write them."""


def minus(number: str) -> str:
    """A number as people write it: with a minus sign, not a hyphen; a zero has no sign."""
    return number.replace("-", "−") if number.strip("-0.") else number.lstrip("-")
