"""Write docs/reference/generated/api_map.md: every public function of cFE, OSAL and PSP 7.0.0, with its name here.

    python -m dev.pages.api_map

NASA's names are in tests/data/api, one file for each module; api_names.py maps them to the names here. Different and
absent names are read from the tables of docs/reference/differences.md: a name in a row differs as the row describes, or
is absent for its reason. So nothing is written twice, and a name without an entry is missing. The names that compiled
applications can call are read from the declarations of `cfepy.extra.c.api`, for which the engine is built.
"""

from __future__ import annotations

import argparse
import importlib
import re
from collections.abc import Iterator
from fnmatch import fnmatchcase
from itertools import groupby
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

from cfepy.extra.c.api import function_names
from cfepy.mission import Mission
from cfepy.writing.console import Console
from dev.pages.api_names import python_name

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "reference" / "generated" / "api_map.md"
DIFFERENCES = ROOT / "docs" / "reference" / "differences.md"
LISTS = ROOT / "tests" / "data" / "api"
MODULES = ("ES", "EVS", "SB", "TBL", "TIME", "FS", "MSG", "SBR", "ResourceId", "Config", "osal", "psp")
TITLES = {"osal": "OSAL", "psp": "PSP"}
NAME = re.compile(r"\b(?:CFE|OS)_\w+\*?")
REASON = re.compile(r"\(\*([^*]+)\*\) \|$")
NO_REASON = "not yet"
NOT_OF_PYTHON = ("ROS", "Compiled applications")
"""Sections that say nothing of NASA's functions as Python calls them."""

HEAD = """\
# API map

Every public function and macro of NASA's cFE, OSAL and PSP 7.0.0, and its name in cfepy. `cfe` is the handle that an
application's main function receives. `cfepy` is a module to import. Failed calls raise an exception, and output
pointers became return values. If a function differs further, a row of [differences.md](../differences.md) names it, and
the last column links to it.

The column C shows how a [compiled application](../../how_to/c_apps.md) gets the name:

- `call`: a function;
- `header`: a macro or an inline function, which the application contains;
- `core`: a function that no header for applications declares; only NASA's core calls it;
- `undefined`: a function that NASA's default build declares, but does not have.

`python -m dev.pages.api_map` writes this page. A test fails if the page is out of date or if a name is missing.
"""

CALL, HEADER, CORE, UNLINKED, MISSING = "call", "header", "core", "undefined", "missing"
OF_THE_CORE = ("CFE_ES_Main", "CFE_SBR_*")
"""Of core_private, or called once by the PSP: NASA's applications do not see them."""


EXTENDED = tuple(
    f"CFE_MSG_{verb}{name}"
    for verb in ("Get", "Set")
    for name in ("EDSVersion", "Endian", "PlaybackFlag", "Subsystem", "System")
)
"""Of extended headers: NASA's default build declares them, but has none of them."""


class Difference(NamedTuple):
    """A row of differences.md: section, names it mentions ("OS_Foo*" for all that begin so), and reason."""

    section: str
    names: tuple[str, ...]
    reason: str

    def mentions(self, name: str) -> bool:
        """Return whether the row is about a name."""
        return any(fnmatchcase(name, pattern) for pattern in self.names)


class Entry(NamedTuple):
    """One function: NASA's header and name, the name here, whether an object with it exists, and the entry for C."""

    header: str
    name: str
    python: str
    exists: bool
    difference: Difference | None
    c: str = CALL

    @property
    def is_missing(self) -> bool:
        """Neither here nor explained."""
        return not self.exists and (self.difference is None or self.difference.reason == NO_REASON)

    @property
    def shown(self) -> str:
        """The second column: the name here, if there is something behind it."""
        return f"`{self.python}`" if self.exists else ""

    @property
    def status(self) -> str:
        """The last column."""
        row = self.difference
        if self.is_missing or row is None:
            return "same" if self.exists else "missing"
        link = f"../differences.md#{_anchor(row.section)}"
        return f"[differs]({link})" if self.exists else f"[absent]({link}): {row.reason}"


