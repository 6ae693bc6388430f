"""`rovsim completion SHELL`: suggestions for the shell's Tab key, found without slow imports.

Hydra's own completion knows keys alone, neither commands nor files nor effects, and needs more than
a second. Here the configuration and the effects are read as text: an answer takes about 0.1 s.
"""

import os
import pkgutil
import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Iterable, Sequence

import rovsim
from rovsim.application.conf_groups import list_options
from rovsim.core.errors import BadInput, nearest
from rovsim.core.model_names import NOMINAL, ZERO_ACCELERATION
from rovsim.core.shipped import conf_file

PACKAGE_FOLDER = Path(rovsim.__file__).parent
EFFECTS_FOLDER, TARGETS_FOLDER = (
    PACKAGE_FOLDER / "dynamics/effects",
    PACKAGE_FOLDER / "application/export/targets",
)
COMMANDS_FOLDER = Path(__file__).with_name("commands")
HYDRA_KEYS = ("defaults", "hydra")
BUILT_IN_MODELS = (NOMINAL, ZERO_ACCELERATION)
OPTIONS = ("--help", "--quiet", "--json", "--multirun")
# Keys whose values are files: how such a file ends, after "/" for folders alone.
FILE_ENDINGS = {
    "campaign": "/", "out": "/", "model": ".yaml", "to": ".yaml", "diagnosis": ".json",
    "effects_file": ".py", "fly": ".csv", "folds.published": ".csv",
}  # fmt: skip
UNLISTED_LINE = "    listed = False"  # in a class: no effect of the catalogue
EFFECT_KEYS = ("effects", "between", "know")
HELP = """\
The Tab key finds commands, keys, options, effects and files.

bash and zsh: put `source <(rovsim completion bash)` (or zsh) into the file that
the shell reads when it starts, .bashrc or .zshrc.
fish: rovsim completion fish > ~/.config/fish/completions/rovsim.fish"""
SCRIPTS = {
    "bash": """_rovsim() {
  local IFS=$'\\n'
  COMPREPLY=($("${COMP_WORDS[0]}" completion bash "${COMP_LINE:0:COMP_POINT}" 2>/dev/null))
}
complete -o nospace -F _rovsim rovsim""",
    "zsh": """#compdef rovsim
_rovsim() {
  local -a found
  found=("${(@f)$("${words[1]}" completion zsh "${(j: :)words[1,CURRENT]}" 2>/dev/null)}")
  [[ -n $found ]] && compadd -Q -S '' -- $found
}
(( $+functions[compdef] )) || { autoload -Uz compinit && compinit }
compdef _rovsim rovsim""",
    "fish": """function _rovsim
  set -l words (commandline -opc)
  $words[1] completion fish (commandline -cp | string collect) 2>/dev/null
end
complete -c rovsim -f -a '(_rovsim)'""",
}


@dataclass(frozen=True)
class Word:
    """A word as it was typed (`raw`), and the value that it stands for."""

    raw: str
    value: str
    quote: str  # the one that is still open

    def typed(self, value: str) -> str:
        """Return a longer value as one would type it: escaped, unless after an open quote."""
        if self.quote:
            return self.quote + value
        return re.sub(r"([^\w\[\],.=/:+~@%-])", r"\\\1", value)


def complete(words: Sequence[str]) -> str:
    """Return the script of a shell, or suggestions for the end of a line, one a line.

    Args:
        words: name of the shell, then the unfinished line, if suggestions are asked for.

    Raises:
        BadInput: the shell is not known.
    """
    shell, *line = words or [""]
    if shell not in SCRIPTS:
        raise BadInput(
            f"no completion for '{shell}'" if shell else "no shell was named",
            where="rovsim completion",
            expected=f"one of {', '.join(SCRIPTS)}",
            remedy=nearest(shell, SCRIPTS) if shell else "For example: rovsim completion bash.",
        )
    if not line:
        return SCRIPTS[shell]
    try:
        return "\n".join(_answer(shell, line[0]))
    except Exception:  # whatever is odd about a line: the Tab key finds nothing, and says nothing
        return ""


def _answer(shell: str, line: str) -> list[str]:
    *before, last = split(line)
    names = [word.value for word in before[1:]]
    values = suggest(names, last.value)
    return [_format_suggestion(shell, last, value) for value in values]


def _format_suggestion(shell: str, word: Word, value: str) -> str:
    """Return a suggestion as a shell expects it: a finished word ends in a blank, but for fish.

    Args:
        shell: its name.
        word: that is being typed.
        value: value that the word may become.
    """
    typed = word.typed(value)
    if shell == "bash" and not word.quote:  # it takes a word to begin after the last = or :
        typed = typed[max(word.raw.rfind(mark) for mark in "=:") + 1 :]
    elif shell == "bash":
        typed = typed[1:]
    finished = not value.endswith(("=", "/", ".")) and "=[" not in value
    if shell == "fish" or not finished:
        return typed
    return typed + word.quote + " "


def split(line: str) -> list[Word]:
    """Split an unfinished line into words; the last one is being typed, and may be empty."""
    words, raw, value, quote, escaped = [], "", "", "", False
    for letter in line:
        if not (quote or escaped) and letter.isspace():
            if raw:
                words.append(Word(raw, value, ""))
            raw = value = ""
            continue
        raw += letter
        if escaped:
            value, escaped = value + letter, False
        elif letter == "\\" and quote != "'":
            escaped = True
        elif letter == quote:
            quote = ""
        elif letter in "'\"" and not quote:
            quote = letter
        else:
            value += letter
    return [*words, Word(raw, value, quote)]


