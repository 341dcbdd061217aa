"""The compiler's result for a program: its errors as findings, and the sizes of the messages that it subscribes to.

It is called as for a build, with the interface library's headers, and makes no files. A file that it does not accept is
never reported as clean, for any reason: an error of its own, its end, or too much time or memory.
"""

from __future__ import annotations

import json
import linecache
import re
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from cfepy.extra.c import CompilerError, call_bounded, cpp_compiler
from cfepy.extra.convert.build import (
    ALLOCATING,
    DROP_UNUSED,
    SECTIONS,
    WRAPPED,
    BuildOptions,
    posix_threads,
    profile_flags,
)
from cfepy.extra.convert.message_headers import Profile
from cfepy.extra.convert.node_check.findings import CheckReport, SourcePlace
from cfepy.extra.convert.node_check.headers import SYSTEM, is_of_ros
from cfepy.extra.convert.node_check.rules import RULES
from cfepy.extra.convert.undefined_names import ASK, UndefinedName, ending_calls, undefined_names

_SAID = re.compile(r"^#error \"?(?:roscfe: )?(.*?) ?\[([a-z-]+)\]\"?$")
_MOST = 50  # reported errors of a source; GCC's own -fmax-errors drops all of them with this format
_HEADER = re.compile(r"^(.+): (?:No such file or directory|Is a directory|Permission denied|File name too long)$")
_NAMESPACES = (
    "ros|tf|tf2|tf2_ros|actionlib|nodelet|message_filters|dynamic_reconfigure|diagnostic_updater|pluginlib|boost|angles"
    "|XmlRpc|roscpp|image_transport|roscfe|class_loader"
)
_OF_ROS = re.compile(rf"'[^']*\b(?:{_NAMESPACES})(?:::[^']*)?'|'(?:ROS_|ROSCONSOLE_|NODELET_|PLUGINLIB_|Duration|Rate)")
_MISSING = re.compile(
    r"is not a member of|has no member named|was not declared|has not been declared|does not name a"
    r"|no matching function|is not a class|no type named|not a template|no class template named"
    r"|is not a namespace|could not convert"
    r"|no viable|cannot convert|incomplete type|no match for"
)
_UNDECLARED = re.compile(r"'(\w+)' was not declared in this scope|has no member named '(\w+)'")
_DECLARED = re.compile(r"[\s*&>](\w+)\s*[;=({\[]")
_EXCEPTIONS = re.compile(r"exception handling disabled")
_TYPES = re.compile(r"'(?:dynamic_cast|typeid)'|-fno-rtti")
_MARK = "is deprecated: roscfe: it subscribes"
_TOLD = re.compile(r"Told<(\d+), (\d+)>")


class Diagnostic(NamedTuple):
    """An error of the compiler.

    Attributes:
        message: its text.
        place: its place.
    """

    message: str
    place: SourcePlace


class Compiled(NamedTuple):
    """The compiler's result for a file.

    Attributes:
        ok: whether it accepts the file.
        errors: its errors.
        problem: why it did not finish, if it did not.
        used: all files that it read.
        subscriptions: the calls that subscribe, each with the text of the compiler about its types.
    """

    ok: bool
    errors: list[Diagnostic]
    problem: str = ""
    used: Sequence[str] = ()
    subscriptions: Sequence[Diagnostic] = ()


