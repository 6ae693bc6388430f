"""`rovsim COMMAND key=value …`: one message and exit code 2 for input that cannot be used."""

import os
import pkgutil
import re
import sys
from pathlib import Path
from typing import Sequence

from rovsim import __version__
from rovsim.apps.cli.complaint import complain, describe_os_error
from rovsim.core.collector import end_at_once
from rovsim.core.columns import fold, fold_page
from rovsim.core.errors import BadInput, RovsimError, unlisted
from rovsim.core.model_names import BUILT_IN
from rovsim.core.termination import SIGTERM_EXIT, Terminated, heeding_termination

# Values taken as they are typed, whatever characters they hold; the rest are Hydra overrides.
QUOTED_KEYS = ("campaign", "model", "effects", "effects_file", "out", "diagnosis", "to", "fly")
FILE_COMMANDS = {"init": "files"}  # commands that take files, and the key they become
FLAG_OVERRIDES = {"--quiet": "output=quiet", "-q": "output=quiet", "--json": "output=json"}
OPTIONS = (*FLAG_OVERRIDES, "-m", "--multirun", "-h", "--help")
COMMANDS_FOLDER = Path(__file__).with_name("commands")
# of these: paths, of which -m takes several
SWEPT_PATH_KEYS = ("campaign", "model", "effects_file", "fly")
LISTS = ("model", "effects", "effects_file")  # of these: lists, in brackets


