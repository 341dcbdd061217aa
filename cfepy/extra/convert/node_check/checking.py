"""The check of one program: findings in its sources, errors of the compiler, and the memory of its subscriptions."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from functools import cache, partial
from pathlib import Path

from cfepy.extra.convert.build import BuildOptions, library_folder, library_includes
from cfepy.extra.convert.capacities import Capacities, capacities_of
from cfepy.extra.convert.cpp_package import Program
from cfepy.extra.convert.message_headers import Profile, write_headers
from cfepy.extra.convert.node_check.compiler import Compiler, Diagnostic, tell
from cfepy.extra.convert.node_check.findings import CheckReport, SourcePlace, SubscriptionMemory
from cfepy.extra.convert.node_check.headers import write_refusal, write_refusals
from cfepy.extra.convert.node_check.program import ProgramSources, subscriptions
from cfepy.mission import CppNodesConfig
from cfepy.reading.contained_files import write_contained
from cfepy.rtos import Stopwatch
from cfepy.status import UsageError
from cfepy.writing.work_progress import WorkProgress
from rospy_shim.types.msgs import Library, OnDisk, Packages, shipped

LONGEST_PACKET = 32768
"""Bytes of a packet on NASA's Software Bus (CFE_MISSION_SB_MAX_SB_MSG_SIZE)."""
OF_TRANSFORMS = ("tf/transform_listener.h", "tf2_ros/transform_listener.h", "tf2_ros/buffer.h", "tf2/buffer_core.h")
"""Headers that give a node a buffer of transforms."""
KEPT = 4
"""Messages that a node may hold in addition to the waiting ones."""


def check_program(
    program: Program,
    profile: Profile,
    environ: Mapping[str, str],
    config: CppNodesConfig | None = None,
    *,
    compile_refused: bool = True,
) -> CheckReport:
    """Check a program.

    Args:
        program: its sources and build settings.
        profile: the profile of the build.
        environ: has the paths of packages, for their message definitions.
        config: the section `cpp_nodes:` of a mission file, whose profile does not count; None without one.
        compile_refused: whether the compiler is called even if the sources alone refuse the program.

    Raises:
        UsageError: tree-sitter or the compiler is not installed.
        CppNodesError: the section is wrong.
    """
    config = config or CppNodesConfig()
    report = CheckReport(program.type, profile)
    packages = Packages(program.package.folder / "CMakeLists.txt", environ)
    sources = ProgramSources(program.sources, program.includes, Library([OnDisk(packages)], base=shipped()))
    sources.make_configurations(report, program)
    sources.look(report)
    report.has_transforms = any(map(sources.included_at, OF_TRANSFORMS))
    if report.is_refused and not compile_refused:
        return report
    with tempfile.TemporaryDirectory(prefix="cfepy-check-") as folder:
        scratch = Path(folder)
        _compile(report, program, sources, scratch, capacities_of(config, sources.library))
    _hold_to_arena(report, config)
    report.findings.sort()
    return report


def _compile(
    report: CheckReport, program: Program, sources: ProgramSources, scratch: Path, capacities: Capacities
) -> None:
    messages = scratch / "messages"
    messages.mkdir()
    real_boost = sources.takes_real_boost(report.profile)
    refusals = Path(_refusals(real_boost).name)
    for kind in sorted(sources.messages):
        try:
            write_headers([kind], messages, report.profile, sources.library, capacities)
        except UsageError as error:
            rule = "capacity-missing" if "capacity" in error.text else "message-definition"
            write_refusal(messages / f"{kind}.h", error.text, rule)
    for name, text in sources.generated.items():
        write_contained(messages, f"/{name}", text.encode())
    folders = [*program.includes, messages, *library_includes(real_boost), refusals]
    options = BuildOptions(report.profile, exceptions=sources.use_exceptions)
    compiler = Compiler(options, folders, program.definitions)
    accepted = True
    calls: list[tuple[Diagnostic, SourcePlace]] = []
    known = [each for each in program.sources if each in sources.files]
    with WorkProgress(Stopwatch().elapsed_ns) as progress:
        for number, source in enumerate(known, 1):
            progress.show(f"compiling {program.type}: {number} of {len(known)}, {source.name}")
            compiled = compiler.compile(source, scratch, progress.refresh)
            accepted = accepted and compiled.ok
            tell(report, source, compiled, partial(_shown, sources, source, (refusals, messages)))
            calls += _calls_of_program(compiled.subscriptions, source, sources)
    if accepted and program.sources:
        report.names[:] = sources.with_types(report.names, calls)
        _measure(report, compiler, sources, scratch)
        _find_undefined(report, compiler, known, scratch)
        _find_ending_calls(report, compiler, sources)