class Compiler:
    """Calls the compiler for the sources of one program.

    Args:
        options: of the build.
        folders: of the include path, the first searched first.
        definitions: the compiler's -D, without -D.
    """

    def __init__(self, options: BuildOptions, folders: Sequence[Path], definitions: Iterable[str] = ()) -> None:
        self.command = [*cpp_compiler(), "-std=c++17", "-fPIC", "-fvisibility=hidden", *SECTIONS]
        self.command += ["-g1", "-DROSCFE_IS_CHECKED"]
        self.command += ["-fdiagnostics-format=json", "-fdiagnostics-column-unit=byte", *profile_flags(options)]
        self.command += [f"-D{each}" for each in definitions]
        self.command += [word for place in folders for word in ("-I", str(place))]
        self.objects: list[Path] = []
        self._profile = options.profile

    def compile(self, source: Path, scratch: Path, while_waiting: Callable[[], object] = lambda: None) -> Compiled:
        """Compile a file.

        Args:
            source: the file.
            scratch: folder for the list of files that it reads.
            while_waiting: called every few seconds.

        Raises:
            UsageError: there is no such compiler.
        """
        listed = scratch / "used.d"
        listed.unlink(missing_ok=True)
        made = scratch / f"{len(self.objects)}.o"
        writes = ["-MD", "-MF", str(listed), "-c", "-x", "c++", str(source), "-o", str(made)]
        status, said = _call([*self.command, *writes], while_waiting)
        errors, problem = _diagnostics(said)
        self.objects.append(made)
        if status < 0 or (status and not errors):
            problem = problem or f"the compiler ended with {status}"
        try:
            used = listed.read_text(encoding="utf-8", errors="replace").replace("\\\n", " ").split()
        except OSError:
            used = []
        return Compiled(status == 0 and not errors, errors, "" if status == 0 else problem, used, _subscriptions(said))

    def undefined(self, scratch: Path) -> list[UndefinedName]:
        """Link all files that were compiled, and return the names that nothing defines.

        Names in code that is never called do not count, since the build leaves it out.

        Raises:
            UsageError: there is no such compiler.
        """
        kept = ("-Wl,-e,main", DROP_UNUSED)
        command = [*cpp_compiler(), "-shared", *kept, *ASK, "-o", str(scratch / "linked.so"), *map(str, self.objects)]
        return undefined_names(_call(command)[1], with_library=False)

    def ending_calls(self) -> list[tuple[UndefinedName, str]]:
        """Return the calls of functions that end the node, each with the reason.

        Raises:
            UsageError: binutils are not installed.
        """
        replaced = (*WRAPPED, *ALLOCATING, *(posix_threads() if self._profile is Profile.HOST else ()))
        return ending_calls(_call(["nm", "-u", "-l", *map(str, self.objects)])[1], replaced)

    def sizes(self, types: Sequence[str], scratch: Path) -> dict[str, int]:
        """Return the bytes of messages, by type; empty if the compiler does not report them."""
        asked = scratch / "sizes.cpp"
        lines = [f"#include <{each}.h>" for each in types]
        lines += ["template <unsigned long Index, unsigned long Size> struct Told;"]
        names = [each.replace("/", "::") for each in types]
        lines += [f"Told<{at}, sizeof({name})> told_{at};" for at, name in enumerate(names)]
        asked.write_text("\n".join(lines) + "\n", encoding="utf-8")
        errors, _ = _diagnostics(_call([*self.command, "-fsyntax-only", str(asked)])[1])
        told = [_TOLD.search(each.message) for each in errors]
        return {types[int(match[1])]: int(match[2]) for match in told if match is not None}


def tell(report: CheckReport, source: Path, compiled: Compiled, shown: Callable[[Path], SourcePlace | None]) -> None:
    """Add the compiler's result for a file to a report.

    Args:
        report: receives it.
        source: the file.
        compiled: the compiler's result.
        shown: returns the place to show for a file that the user does not know; None for the file itself.
    """
    told = [(*rule_of(each.message, report.profile), each.place) for each in causes(compiled.errors)]
    without_header = [each for each in told if each[0] in ABOUT_HEADERS]
    for rule, message, place in (without_header or told)[:_MOST]:  # a missing header causes more errors
        at = shown(place.file) or place
        same = (each for each in report.findings if each.rule == rule)
        if rule in _SEEN_BEFORE:
            seen = any(each.place[:2] == at[:2] for each in same)
        else:
            seen = rule in _BY_TEXT and any(each.message == message for each in same)
        if not seen:
            report.add(rule, at, message)
    if not compiled.ok and (compiled.problem or not compiled.errors):
        report.add("compile-error", SourcePlace(source), compiled.problem or "the compiler does not accept it")
    for used in compiled.used:
        package = used.removeprefix(f"{SYSTEM}/").partition("/")[0]
        installed = used.startswith(f"{SYSTEM}/") and is_of_ros(package)
        if installed or used.startswith("/opt/ros/"):
            report.add("system-ros", SourcePlace(source), f"{used} was taken")


