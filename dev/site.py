"""Hooks of mkdocs (`mkdocs.yml`): add the pages outside of docs/ to the site, and adapt their links.

The links in the repository are for readers of its files. On the site, README, CONTRIBUTING and CHANGELOG are in
project/, texts of missions, ROS packages and examples in folders of their own. A link to a file that is not a page
becomes its text.
"""

from __future__ import annotations

import os.path
import posixpath
import re
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
FOLDERS = ("missions", "ros_packages", "examples")
PROJECT = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")
_LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)")
_FENCE = re.compile(r"(^```.*?^```)", re.MULTILINE | re.DOTALL)


def pages() -> dict[str, str]:
    """By path in the repository, the paths on the site of the pages that are not in docs/."""
    found = {name: f"project/{name}" for name in PROJECT}
    texts = [text for folder in FOLDERS for text in ROOT.glob(f"{folder}/*/README.md")]
    return found | {each: each for each in (path.relative_to(ROOT).as_posix() for path in texts)}


def slug(title: str, separator: str = "-") -> str:
    """Return the anchor of a heading, as GitHub makes it."""
    return re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", separator)


def linked(text: str, source: str) -> str:
    """Return the text of a page with links for its place on the site.

    Args:
        text: Markdown.
        source: its path in the repository.
    """
    outside = pages()
    here = posixpath.dirname(_place(source, outside))

    def link(found: re.Match[str]) -> str:
        mark, words, target = found.groups()
        file, hash_sign, anchor = target.partition("#")
        if not file or re.match(r"[a-z]+:", target):
            return found[0]
        path = posixpath.normpath(posixpath.join(posixpath.dirname(source), file))
        if path not in outside and not path.startswith("docs/"):
            return words if not mark else ""
        return f"{mark}[{words}]({posixpath.relpath(_place(path, outside), here or '.')}{hash_sign}{anchor})"

    parts = _FENCE.split(text)
    return "".join(part if number % 2 else _LINK.sub(link, part) for number, part in enumerate(parts))


def _place(path: str, outside: dict[str, str]) -> str:
    return outside[path] if path in outside else path.removeprefix("docs/")


# -- called by mkdocs --------------------------------------------------------------------------------------------------


def on_config(config: Any) -> Any:
    """Anchors are those that the links name."""
    config.mdx_configs.setdefault("toc", {})["slugify"] = slug
    return config


def on_files(files: Any, config: Any) -> Any:
    """Add the pages that are not in docs/."""
    from mkdocs.structure.files import File

    for path, place in pages().items():
        files.append(File.generated(config, place, abs_src_path=str(ROOT / path)))
    return files


def on_page_markdown(markdown: str, page: Any, config: Any, files: Any) -> str:
    """Links for where the page is."""
    return linked(markdown, os.path.relpath(page.file.abs_src_path, ROOT).replace(os.sep, "/"))
