"""Compose the configuration from conf/ with Hydra, once, into plain typed settings."""

from pathlib import Path
from typing import Any, Sequence

from rovsim.application.conf_groups import list_options
from rovsim.application.settings import Settings
from rovsim.core.errors import BadInput, RovsimError, nearest, unlisted
from rovsim.core.schema import checked
from rovsim.core.shipped import conf_folders


def compose(overrides: Sequence[str]) -> Settings:
    """Compose conf/config.yaml with Hydra overrides.

    Args:
        overrides: words such as `residual=knn`.

    Raises:
        BadInput: an override that Hydra does not understand, or a value that is not allowed.
    """
    from hydra import compose as hydra_compose
    from hydra import initialize_config_dir

    from rovsim.application.conf_search import first_folder

    escaped = [_allow_unlisted(override) for override in overrides]
    folder = first_folder()  # imports learners: what is wrong there is no fault of the overrides
    try:
        with initialize_config_dir(folder, version_base="1.3"):
            return settings_of(hydra_compose("config", overrides=escaped))
    except RovsimError:
        raise
    except Exception as error:  # Hydra's own errors, and any that odd words cause in it
        raise _refused(overrides, str(error)) from None


def sweep_folder(overrides: Sequence[str]) -> Path:
    """Return the folder into which a sweep writes that begins now.

    Args:
        overrides: of its first run; `compose` has accepted them.
    """
    from hydra import compose as hydra_compose
    from hydra import initialize_config_dir

    from rovsim.application.conf_search import first_folder

    escaped = [_allow_unlisted(override) for override in overrides]
    with initialize_config_dir(first_folder(), version_base="1.3"):
        return Path(
            hydra_compose("config", overrides=escaped, return_hydra_config=True).hydra.sweep.dir
        )


def _allow_unlisted(word: str) -> str:
    """Let Hydra accept an override of a key of the tank that no file of `conf/tank` lists.

    A file there lists only what is special about a tank. `TankSettings` checks the keys later.
    """
    return f"++{word}" if word.startswith("tank.") else word


def _refused(overrides: Sequence[str], message: str) -> BadInput:
    """Make the error for overrides that Hydra refused, with what was probably meant.

    Args:
        overrides: all of them.
        message: of Hydra's error.
    """
    choices = [override for override in overrides if _is_choice(override)]
    for override in overrides:
        key, _, value = override.lstrip("+~").partition("=")
        options = list_options(key) if key else []
        if options and value not in options:
            return unlisted(value, options, found=f"there is no {key} '{value}'", where=override)
        if key and not options and key.split(".")[0] not in ("hydra", "hydra/launcher"):
            keys = _keys(choices)
            if key not in keys and key in message:
                return BadInput(
                    f"there is no key '{key}'",
                    where=override,
                    expected="a key of conf/config.yaml",
                    remedy=nearest(key, keys),
                )
    if message.startswith("Ambiguous value"):
        override = next((override for override in overrides if override in message), overrides[0])
        return BadInput(
            f"several values ({override})",
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
    return value in list_options(key) if key else False


def _keys(chosen: Sequence[str]) -> list[str]:
    """List every dotted key of the configuration, and every group.

    Args:
        chosen: overrides that choose options of groups.
    """
    from rovsim.core.mappings import flattened

    groups = [path.name for folder in conf_folders() for path in folder.iterdir() if path.is_dir()]
    return [*groups, *flattened(compose(chosen).model_dump(mode="json"))]


def settings_of(composed: Any) -> Settings:
    """Convert a composed Hydra configuration to typed settings.

    Raises:
        BadInput: a value is not allowed.
    """
    from omegaconf import OmegaConf

    container = OmegaConf.to_container(composed, resolve=True)
    if isinstance(container, dict):
        container.pop("hydra", None)
    return checked(Settings, container, "configuration")
