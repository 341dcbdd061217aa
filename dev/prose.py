"""`python -m dev.prose [PATH ...]`: count riddles in docs, docstrings, error messages, help texts and test names.

A riddle describes a thing by a relative clause ("what is told", "that of the task") in place of its name, or hides the
actor ("is said", "nobody"). The program prints how often each pattern occurs in 10,000 words, by kind of text. The
table `tests/prose.tsv` has the number of riddles of each file, and a test holds that no number rises. `--write` lowers
the numbers of the table; it never raises one. With paths, the program prints each riddle of these files with its line.
"""

from __future__ import annotations

import argparse
import ast
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

from dev.house.tree import ROOT

TABLE = ROOT / "tests/prose.tsv"
FOLDERS = (
    *("cfepy", "rospy_shim", "rclpy_shim", "ros_libraries", "apps", "dev", "benchmarks", "tests", "docs"),
    *("missions", "ros_packages", "examples"),
)
RIDDLES = {
    "what": r"\bwhat\b",
    "told, said": r"\b(?:is|are|was|were|be|been|being) (?:told|said)\b|\b(?:tells|says)\b",
    "those of": r"\b(?:that|those) of\b",
    "nobody": r"\b(?:somebody|nobody|anybody|whoever|whomever)\b",
}
"""By name: patterns that stand for a thing without its name, or for an action without its actor."""
IN_ERRORS = RIDDLES | {"is no": r"\b(?:is|are) no\b|\bno such\b"}
IN_NAMES = {"test name": r"_(?:what|who|whoever|nobody|somebody|those)(?:_|$)"}
YOU = r"\byou(?:r|rs)?\b"
RAISERS = ("fail", "error", "UsageError")
HELPS = ("help", "description", "epilog")
"""Arguments of argparse whose texts `--help` prints."""
_CODE = re.compile(r"`[^`]*`")
_BLOCK = re.compile(r"^ *```.*?^ *```", re.MULTILINE | re.DOTALL)
_TARGET = re.compile(r"\]\([^)]*\)")


class Text(NamedTuple):
    """A text that people read: its kind, its file, its first line, and its words without code."""

    kind: str
    file: str
    line: int
    words: str


class Riddle(NamedTuple):
    """One place where a pattern matches."""

    text: Text
    pattern: str
    line: int
    match: str


def texts_of(path: Path) -> Iterator[Text]:
    """Yield the texts of a file in Python or Markdown."""
    file = path.relative_to(ROOT).as_posix() if path.is_relative_to(ROOT) else str(path)
    source = path.read_text(encoding="utf-8")
    if path.suffix == ".md":
        yield Text("docs", file, 1, _plain(source))
    elif path.suffix == ".py":
        yield from _in_python(ast.parse(source), file)


def _plain(markdown: str) -> str:
    """Return Markdown without blocks of code, tables, code and targets of links; line numbers stay."""
    text = _BLOCK.sub(lambda block: "\n" * block[0].count("\n"), markdown)
    text = re.sub(r"^\|.*$", "", text, flags=re.MULTILINE)
    return _TARGET.sub("]", _CODE.sub("x", text))


def _in_python(tree: ast.Module, file: str) -> Iterator[Text]:
    nodes = list(ast.walk(tree))
    raised = {id(node.exc) for node in nodes if isinstance(node, ast.Raise)}
    for node in nodes:
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            text = ast.get_docstring(node, clean=False)
            if text:
                yield Text("docstrings", file, node.body[0].lineno, _CODE.sub("x", text))
        if isinstance(node, ast.FunctionDef) and node.name.startswith("test_"):
            yield Text("test names", file, node.lineno, node.name)
        if isinstance(node, ast.Call) and (id(node) in raised or _name_of(node.func) in RAISERS):
            for part in node.args:
                words = " ".join(_strings(part))
                if words:
                    yield Text("errors", file, part.lineno, words)
        if isinstance(node, ast.Call):
            for given in node.keywords:
                words = " ".join(_strings(given.value)) if given.arg in HELPS else ""
                if words:
                    yield Text("help", file, given.value.lineno, _CODE.sub("x", words))