def suggest(given: Sequence[str], word: str) -> list[str]:
    """List what `word` may become after the words `given`, of which the first is the command."""
    if not given:
        return _beginning(word, [*commands(), "completion"])
    command, *rest = given
    if command == "completion":
        return _beginning(word, SCRIPTS)
    if word.startswith("-"):
        return _beginning(word, OPTIONS)
    key, equals, value = word.partition("=")
    if equals:
        before, value = _last_item(value)
        return [f"{key}={before}{item}" for item in _values(command, key, value)]
    used = {item.partition("=")[0] for item in rest}
    files = _files(word, "") if command == "init" else []
    return [*files, *_keys(command, word, used)]


def commands() -> list[str]:
    """List the names of the commands."""
    return sorted(module.name for module in pkgutil.iter_modules([str(COMMANDS_FOLDER)]))


def _beginning(word: str, names: Iterable[str]) -> list[str]:
    return [name for name in names if name.startswith(word)]


def _last_item(value: str) -> tuple[str, str]:
    """Split a list that is being typed into what stands before its last item, and that item."""
    start = max(value.rfind("["), value.rfind(",")) + 1
    return (value[:start], value[start:]) if value.startswith("[") else ("", value)


def _keys(command: str, word: str, taken: set[str]) -> list[str]:
    """List keys of a command's help; once something is typed, also all of the configuration."""
    helped = own_keys(command)
    keys = [*helped, *settings()] if word else helped
    ends = [key[len(word) :] for key in keys if key.startswith(word) and key not in taken]
    return [word + end for end in dict.fromkeys(map(_step, ends))]


def own_keys(command: str) -> list[str]:
    """List the dotted keys that the help of a command names, in its order."""
    source = (COMMANDS_FOLDER / f"{command}.py").read_text(encoding="utf-8")
    return re.findall(r"(?<![\w.])([a-z_]+(?:\.\w+)*)=", source.split('"""')[1])


def _step(end: str) -> str:
    """Return the rest of a key up to its next dot, or with `=` where there is none."""
    inner, dot, _ = end.partition(".")
    return f"{inner}{dot or '='}"


def _values(command: str, key: str, value: str) -> list[str]:
    """List what a value may become: names first, then files."""
    if key == "to" and command == "export":
        return _beginning(
            value, [module.name for module in pkgutil.iter_modules([str(TARGETS_FOLDER)])]
        )
    names = [*list_options(key), *settings().get(key, ())]
    if key in EFFECT_KEYS:
        names += effects()
    elif key in ("model", "to"):
        names += BUILT_IN_MODELS
    files = _files(value, FILE_ENDINGS[key]) if key in FILE_ENDINGS else []
    return [*_beginning(value, names), *files]


def _files(start: str, ending: str) -> list[str]:
    """List folders and files whose path begins with `start`; files only with this ending.

    The ending "/" stands for folders alone.
    """
    _, _, name = start.rpartition("/")
    before = start[: len(start) - len(name)]
    place = Path(os.path.expanduser(before or "."))
    paths = []
    for entry in sorted(os.scandir(place), key=lambda item: item.name) if place.is_dir() else ():
        if entry.name.startswith(name) and (name or not entry.name.startswith(".")):
            if entry.is_dir():
                paths.append(f"{before}{entry.name}/")
            elif entry.name.endswith(ending):
                paths.append(before + entry.name)
    return paths


def effects() -> list[str]:
    """List the ids of the built-in effects, as their files declare them."""
    texts = (path.read_text(encoding="utf-8") for path in EFFECTS_FOLDER.glob("*.py"))
    classes = (
        body for text in texts for body in text.split("\nclass ") if UNLISTED_LINE not in body
    )
    return sorted(name for body in classes for name in re.findall(r'^    id = "(\w+)"', body, re.M))


@cache
def settings() -> dict[str, tuple[str, ...]]:
    """Return the dotted keys of the configuration, with the values that their lines name."""
    main = _text("config.yaml")
    groups = re.findall(r"^  - ([\w/]+): (\w+)", main, re.M)
    keys = _listed(main, "")
    for group, option in groups:
        text = _text(f"{group}/{option}.yaml")
        package = re.search(r"@package ([\w.]+)", text)
        keys |= {group: ()} | _listed(text, f"{package[1] if package else group}.")
    return keys


def _text(name: str) -> str:
    path = conf_file(name)
    return path.read_text(encoding="utf-8") if path else ""


def _listed(text: str, before: str) -> dict[str, tuple[str, ...]]:
    """Return the dotted keys of one file of settings, with the values that their lines name.

    The file holds plain mappings, one key a line; `before` is put before each key.
    """
    choices: dict[str, tuple[str, ...]] = {}
    above: list[tuple[int, str]] = []
    for space, key, value in re.findall(r"^( *)(\w+):(.*)$", text, re.M):
        above = [level for level in above if level[0] < len(space)]
        name = "".join(f"{outer}." for _, outer in above) + key
        if not value.split("#")[0].strip():
            above.append((len(space), key))
        elif name.split(".")[0] not in HYDRA_KEYS:
            choices[before + name] = _choices(value)
    return choices


def _choices(value: str) -> tuple[str, ...]:
    """Return the values that a line of settings names: true and false, or `a | b` of a comment."""
    current, _, comment = value.partition("#")
    if current.strip() in ("true", "false"):
        return ("true", "false")
    comment = re.sub(r"\([^)]*\)", "", comment)
    match = re.match(r"\s*(\w+(?:\s*\|\s*\w+)+)", comment)
    return tuple(re.split(r"\s*\|\s*", match[1])) if match else ()
