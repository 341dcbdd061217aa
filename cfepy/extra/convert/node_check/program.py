"""Findings in the sources of a program together: unlisted headers, callbacks that allocate, names, queues."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path

from cfepy.extra.convert.build import BOOST_IN_PART
from cfepy.extra.convert.configurations import configuration_headers
from cfepy.extra.convert.cpp_package import Program
from cfepy.extra.convert.entry import LONGEST_QUEUE
from cfepy.extra.convert.message_headers import Profile
from cfepy.extra.convert.node_check.compiler import Diagnostic
from cfepy.extra.convert.node_check.findings import CheckReport, GraphName, SourcePlace
from cfepy.extra.convert.node_check.headers import (
    OURS,
    ROS_LIBRARIES,
    SYSTEM,
    behind_ours,
    has_boost,
    has_eigen,
    is_eigen,
    is_file,
    is_ours,
    is_outside,
    is_small_boost,
    is_standard,
    refusal,
)
from cfepy.extra.convert.node_check.source import read_source, type_of
from cfepy.extra.convert.node_check.source_file import Include, SourceFile
from cfepy.reading.input_files import read_limited
from cfepy.status import UsageError
from rospy_shim.types.msgs import Library

LONGEST_SOURCE = 1_000_000
"""Bytes of a source; a longer one was not written by hand."""
CARRIED_OUT = ("thread", "socket", "serial", "process", "getchar")
"""Rules for code that refuses a node only if the code can be executed."""
_MOST_FILES = 2000
_MOST_BYTES = 4_000_000  # of all files of a program
_NODELET = re.compile(rb"\bPLUGINLIB_(?:EXPORT|DECLARE)_CLASS\b|\bNODELET_EXPORT\b")
_PARTS = ("Request", "Response")
_TWO_NAMES = re.compile(r"\b([A-Za-z]\w*)::([A-Za-z]\w*)")


class ProgramSources:
    """The sources and own headers of a program, each read once.

    Args:
        sources: files that are compiled.
        folders: of the include path.
        library: message definitions.
    """

    def __init__(self, sources: Sequence[Path], folders: Sequence[Path], library: Library) -> None:
        self.sources = list(sources)
        self.folders = list(folders)
        self.library = library
        self.files: dict[Path, SourceFile] = {}
        self.unreadable: dict[Path, str] = {}
        self._size = 0  # bytes of all files
        self.messages: set[str] = set()
        self.has_plugin = False
        self.generated: dict[str, str] = {}
        """Texts of headers from the package's configurations, by name."""
        self._unknown: list[Include] = []
        self._boost: set[str] = set()
        self._read_all()

    def look(self, report: CheckReport) -> None:
        """Add all findings of the rules, without the compiler's errors."""
        report.files += sorted(self.files)
        report.unparsed += sum(each.unparsed for each in self.files.values())
        for path, problem in self.unreadable.items():
            report.add("file-unreadable", SourcePlace(path), problem)
        for include in self._unknown:
            self._look_at_include(report, include)
        self._look_at_mains(report)
        callbacks = {"lambda"}.union(*(each.callbacks for each in self.files.values()))
        unused = self.unused()
        for file in self.files.values():
            for met in file.met:
                if met.rule in CARRIED_OUT and file.path in unused:
                    report.add(
                        "unused-code", met.place, f"{met.message} in code that nothing else of the node can call"
                    )
                elif met.rule != "heap-in-callback" or met.function in callbacks:
                    report.add(met.rule, met.place, met.message)
        report.names += self.names()
        for name in report.names:
            self._look_at_name(report, name)

    def make_configurations(self, report: CheckReport, program: Program) -> None:
        """Make the headers of the configurations, with the packages' scripts in `cfg`.

        Args:
            report: gets the errors of scripts.
            program: has the packages to search.
        """
        for include in self._unknown:
            try:
                self.generated |= configuration_headers([include.name], program)
            except UsageError as error:
                report.add("configuration", include.place, str(error))
                self.generated[include.name] = refusal(error.text, "configuration")

    @property
    def use_exceptions(self) -> bool:
        """Whether a file throws or catches, or asks for types at run time."""
        return any(met.rule in ("throw", "catch", "rtti") for file in self.files.values() for met in file.met)

    def takes_real_boost(self, profile: Profile) -> bool:
        """Return True if the program is built with this computer's Boost, because the small one lacks parts."""
        if profile is not Profile.HOST or not is_file(SYSTEM / "boost" / "version.hpp"):
            return False
        return any(name in BOOST_IN_PART or not is_small_boost(name) for name in self._boost)

    def included_at(self, header: str) -> SourcePlace | None:
        """Return the place where a header is included."""
        found = (each for file in self.files.values() for each in file.includes if each.name == header)
        return next((each.place for each in found), None)

    def names(self) -> list[GraphName]:
        """Return the names that the program uses, with types and constants from its other files."""
        constants = self._agreed({}, "constants")
        parameters = self._agreed({}, "parameters")
        found = []
        for file in self.files.values():
            for each in sorted(file.names, key=lambda name: name.place):
                kind = each.type if self._is_message(each.type) else ""
                if not kind and each.kind == "subscribe":
                    handler = file.handlers.get(each.place, "")
                    taken = handler if handler.startswith(" ") else parameters.get(handler, "")
                    kind = type_of(taken) if self._is_message(type_of(taken)) else ""
                name = constants.get(each.text.rpartition("::")[2]) if each.name is None else each.name
                found.append(each._replace(type=kind, name=name))
        return found

    def with_types(
        self, names: Sequence[GraphName], calls: Sequence[tuple[Diagnostic, SourcePlace]]
    ) -> list[GraphName]:
        """Return names with the message types that the compiler knows of calls that subscribe.

        Args:
            names: of the sources.
            calls: calls that subscribe, each with its place in a file of the program.

        Returns:
            The names. A call in a template has one for each type. A call that is in no source has a name without a
            text.
        """
        types: dict[SourcePlace, list[str]] = {}
        for call, place in calls:
            kind = self._type_in(call.message)
            known = types.setdefault(place, [])
            known += [kind] if kind and kind not in known else []
        found = []
        for each in names:
            kinds = types.pop(each.place, []) if each.kind == "subscribe" else []
            found += [each._replace(type=kind) for kind in kinds] or [each]
        there = {(each.place[:2], each.type) for each in found if each.kind == "subscribe"}
        for place, kinds in types.items():
            new = (kind for kind in kinds if (place[:2], kind) not in there)
            found += [GraphName("subscribe", None, "a topic", place, kind) for kind in new]
        return found

    def _type_in(self, told: str) -> str:
        """Return the first message type in a text of the compiler about a call."""
        _, _, given = told.rpartition("[with ")
        pairs = _TWO_NAMES.findall(given)
        return next((f"{one}/{other}" for one, other in pairs if self._is_message(f"{one}/{other}")), "")

    def _agreed(self, found: dict[str, str], what: str) -> dict[str, str]:
        """Return the values of names in all files; a name with different values is left out."""
        unclear = set()
        for file in self.files.values():
            for name, value in getattr(file, what).items():
                if found.setdefault(name, value) != value:
                    unclear.add(name)
        return {name: value for name, value in found.items() if name not in unclear}

    # -- headers -------------------------------------------------------------------------------------------------------

    def _read_all(self) -> None:
        waiting = list(reversed(self.sources))
        while waiting and len(self.files) < _MOST_FILES:
            path = waiting.pop()
            if path in self.files or path in self.unreadable:
                continue
            file = self._read(path)
            if file is None:
                continue
            self.files[path] = file
            self._boost |= {each.name for each in file.includes if each.name.startswith("boost/")}
            for include in file.includes:
                own = self._own(path, include.name)
                if own is not None:
                    waiting.append(own)
                elif not self._is_message_header(include.name):
                    self._unknown.append(include)
                    for name in behind_ours(include.name) if is_ours(include.name) else ():
                        self._is_message_header(name)

    def _read(self, path: Path) -> SourceFile | None:
        try:
            source = read_limited(path, LONGEST_SOURCE)
        except OSError as error:
            self.unreadable[path] = f"{path.name} {error.strerror or error}"
            return None
        except UsageError as error:
            self.unreadable[path] = f"{path.name} {error.text}"
            return None
        self.has_plugin |= _NODELET.search(source) is not None
        self._size += len(source)
        if self._size > _MOST_BYTES:
            self.unreadable[path] = f"{path.name} is one too many: all files have more than {_MOST_BYTES:,} bytes"
            return None
        return read_source(path, source)

    def _own(self, includer: Path, name: str) -> Path | None:
        """Return the file of an include if it is the program's own."""
        if not name or "\0" in name or len(name) > 300:
            return None
        for folder in (includer.parent, *self.folders, OURS):
            file = folder / name
            if is_file(file):
                own = folder != OURS and not file.is_relative_to(SYSTEM)
                return Path(*_without_dots(file.parts)) if own else None
        return None

    def _is_message_header(self, name: str) -> bool:
        """Return True if a header is made from a message's definition, and record the message."""
        kind = name.removesuffix(".h")
        if not name.endswith(".h") or kind.count("/") != 1:
            return False
        for part in _PARTS:
            if self.library.has(kind.removesuffix(part), "srv"):
                kind = kind.removesuffix(part)
        if self._is_message(kind) or self.library.has(kind, "srv"):
            self.messages.add(kind)
            return True
        return False

    def _is_message(self, kind: str) -> bool:
        return bool(kind) and self.library.has(kind)

    def _look_at_include(self, report: CheckReport, include: Include) -> None:
        name, place = include.name, include.place
        if include.conditional or is_standard(name) or is_ours(name) or name in self.generated:
            return
        if name.startswith("boost/"):
            if not has_boost(name, report.profile):
                report.add("boost-header", place, f"{name} is not available in the {report.profile} profile")
            return
        if is_eigen(name) and has_eigen():
            return
        folder = name.partition("/")[0]
        if folder in ("gtest", "gmock"):
            report.add("gtest", place, f"{name} is GoogleTest's")
        elif folder in ROS_LIBRARIES and "/" in name and not folder.endswith("_msgs"):
            report.add("ros-library", place, f"{name} is not in the interface library")
        elif is_outside(name):
            report.add("library-outside", place, f"{name} is of a library that has no cFE build")
        else:
            report.add("include-unknown", place, f"{name} is not found")

    # -- mains, unused code and names ----------------------------------------------------------------------------------

    def _look_at_mains(self, report: CheckReport) -> None:
        mains = [main for path in self.sources if path in self.files for main in self.files[path].mains]
        if not mains and not self.has_plugin and self.sources:
            report.add("main-form", SourcePlace(self.sources[0]), "the main function is missing")
        for extra in mains[1:]:
            report.add("main-form", extra.place, "another main")
        for main in mains[:1]:
            if main.takes not in ("nothing", "arguments"):
                report.add("main-form", main.place, f"main takes ({main.takes})")

    def unused(self) -> set[Path]:
        """Return sources without functions that another file can call, and headers that only they include.

        They define only methods of their own classes, and no object that is made when the program is loaded. Such
        sources come from a library that the node links for another purpose.
        """
        includers: dict[Path, set[Path]] = {}
        for path, file in self.files.items():
            for include in file.includes:
                own = self._own(path, include.name)
                if own is not None:
                    includers.setdefault(own, set()).add(path)
        unused: set[Path] = set()
        for source in self.sources if not self.has_plugin else ():
            paths = [source, *(header for header, users in includers.items() if users == {source})]
            files = [self.files[each] for each in paths if each in self.files]
            classes = set().union(*(each.classes for each in files))
            if all(
                each.owners <= classes and not each.mains and not each.unparsed and not each.has_objects
                for each in files
            ):
                unused.update(paths)
        return unused

    def _look_at_name(self, report: CheckReport, name: GraphName) -> None:
        if name.name is None and name.kind not in ("parameter",):
            defaults = self._agreed({}, "defaults")
            default = defaults.get(name.text)
            known = "" if default is None else f"; by default it is {default!r}"
            report.add("topic-not-constant", name.place, f"{name.text} is computed{known}")
        if name.kind != "subscribe" or name.queue is None:
            return
        if name.queue == 0:
            report.add("queue-unbounded", name.place, f"a queue without a bound: {LONGEST_QUEUE} messages are kept")
        elif name.queue > LONGEST_QUEUE:
            report.add("queue-large", name.place, f"a queue of {name.queue:,}: {LONGEST_QUEUE} messages are kept")


def subscriptions(names: Sequence[GraphName]) -> Iterator[tuple[GraphName, int]]:
    """Yield subscriptions with a known type, each with the number of messages that wait."""
    for each in names:
        if each.kind == "subscribe" and each.type:
            asked = LONGEST_QUEUE if not each.queue else each.queue
            yield each, min(asked, LONGEST_QUEUE)


def _without_dots(parts: Sequence[str]) -> list[str]:
    """Return parts of a path without `.` and, as far as possible, `..`."""
    kept: list[str] = []
    for part in parts:
        if part == ".." and kept and kept[-1] not in ("..", "/"):
            kept.pop()
        elif part != ".":
            kept.append(part)
    return kept