def _name_of(function: ast.expr) -> str:
    return function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")


def _strings(node: ast.expr) -> Iterator[str]:
    """Yield the constant parts of an expression of a text."""
    for each in ast.walk(node):
        if isinstance(each, ast.Constant) and isinstance(each.value, str):
            yield each.value


def riddles_in(text: Text) -> Iterator[Riddle]:
    """Yield the riddles of a text."""
    patterns = {"errors": IN_ERRORS, "test names": IN_NAMES}.get(text.kind, RIDDLES)
    for name, pattern in patterns.items():
        for match in re.finditer(pattern, text.words, re.IGNORECASE):
            yield Riddle(text, name, text.line + text.words.count("\n", 0, match.start()), match[0])


def files() -> Iterator[Path]:
    """Yield the files whose texts count: those in Python or Markdown of the checkout, but for generated pages."""
    yield from sorted(ROOT.glob("*.md"))
    for folder in FOLDERS:
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix in (".py", ".md") and not {"generated", "templates", "data"} & set(path.parts):
                yield path


def counts(paths: Iterable[Path]) -> dict[str, int]:
    """Return the number of riddles of each file that has any, by its path in the checkout."""
    found = Counter(riddle.text.file for path in paths for text in texts_of(path) for riddle in riddles_in(text))
    return dict(sorted(found.items()))


def read_table(path: Path = TABLE) -> dict[str, int]:
    """Return the numbers of the table, by file."""
    rows = (line.split("\t") for line in path.read_text(encoding="utf-8").splitlines())
    return {file: int(number) for number, file in rows}


def lowered(table: Mapping[str, int], now: Mapping[str, int]) -> dict[str, int]:
    """Return a table whose numbers are at most those of both; a file without riddles has no line."""
    return {file: min(number, now[file]) for file, number in table.items() if now.get(file)}


def write_table(table: Mapping[str, int], path: Path = TABLE) -> None:
    """Write a table, sorted by file."""
    path.write_text("".join(f"{number}\t{file}\n" for file, number in sorted(table.items())), encoding="utf-8")


def _print_summary() -> None:
    kinds: dict[str, list[Text]] = {}
    for path in files():
        for text in texts_of(path):
            kinds.setdefault(text.kind, []).append(text)
    for kind, texts in sorted(kinds.items()):
        number = len(texts) if kind == "test names" else sum(len(text.words.split()) for text in texts)
        found = Counter(riddle.pattern for text in texts for riddle in riddles_in(text))
        shares = [f"{name} {10_000 * count / number:.1f}" for name, count in sorted(found.items())]
        if kind == "docs":
            you = sum(len(re.findall(YOU, text.words, re.IGNORECASE)) for text in texts)
            shares.append(f"you {10_000 * you / number:.1f}")
        print(f"{kind:11} {number:8,} {'names' if kind == 'test names' else 'words'}; in 10,000: {', '.join(shares)}")


def main() -> None:
    """Count, print, and write the table when asked."""
    parser = argparse.ArgumentParser(prog="python -m dev.prose", description=__doc__)
    parser.add_argument("paths", metavar="PATH", nargs="*", type=Path, help="files whose riddles are printed")
    parser.add_argument("--write", action="store_true", help="lower the numbers of tests/prose.tsv")
    options = parser.parse_args()
    for path in options.paths:
        for text in texts_of(path.resolve()):
            for riddle in riddles_in(text):
                print(f"{text.file}:{riddle.line}: {text.kind}: {riddle.pattern}: {riddle.match}")
    if not options.paths:
        _print_summary()
    if options.write:
        now = counts(files())
        write_table(lowered(read_table(), now) if TABLE.exists() else now)


if __name__ == "__main__":
    main()
