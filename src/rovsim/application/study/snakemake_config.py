"""The configuration that Snakemake was given: settings, and the effects that there are."""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Mapping, Sequence

from rovsim.application.configuration import compose
from rovsim.application.settings import Settings
from rovsim.core.errors import unlisted
from rovsim.dynamics.catalogue import Catalogue, load_catalogue

CONFIG_KEYS = ("campaign", "overrides", "effects_file")  # keys of `snakemake --config`


@dataclass(frozen=True)
class SnakemakeConfig:
    """The configuration that Snakemake was given.

    Attributes:
        config: Snakemake's `config`.
        keys: that the workflow knows.
    """

    config: Mapping[str, Any]
    keys: Sequence[str] = CONFIG_KEYS

    @cached_property
    def overrides(self) -> list[str]:
        """Hydra overrides of conf/, such as `residual=knn`."""
        entry = self.config.get("overrides") or []
        return split_words(entry) if isinstance(entry, str) else [str(item) for item in entry]

    @cached_property
    def settings(self) -> Settings:
        """Settings of conf/, with the overrides and effect files given to Snakemake."""
        base, effects_file = compose(self.overrides), self.config.get("effects_file")
        return base.model_copy(update={"effects_file": effects_file}) if effects_file else base

    @cached_property
    def catalogue(self) -> Catalogue:
        """All effects, with those of the user's own files.

        Raises:
            BadInput: one of the files cannot be used.
        """
        return load_catalogue(self.settings.effect_files)

    @cached_property
    def campaign_path(self) -> Path | None:
        """Path of the user's campaign; None for the synthetic one."""
        path = self.config.get("campaign", self.settings.campaign)
        return None if path is None else Path(str(path))

    def check(self) -> None:
        """Check that all keys are known.

        Raises:
            BadInput: a key is not.
        """
        for key in self.config:
            if key not in self.keys:
                problem = f"unknown key '{key}'"
                raise unlisted(key, self.keys, found=problem, where="snakemake --config")


def split_words(text: str) -> list[str]:
    """Split a text at spaces, except within quotes or brackets."""
    words, quote, depth = [""], "", 0
    for letter in text:
        if letter.isspace() and not quote and depth <= 0:
            words.append("")
            continue
        words[-1] += letter
        if quote:
            quote = "" if letter == quote else quote
        elif letter in "'\"":
            quote = letter
        else:
            depth += (letter in "[{(") - (letter in ")}]")
    return [word for word in words if word]
