"""What the site makes of the pages: formulas as MathML, and pages that are written from the types.

The pages themselves stay readable where they lie: `math` fences and links into the repository are
those of the web pages of the usual hosts of Git repositories.
"""

import json
import pkgutil
import re
from importlib import import_module
from inspect import cleandoc
from pathlib import Path

import limits
from latex2mathml.converter import convert
from mkdocs.structure.files import File
from mkdocs.utils import get_relative_url

import rovsim.results
from rovsim.results.base import Result

BLOCK = re.compile(r"^```math\n(.*?)\n```$", re.DOTALL | re.MULTILINE)
INLINE = re.compile(r"\$`(.+?)`\$")
ELSEWHERE = re.compile(r"\[([^\]]*)\]\(\.\./[^)]*\)")  # links to files beside docs/
RESULTS, LIMITS = "reference/results.md", "reference/limits.md"
SHIM, WORKER = "https://unpkg.com/iframe-worker/shim", "assets/iframe-worker.js"
HERE = Path(__file__).parent


def on_page_markdown(markdown, **_):
    """Formulas without a script, and names in place of links that leave the site."""
    markdown = BLOCK.sub(
        lambda found: f"\n<div>{convert(found[1], display='block')}</div>\n", markdown
    )
    markdown = INLINE.sub(lambda found: convert(found[1]), markdown)
    return ELSEWHERE.sub(r"\1", markdown)


def on_post_page(output, page, **_):
    """The search of pages opened from a folder fetches nothing."""
    return output.replace(SHIM, get_relative_url(WORKER, page.url))


def on_files(files, config):
    """The pages on result files, their JSON schemas and limits, and what the search needs."""
    files.append(File.generated(config, WORKER, content=(HERE / "iframe-worker.js").read_text()))
    found = sorted(_results(), key=lambda one: one.noun)
    files.append(File.generated(config, RESULTS, content=_page(found)))
    numbers = limits.write_page(limits.find_limits())
    files.append(File.generated(config, LIMITS, content=numbers))
    for one in found:
        schema = json.dumps(one.model_json_schema(by_alias=True), indent=1)
        files.append(File.generated(config, _schema(one), content=schema))
    return files


def _results():
    for module in pkgutil.iter_modules(rovsim.results.__path__):
        import_module(f"rovsim.results.{module.name}")
    return Result.__subclasses__()


def _schema(result):
    return f"reference/schemas/{result.__name__}.json"


def _page(results):
    parts = [
        "# Result files\n",
        "Every JSON file that rovsim writes, as its type says. Each links to its JSON schema.\n",
    ]
    for one in results:
        schema = one.model_json_schema(by_alias=True)
        parts += [
            f"## {one.noun[0].upper()}{one.noun[1:]}\n",
            f"Written by {one.command} · [JSON schema](schemas/{one.__name__}.json)\n",
            *_table(schema),
        ]
        for name, part in schema.get("$defs", {}).items():
            if "properties" in part:
                parts += [f"**{name}**\n", *_table(part)]
    return "\n".join(parts)


def _table(schema):
    """What a section says of itself, and its keys."""
    rows = [f"| `{key}` | {_type(content)} |" for key, content in schema["properties"].items()]
    return [
        f"{cleandoc(schema.get('description', ''))}\n",
        "| key | type |",
        "|---|---|",
        *rows,
        "",
    ]


def _type(content):
    """A few words for the type of a property."""
    if "$ref" in content:
        return content["$ref"].rsplit("/", 1)[1]
    if "const" in content:
        return f"`{content['const']}`"
    if "enum" in content:
        return ", ".join(f"`{value}`" for value in content["enum"])
    if "anyOf" in content:
        return " or ".join(_type(one) for one in content["anyOf"])
    if content.get("type") == "array":
        inner = content.get("items") or {}
        return f"list of {_type(inner)}" if inner else "list"
    if isinstance(content.get("additionalProperties"), dict):
        return f"{_type(content['additionalProperties'])} by name"
    return content.get("type", "any")