def listed(module: str) -> Iterator[tuple[str, str, bool]]:
    """Yield (header, name, whether it is inline) for each declaration of a module's headers, once each."""
    header, seen = "", set[str]()
    for line in (LISTS / f"api_{module}.txt").read_text(encoding="utf-8").splitlines():
        if line.startswith("#"):
            header = line.partition(":")[0].rpartition("/")[2]
        elif (name := line.split()[0]) not in seen:
            seen.add(name)
            yield header, name, line.rstrip().endswith(")")


def differences() -> list[Difference]:
    """Return the rows of docs/reference/differences.md that mention names."""
    found, section = [], ""
    for line in DIFFERENCES.read_text(encoding="utf-8").splitlines():
        if line.startswith("## "):
            section = line.removeprefix("## ")
        elif line.startswith("|") and not section.startswith(NOT_OF_PYTHON) and (names := NAME.findall(line)):
            found.append(Difference(section, tuple(names), reason[1] if (reason := REASON.search(line)) else ""))
    return found


def resolve(dotted: str, cfe: Any) -> Any:
    """Return the object behind a Python name of the map, or None if there is none."""
    first, *rest = dotted.split(".")
    found = cfe
    if first == "cfepy":
        try:
            found = importlib.import_module(f"cfepy.{rest.pop(0)}")
        except ModuleNotFoundError:
            return None
    for part in rest:
        found = getattr(found, part, None)
    return found


def entries(module: str, cfe: Any) -> list[Entry]:
    """Return all that a module's headers declare, as it stands here."""
    rows, functions = differences(), function_names()
    return [
        Entry(
            header,
            name,
            python_name(name),
            callable(resolve(python_name(name), cfe)),
            next((row for row in rows if row.mentions(name)), None),
            _in_c(name, is_inside, functions),
        )
        for header, name, is_inside in listed(module)
    ]


def _in_c(name: str, is_inside: bool, functions: set[str]) -> str:
    """Return the entry of a name for compiled applications."""
    if name in functions:
        return CALL
    if is_inside:
        return HEADER
    if name in EXTENDED:
        return UNLINKED
    return CORE if any(fnmatchcase(name, pattern) for pattern in OF_THE_CORE) else MISSING


def booted() -> Mission:
    """Return a mission of core services alone, after its boot."""
    with TemporaryDirectory() as folder:
        Path(folder, "startup.scr").write_text("! nothing\n", encoding="utf-8")
        mission = Mission(folder, console=Console(quiet=True))
        mission.run_for(1)
    return mission


def page(cfe: Any) -> str:
    """Return the text of docs/reference/generated/api_map.md."""
    sections = {TITLES.get(module, module): entries(module, cfe) for module in MODULES}
    lines = [HEAD, "| module | names | same | differ | absent | called in C |", "|---|---|---|---|---|---|"]
    lines += [f"| [{title}](#{_anchor(title)}) | {_counts(rows)} |" for title, rows in sections.items()]
    for title, rows in sections.items():
        lines += ["", f"## {title}"]
        for header, group in groupby(rows, key=lambda row: row.header):
            lines += ["", f"{header}:", "", "| NASA | cfepy | C | |", "|---|---|---|---|"]
            lines += [f"| {row.name} | {row.shown} | {row.c} | {row.status} |" for row in group]
    return "\n".join(lines) + "\n"


def _anchor(heading: str) -> str:
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def _counts(rows: list[Entry]) -> str:
    same = sum(row.status == "same" for row in rows)
    there = sum(row.exists for row in rows)
    called = sum(row.c == CALL for row in rows)
    return f"{len(rows)} | {same} | {there - same} | {len(rows) - there} | {called}"


def main() -> None:
    """Write the page, and print the missing names."""
    argparse.ArgumentParser(prog="python -m dev.pages.api_map", description=__doc__).parse_args()
    with booted() as mission:
        PAGE.write_text(page(mission.cfe), encoding="utf-8")
        for module in MODULES:
            rows = entries(module, mission.cfe)
            missing = [f"{row.name} ({row.python})" for row in rows if row.is_missing]
            missing += [f"{row.name} (in C)" for row in rows if row.c == MISSING]
            print(f"{module}: {len(missing)} missing", *missing, sep="\n  ")


if __name__ == "__main__":
    main()