def causes(errors: Sequence[Diagnostic]) -> list[Diagnostic]:
    """Return errors without those that follow from an earlier one.

    These are further errors of a line, and uses of a name whose declaration was not understood.
    """
    kept: list[Diagnostic] = []
    lines: set[tuple[Path, int]] = set()
    lost: set[str] = set()
    for each in errors:
        missing = _UNDECLARED.search(each.message)
        follows = each.place[:2] in lines or (missing is not None and (missing[1] or missing[2]) in lost)
        if not follows or not each.place.line or any(mark.search(each.message) for mark in (_EXCEPTIONS, _TYPES)):
            kept.append(each)
            lines.add(each.place[:2])
            lost.update(_DECLARED.findall(linecache.getline(str(each.place.file), each.place.line)))
    return kept


def rule_of(message: str, profile: Profile) -> tuple[str, str]:
    """Return the rule for an error of the compiler, and the message of its finding."""
    said = _SAID.match(message)
    if said is not None and said[2] in RULES:
        return said[2], said[1]
    header = _HEADER.match(message)
    if header is not None:
        return "include-unknown", f"{header[1]} is not found"
    if profile is not Profile.HOST and _EXCEPTIONS.search(message):
        return "throw", message
    if profile is not Profile.HOST and _TYPES.search(message):
        return "rtti", message
    if _MISSING.search(message) and _OF_ROS.search(message) and "; did you mean" not in message:
        return "api-missing", message
    return "compile-error", message


def _call(command: list[str], while_waiting: Callable[[], object] = lambda: None) -> tuple[int, str]:
    """Call the compiler with limits. Returns its status and its output."""
    try:
        return call_bounded(command, while_waiting)
    except CompilerError as error:
        return -1, str(error)


def _subscriptions(said: str) -> list[Diagnostic]:
    """Return the calls of functions that the interface library marks, because they subscribe."""
    found, _ = _told(said)
    return [_diagnostic(each, "start") for each in found if str(each.get("message")).endswith(_MARK)]


def _told(said: str) -> tuple[list[dict[str, Any]], list[str]]:
    """Return the diagnostics in the compiler's output, and its other lines."""
    told: list[dict[str, Any]] = []
    other: list[str] = []
    for line in said.splitlines():
        try:
            found: Any = json.loads(line) if line.startswith("[") else None
        except ValueError:
            found = None
        if isinstance(found, list):
            told += [each for each in found if isinstance(each, dict)]
        else:
            other.append(line)
    return told, other


def _diagnostics(said: str) -> tuple[list[Diagnostic], str]:
    """Return the errors in the compiler's output, and its first other problem."""
    told, other = _told(said)
    errors = [_diagnostic(each) for each in told if each.get("kind") in _BAD]
    problem = next((line for line in other if "error" in line or "compilation terminated" not in line), "")
    return errors, problem[:300]


ABOUT_HEADERS = (
    *("include-unknown", "library-outside", "ros-library", "boost-header"),
    *("message-definition", "capacity-missing", "configuration"),
)
"""Rules about missing headers."""
_BY_TEXT = ("compile-error", "api-missing")
"""Rules whose message names the cause, so that a program has it once."""
_SEEN_BEFORE = (*ABOUT_HEADERS, "throw", "catch", "rtti")
"""Rules that are also checked without the compiler, with other columns."""
_BAD = ("error", "fatal error", "internal compiler error", "sorry, unimplemented")


def _diagnostic(found: dict[str, Any], where: str = "caret") -> Diagnostic:
    places = found.get("locations", ())
    caret: dict[str, Any] = next((each.get(where, each["caret"]) for each in places if "caret" in each), {})
    place = SourcePlace(Path(caret.get("file", "")), max(caret.get("line", 0), 0), max(caret.get("column", 0), 0))
    return Diagnostic(" ".join(str(found.get("message", "")).split()), place)
