"""The configuration: Hydra composes it from conf/, once; the library gets plain typed values."""

from pathlib import Path
from typing import Any, Sequence

from rovsim.application.settings import Settings
from rovsim.core.errors import BadInput, RovsimError, nearest, unlisted
from rovsim.core.schema import checked
from rovsim.core.shipped import conf_folders, conf_names


def compose(overrides: Sequence[str]) -> Settings:
    """Compose conf/config.yaml with Hydra overrides.

    Raises:
        BadInput: an override Hydra does not understand, or a value that does not fit.
    """
    from hydra import compose as hydra_compose
    from hydra import initialize_config_dir

    from rovsim.application.conf_search import first_folder

    words = [_allow_unlisted(word) for word in overrides]
    try:
        with initialize_config_dir(first_folder(), version_base="1.3"):
            return settings_of(hydra_compose("config", overrides=words))
    except RovsimError:
        raise
    except Exception as error:  # Hydra's own, and what odd words make it stumble over
        raise _refused(overrides, str(error)) from None


def sweep_folder(overrides: Sequence[str]) -> Path:
    """Where a sweep writes that begins now, by overrides of its first run that `compose` takes."""
    from hydra import compose as hydra_compose
    from hydra import initialize_config_dir

    from rovsim.application.conf_search import first_folder

    words = [_allow_unlisted(word) for word in overrides]
    with initialize_config_dir(first_folder(), version_base="1.3"):
        return Path(
            hydra_compose("config", overrides=words, return_hydra_config=True).hydra.sweep.dir
        )


def _allow_unlisted(word: str) -> str:
    """An override of the tank that Hydra takes though no file of `conf/tank` lists its key.

    A tank lists what is special about it; what else there is, `TankSettings` checks.
    """
    return f"++{word}" if word.startswith("tank.") else word


def _refused(overrides: Sequence[str], message: str) -> BadInput:
    """What is wrong with an override that Hydra refused, and what was probably meant."""
    chosen = [word for word in overrides if _is_choice(word)]
    for word in overrides:
        key, _, value = word.lstrip("+~").partition("=")
        options = conf_names(key) if key else []
        if options and value not in options:
            return unlisted(value, options, found=f"there is no {key} '{value}'", where=word)
        if key and not options and key.split(".")[0] not in ("hydra", "hydra/launcher"):
            known = _keys(chosen)
            if key not in known and key in message:
                return BadInput(
                    f"there is no key '{key}'",
                    where=word,
                    expected="a key of conf/config.yaml",
                    remedy=nearest(key, known),
                )
    if message.startswith("Ambiguous value"):
        word = next((word for word in overrides if word in message), overrides[0])
        return BadInput(
            f"several values ({word})",
            where=f"overrides {' '.join(overrides)}",
            expected="one value of each key",
            remedy="Add -m: then each value is a run of a sweep; or put a list into brackets.",
        )
    return BadInput(
        message.split("\n")[0].removeprefix("LexerNoViableAltException: ").rstrip("."),
        where=f"overrides {' '.join(overrides)}",
        expected="key=value with keys of conf/config.yaml and options of its groups",
        remedy="See docs/configuration.md for the keys.",
    )


def _is_choice(word: str) -> bool:
    """Whether an override chooses one of a group's options."""
    key, _, value = word.partition("=")
    return value in conf_names(key) if key else False


def _keys(chosen: Sequence[str]) -> list[str]:
    """Every key of the configuration with these options, dotted, and every group."""
    from rovsim.core.mappings import flattened

    groups = [path.name for folder in conf_folders() for path in folder.iterdir() if path.is_dir()]
    return [*groups, *flattened(compose(chosen).model_dump(mode="json"))]


def settings_of(composed: Any) -> Settings:
    """Typed settings of a composed Hydra configuration."""
    from omegaconf import OmegaConf

    plain = OmegaConf.to_container(composed, resolve=True)
    if isinstance(plain, dict):
        plain.pop("hydra", None)
    return checked(Settings, plain, "configuration")
