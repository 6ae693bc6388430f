"""Words of the terminal and the report: whole phrases, one name for one thing."""

from rovsim.reporting.wording import listed


def test_a_phrase_is_listed_as_a_whole():
    phrases = [f"cubic_damping instead of {name}" for name in ("quadratic_damping", "lift")]
    assert listed(phrases) == " and ".join(phrases)