def main(arguments: Sequence[str] | None = None) -> None:
    """Run one command; exits with 0, or with 2 and one message for input that cannot be used."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    end_at_once()
    try:
        with heeding_termination():
            _main(words)
    except RovsimError as error:
        complain(str(error))
    except OSError as error:
        if isinstance(error, BrokenPipeError):
            sys.exit(141)
        complain(describe_os_error(error))
    except KeyboardInterrupt as end:
        reason, code = (
            ("terminated", SIGTERM_EXIT) if isinstance(end, Terminated) else ("interrupted", 130)
        )
        print(f"rovsim: {reason}; what was finished is kept.", file=sys.stderr)
        sys.exit(code)


def _main(words: list[str]) -> None:
    names = sorted(module.name for module in pkgutil.iter_modules([str(COMMANDS_FOLDER)]))
    if not words or words[0] in ("-h", "--help", "help"):
        print(_help(names))
        return
    if words[0] in ("-V", "--version"):
        print(f"rovsim {__version__}")
        return
    at = next((k for k, word in enumerate(words) if not word.startswith("-")), 0)
    command, rest = words[at], words[:at] + words[at + 1 :]  # options may stand before it
    if command == "completion":
        from rovsim.apps.cli.completion import HELP, complete

        print(HELP if asks_for_help(rest) else complete(rest))
        return
    if command not in names:
        raise unlisted(command, names, found=f"unknown command '{command}'", where="command line")
    if asks_for_help(rest):
        print(fold_page(_doc(command)))
        return
    sweep = bool({"-m", "--multirun"} & set(rest))
    words = [FLAG_OVERRIDES.get(word, word) for word in rest if word not in ("-m", "--multirun")]
    files = [word for word in words if command in FILE_COMMANDS and is_file(word)]
    overrides = [override(word, sweep) for word in words if word not in files]
    _require_distinct(overrides)
    if files:
        overrides.append(f"{FILE_COMMANDS[command]}=[{','.join(map(quoted, files))}]")
    _run(command, overrides, sweep)


def _require_distinct(overrides: Sequence[str]) -> None:
    """Refuse a key that is given twice, of which Hydra would take the last."""
    keys = [word.partition("=")[0] for word in overrides]
    for key in keys:
        if keys.count(key) > 1:
            several = f"For several, {key}=[A,B]." if key in LISTS else "Leave one of them out."
            raise BadInput(
                f"'{key}' is given {keys.count(key)} times",
                where="command line",
                expected="each key once",
                remedy=several,
            )


def _run(command: str, overrides: list[str], sweep: bool) -> None:
    from rovsim.application.configuration import compose
    from rovsim.apps.cli.dispatch import run_command
    from rovsim.apps.cli.untaken import require_taken

    whole = [f"command={command}", *overrides]
    if sweep:
        from rovsim.apps.cli.sweep import check_sweep, run_sweep

        campaigns = check_sweep(whole)
        require_taken(command, overrides)
        run_sweep(whole, campaigns)
        return
    settings = compose(whole)
    require_taken(command, overrides)
    run_command(settings)


def _help(names: Sequence[str]) -> str:
    lines = ["rovsim COMMAND key=value …", ""]
    for name in names:
        lines += fold(_doc(name).splitlines()[0], f"  {name:<9} ", " " * 12)
    lines += ["", "rovsim completion bash, zsh or fish: what the Tab key needs (`--help`)."]
    lines += ["rovsim COMMAND --help tells more; keys and their values stand in conf/."]
    lines += ["--quiet prints nothing but errors, --json the result as JSON; rovsim --version."]
    return "\n".join(lines)


def asks_for_help(words: Sequence[str]) -> bool:
    """Whether words of a command line ask what a command does."""
    return bool({"-h", "--help"} & set(words))


def _doc(name: str) -> str:
    """Return the docstring of a command without importing it, which would take seconds."""
    import ast

    source = (COMMANDS_FOLDER / f"{name}.py").read_text(encoding="utf-8")
    return ast.get_docstring(ast.parse(source)) or ""


def is_file(word: str) -> bool:
    """Whether a word names a file: one that exists, or a word that is no `key=value`."""
    return re.match(r"[\w.]+=", word) is None or os.path.exists(word)


def override(word: str, sweep: bool = False) -> str:
    """Return a word of the command line as a Hydra override; values of `QUOTED_KEYS` are quoted.

    In a sweep, files and folders with commas between them are one value each, if any of them is
    there.

    Raises:
        BadInput: the option is not known, or the word has no `=`.
    """
    key, equals, value = word.partition("=")
    if not equals and word.startswith("-"):
        raise unlisted(word, OPTIONS, found=f"unknown option '{word}'", where="command line")
    if not equals:
        raise BadInput(
            f"'{word}' has no '='",
            where="command line",
            expected="key=value",
            remedy="Quote values that hold spaces, for example campaign='my tank'.",
        )
    if key not in QUOTED_KEYS:
        return word
    if value.startswith("[") and value.endswith("]"):
        return f"{key}=[{','.join(quoted(item) for item in listed(value[1:-1]))}]"
    if key in SWEPT_PATH_KEYS and not os.path.exists(value):
        paths = listed(value)
        if not paths or any(os.path.exists(path) or path in BUILT_IN for path in paths):
            if len(paths) > 1 and not sweep:
                raise _several(key, value)
            return f"{key}={','.join(map(quoted, paths)) or 'null'}"
    return f"{key}={quoted(value)}"


def _several(key: str, value: str) -> BadInput:
    """Make the error for several paths where only a sweep takes them so."""
    brackets = f"For all of them at once, {key}=[{value}]. " if key in LISTS else ""
    return BadInput(
        f"'{value}' is several",
        where=f"command line, {key}",
        expected="one, or -m for one after the other",
        remedy=f"{brackets}For a run with each, add -m.",
    )


def listed(text: str) -> list[str]:
    """Split a comma-separated list; a comma that belongs to an existing path stays in it."""
    pieces, items = text.split(","), []
    while pieces:
        count = next(
            (n for n in range(len(pieces), 1, -1) if os.path.exists(",".join(pieces[:n]).strip())),
            1,
        )
        items.append(",".join(pieces[:count]).strip())
        pieces = pieces[count:]
    return [item for item in items if item]


def quoted(value: str) -> str:
    """Quote a string so that Hydra and OmegaConf take it literally; empty becomes null."""
    if value in ("null", "None", ""):
        return "null"
    literal = value.replace("'", "\\'").replace("${", "\\${")
    return f"'{literal}'"