def _calls_of_program(
    calls: Sequence[Diagnostic], source: Path, sources: ProgramSources
) -> Iterator[tuple[Diagnostic, SourcePlace]]:
    """Yield calls with their places; the source stands for a header that is not the program's.

    Calls in the interface library itself are left out, because the program made them.
    """
    for each in calls:
        file = Path(os.path.normpath(each.place.file))
        if file in sources.files:
            yield each, each.place._replace(file=file)
        elif not file.is_relative_to(library_folder()):
            yield each, SourcePlace(source)


def _find_undefined(report: CheckReport, compiler: Compiler, files: Sequence[Path], scratch: Path) -> None:
    names: dict[SourcePlace, list[str]] = {}
    for each in compiler.undefined(scratch):
        file = Path(os.path.normpath(each.file)) if each.file else files[0]
        names.setdefault(SourcePlace(file, each.line), []).append(each.name)
    for place, missing in names.items():
        report.add("undefined-name", place, f"nothing defines {', '.join(missing)}")


def _find_ending_calls(report: CheckReport, compiler: Compiler, sources: ProgramSources) -> None:
    """Add the calls that end the node, in place of milder findings of the same line."""
    unused = sources.unused()
    for each, reason in compiler.ending_calls():
        place = SourcePlace(Path(os.path.normpath(each.file)), each.line)
        if place.file not in sources.files or place.file in unused:
            continue
        same = [found for found in report.findings if found.message.removeprefix("std::") == f"{each.name}()"]
        if not any(map(report.is_error, same)):
            report.findings = [found for found in report.findings if found not in same]
            for found in [found.place for found in same] or [place]:
                report.add("host-function", found, f"{each.name}(): {reason}")


def _measure(report: CheckReport, compiler: Compiler, sources: ProgramSources, scratch: Path) -> None:
    """Add the memory of all subscriptions with a known type."""
    found = list(subscriptions(report.names))
    types = sorted({name.type for name, _ in found} & sources.messages)
    sizes = compiler.sizes(types, scratch) if types else {}
    for name, queue in found:
        size = sizes.get(name.type)
        if size is None:
            continue
        report.memory.append(SubscriptionMemory(name.name or name.text, name.type, queue + KEPT, size, name.place))
        if size > LONGEST_PACKET:
            report.add("message-too-long", name.place, f"{name.type} has {size:,} bytes")


def _hold_to_arena(report: CheckReport, config: CppNodesConfig) -> None:
    """Check that the messages of all subscriptions fit into the arena of a node that has one."""
    total = sum(each.total for each in report.memory)
    if total > config.arena_bytes and report.profile is not Profile.HOST:
        mark = config.places.get("arena_bytes")
        place = report.memory[0].place if mark is None else SourcePlace(mark.file, mark.line)
        report.add("arena-too-small", place, f"{total:,} bytes of messages in an arena of {config.arena_bytes:,}")


def _shown(sources: ProgramSources, source: Path, made: Sequence[Path], file: Path) -> SourcePlace | None:
    """Return the place where a generated header was included, or the source if another header includes it."""
    folder = next((each for each in made if file.is_relative_to(each)), None)
    if folder is None:
        return None
    return sources.included_at(str(file.relative_to(folder))) or SourcePlace(source)


@cache
def _refusals(real_boost: bool) -> tempfile.TemporaryDirectory[str]:
    """Return the headers that refuse, written once for all programs; the folder ends with the process."""
    folder = tempfile.TemporaryDirectory(prefix="cfepy-refusals-")
    write_refusals(Path(folder.name), real_boost)
    return folder
