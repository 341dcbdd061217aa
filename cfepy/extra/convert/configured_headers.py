"""Headers that CMake's `configure_file` makes from a template of the package.

CMake is not started. The text gets the values that the reader of CMakeLists.txt has. A template with a variable that
the reader does not know, such as the output of a program, makes no header, so that no node gets a wrong value.
"""

from __future__ import annotations

import hashlib
import os
import re
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

from cfepy.extra.c import cache_folder, mark_used, writing_cache
from cfepy.extra.convert.cpp_package import CppPackage
from cfepy.reading.contained_files import write_contained

HEADERS = (".h", ".hh", ".hpp", ".hxx", ".inl", ".ipp", ".tpp")
_NAME = r"[A-Za-z0-9/_.+-]+"
_AT = re.compile(rf"@({_NAME})@")
_BOTH = re.compile(rf"@({_NAME})@|\$\{{({_NAME})\}}|(\$ENV\{{{_NAME}\}})")
_DEFINE = re.compile(r"#([ \t]*)cmakedefine(01)?[ \t]+([A-Za-z_]\w*)([^\n]*)")
_FALSE = ("", "0", "OFF", "NO", "FALSE", "N", "IGNORE", "NOTFOUND")


def configured_text(template: str, variables: Mapping[str, Sequence[str]], options: Sequence[str] = ()) -> str | None:
    """Return the text that CMake makes from a template, or None if it uses an unknown variable.

    Args:
        template: the text of the input.
        variables: of CMake, by name.
        options: words behind the names of both files, such as "@ONLY".
    """
    if "COPYONLY" in options:
        return template
    unknown: list[str] = []

    def value(found: re.Match[str]) -> str:
        name = next(filter(None, found.groups()))
        if name not in variables:
            unknown.append(name)
        text = ";".join(variables.get(name, ()))
        return text.replace('"', '\\"') if "ESCAPE_QUOTES" in options else text

    names = _AT if "@ONLY" in options else _BOTH
    text = names.sub(value, _DEFINE.sub(lambda found: _definition(found, variables), template))
    return None if unknown else text


def _definition(found: re.Match[str], variables: Mapping[str, Sequence[str]]) -> str:
    indent, is_number, name, rest = found.groups()
    value = ";".join(variables.get(name, ())).upper()
    is_true = value not in _FALSE and not value.endswith("-NOTFOUND")
    if is_number:
        return f"#{indent}define {name} {int(is_true)}{rest}"
    return f"#{indent}define {name}{rest}" if is_true else f"/* #{indent}undef {name} */"


def include_folders(package: CppPackage, folders: Iterable[Path]) -> list[Path]:
    """Return the existing folders of headers, each behind a folder with the headers that CMake makes in it.

    Args:
        package: has the configured headers.
        folders: as its CMakeLists.txt lists them.
    """
    return list(dict.fromkeys(_with_made(package.configured, folders)))


def _with_made(configured: Mapping[Path, str], folders: Iterable[Path]) -> Iterator[Path]:
    for folder in folders:
        root = Path(os.path.normpath(folder))
        inside = {str(each.relative_to(root)): configured[each] for each in configured if each.is_relative_to(root)}
        if inside:
            yield _kept(inside)
        if os.path.isdir(folder):
            yield folder


def _kept(headers: Mapping[str, str]) -> Path:
    """Return a folder in the cache with headers, by their content."""
    digest = hashlib.sha256()
    for name, text in sorted(headers.items()):
        digest.update(f"{name}\0{text}\0".encode())
    cache = cache_folder() / "roscfe"
    kept = cache / f"configured-{digest.hexdigest()[:16]}"
    mark_used(kept)
    if not kept.is_dir():
        with writing_cache(cache):
            cache.mkdir(exist_ok=True)
            with tempfile.TemporaryDirectory(dir=cache) as scratch:
                made = Path(scratch) / "made"
                (made / "include").mkdir(parents=True)
                for name, text in headers.items():
                    write_contained(made / "include", f"/{name}", text.encode())
                try:
                    os.rename(made, kept)
                except OSError:
                    if not kept.is_dir():  # otherwise another process was quicker
                        raise
    return kept / "include"
