"""The build of a ROS node in C++: from its sources to a shared object that a mission flies.

Sources are compiled as they are against the interface library and the headers of their messages. Compiled files are
kept in the user's cache folder, by the content of all their inputs, so a launch that was built once starts at once. The
library is compiled once for each profile.
"""

from __future__ import annotations

import hashlib
import os
import re
import sys
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path

from cfepy.extra.c import (
    CompilerError,
    cache_folder,
    call_bounded,
    cpp_compiler,
    end_bounded,
    headers_folder,
    mark_used,
    remove_unused,
    start_bounded,
    writing_cache,
)
from cfepy.extra.convert.capacities import Capacities
from cfepy.extra.convert.configurations import CONFIGURATION_TYPES, configuration_headers
from cfepy.extra.convert.cpp_package import Program
from cfepy.extra.convert.cpp_sources import SourceSet, collect, message_types
from cfepy.extra.convert.entry import NodeEntry, main_header
from cfepy.extra.convert.message_headers import Profile, write_headers
from cfepy.extra.convert.undefined_names import ASK, undefined_names
from cfepy.mission import ARENA_BYTES
from cfepy.reading.contained_files import write_contained
from cfepy.reading.resources import shipped
from cfepy.rtos import Stopwatch
from cfepy.status import UsageError
from cfepy.writing.work_progress import WorkProgress
from rospy_shim.types.msgs import Library

SECTIONS, DROP_UNUSED = ("-ffunction-sections", "-fdata-sections"), "-Wl,--gc-sections"
"""Flags of the compiler and of the linker, which together leave out what a node never calls."""
LANGUAGE = ("-std=c++17", "-fPIC", "-fvisibility=hidden", "-fno-gnu-unique", *SECTIONS, "-Wall")
"""Flags of every source, so that nodes share no variables, and leave none behind when they end."""
PLAIN = ("-O1", "-g", "-fno-stack-protector", "-U_FORTIFY_SOURCE", "-D_LINUX_OS_", "-D_POSIX_OS_")
WITHOUT_TYPES = ("-fno-rtti",)
WITHOUT_EXCEPTIONS = ("-fno-exceptions", *WITHOUT_TYPES)
STRICT_WARNINGS = ("-Wextra", "-Werror")
RANDOM = ("rand", "srand", "random", "srandom")
CLOCKS = ("time", "gettimeofday", "clock_gettime")
WRAPPED = ("exit", "abort", "sleep", "usleep", "nanosleep", "signal", "sigaction", *RANDOM, *CLOCKS)
"""libc functions that the library replaces, because they would affect the whole computer."""
ALLOCATING = (
    *("malloc", "calloc", "realloc", "reallocarray", "free", "strdup", "strndup"),
    *("aligned_alloc", "posix_memalign", "memalign"),
)
"""libc functions that the arena replaces, in profiles that have one."""
THREADS = "src/posix/threads.cpp"
"""The source of the interface library with POSIX's threads for nodes of the host profile."""
LINK = ("-shared", "-Wl,--wrap=" + ",--wrap=".join(WRAPPED), "-Wl,-Bsymbolic", "-Wl,--exclude-libs,ALL", DROP_UNUSED)
BOOST_REFUSED = ("config.hpp", "version.hpp")
"""Headers of the small Boost that refuse headers of the real Boost that were found by chance."""
BOOST_IN_PART = ("boost/thread.hpp", "boost/thread/thread.hpp", "boost/foreach.hpp", "boost/circular_buffer.hpp")
"""Headers that bring more of Boost along than the small one has. A node for the host gets the computer's."""
WHOLE, NOT_WHOLE = ("-Wl,--whole-archive",), ("-Wl,--no-whole-archive",)
"""On cfepy a node has all parts of the library, since a part may be called by the library alone."""
WITH_ARENA = ("-Wl,--wrap=" + ",--wrap=".join(ALLOCATING),)
OWN_CPP_LIBRARY = ("-static-libstdc++", "-static-libgcc")
SYSTEM_ROS = ("/opt/ros/", "/usr/include/ros/", "/usr/local/include/ros/")
BASIC_FOLDERS = ("src", "core", "posix")
"""Folders of the interface library whose sources do not depend on the headers that a node uses."""
HEAP_SOURCE = "heap.cpp"
"""The source of the interface library that contains the arena."""
_EXCEPTIONS = re.compile(r"\b(?:try|catch|throw|typeid|dynamic_cast|dynamic_pointer_cast)\b")
MOST_AT_ONCE = 2
"""Compilers that run at the same time."""


def library_folder() -> Path:
    """Return the folder of the interface library, with its headers and sources.

    Raises:
        UsageError: this installation has none.
    """
    return shipped("roscfe")


def library_includes(real_boost: bool = False) -> list[Path]:
    """Return the folders of the library's headers.

    Args:
        real_boost: whether to use the computer's Boost instead of the small one.
    """
    folder = library_folder()
    return [folder / "include", folder / "threads", *([] if real_boost else [folder / "boost"])]


def needs_real_boost(sources: SourceSet, profile: Profile) -> bool:
    """Return True if sources include a header of Boost that the small one lacks, refuses, or has only in part.

    Args:
        sources: collected with the small one among the folders.
        profile: profile of the build.
    """
    folder = library_folder() / "boost"
    refused = {folder / "boost" / name for name in BOOST_REFUSED}
    in_part = {each / name for each in (folder, library_folder() / "threads") for name in BOOST_IN_PART}
    refused |= in_part if profile is Profile.HOST else set()
    return any(each.startswith("boost/") for each in sources.missing) or not refused.isdisjoint(sources.contents)


def uses_exceptions(sources: SourceSet) -> bool:
    """Return True if sources of a node throw or catch, or ask for types at run time.

    Args:
        sources: also headers. The headers of the library do not count.
    """
    folder = library_folder()
    return any(_EXCEPTIONS.search(text) for file, text in sources.texts.items() if not file.is_relative_to(folder))


def library_sources(used: Iterable[Path], real_boost: bool = False) -> list[Path]:
    """Return the library's sources that a node needs, sorted: the core, and the parts whose headers are used.

    Args:
        used: all headers that the node includes. The headers of the library count.
        real_boost: as of `library_includes`.
    """
    folder, included = library_folder(), list(used)
    every = sorted((folder / "src").rglob("*.cpp"))
    parts = {each.parent.name for each in every} - set(BASIC_FOLDERS)
    needed = [each for each in every if each.parent.name in BASIC_FOLDERS]
    while True:
        reached = [*included, *collect(needed, library_includes(real_boost)).contents]
        inside = (each.relative_to(folder / "include") for each in reached if each.is_relative_to(folder / "include"))
        names = tuple({each.parts[0] for each in inside})
        wanted = {part for part in parts if any(name.startswith(part) for name in names)}
        found = [each for each in every if each.parent.name in (*BASIC_FOLDERS, *wanted)]
        if found == needed:
            return needed
        needed = found


@cache
def posix_threads() -> frozenset[str]:
    """Return the functions of POSIX's threads that the library has for nodes of the host profile."""
    text = (library_folder() / THREADS).read_text(encoding="utf-8")
    return frozenset(re.findall(r"^\S.*?\b((?:pthread|sem|sched)_\w+)\(", text, re.MULTILINE))


def provided_packages() -> set[str]:
    """Return the packages whose headers the library has, such as roscpp. Their own sources are not compiled."""
    known = {"roscpp", "rostime", "rosconsole", "roscpp_serialization", "roscpp_traits", "xmlrpcpp", "cpp_common"}
    return known | {each.name for each in (library_folder() / "include").iterdir() if each.is_dir()}


@dataclass(frozen=True, slots=True)
class BuildOptions:
    """The options of a node's build.

    Attributes:
        profile: the permitted features of the node.
        capacities: of its messages, in the strict profile.
        arena_bytes: size of its heap, in the profiles pool and strict.
        exceptions: whether a node of the profile pool is built with exceptions; see `uses_exceptions`.
    """

    profile: Profile = Profile.HOST
    capacities: Capacities = field(default_factory=Capacities)
    arena_bytes: int = ARENA_BYTES
    exceptions: bool = False

    @property
    def has_exceptions(self) -> bool:
        """Whether the node is built with exceptions and run-time type information."""
        return self.profile is Profile.HOST or (self.profile is Profile.POOL and self.exceptions)

    def flags_of(self, source: Path) -> list[str]:
        """Return the flags that only one source of the interface library gets."""
        is_heap = source.name == HEAP_SOURCE and self.profile is not Profile.HOST
        return [f"-DROSCFE_ARENA_BYTES={self.arena_bytes}"] if is_heap else []


@dataclass(slots=True)
class BuiltNode:
    """A built node.

    Attributes:
        library: the shared object.
        entry: its entry point.
        sources: its source files and headers.
        types: message types whose headers it includes.
    """

    library: Path
    entry: str
    sources: SourceSet
    types: list[str] = field(default_factory=list)


def build_node(program: Program, entry: NodeEntry, library: Library, options: BuildOptions | None = None) -> BuiltNode:
    """Build a node.

    Args:
        program: its sources.
        entry: the generated entry point.
        library: of message types.
        options: the build options; None for the profile host.

    Returns:
        The node, built now or found in the cache.

    Raises:
        UsageError: there is no compiler, or the result would not be fit to fly.
        CompilerError: the compiler refused a source; the text is the compiler's.
    """
    return NodeBuild(program, entry, library, options or BuildOptions()).built()


class NodeBuild:
    """The build of one node; see `build_node`."""

    def __init__(self, program: Program, entry: NodeEntry, library: Library, options: BuildOptions) -> None:
        self._program = program
        self._entry = entry
        self._types = library
        sources = collect(program.sources, [*program.includes, *library_includes()])
        self._options = replace(options, exceptions=uses_exceptions(sources))
        self._real_boost = needs_real_boost(sources, self._options.profile)
        if self._real_boost:
            sources = collect(program.sources, [*program.includes, *library_includes(real_boost=True)])
        self.sources = sources
        self._configurations = configuration_headers(sources.missing, program)
        needed = CONFIGURATION_TYPES if self._configurations else ()
        self.types = sorted({*message_types(sources.missing, library), *needed})

    def built(self) -> BuiltNode:
        """Compile the sources that are not in the cache, and link the node."""
        with tempfile.TemporaryDirectory(prefix="cfepy-node-") as scratch:
            return self._built(Path(scratch))

    def _built(self, scratch: Path) -> BuiltNode:
        program, entry = self._program, self._entry
        messages = messages_folder(self.types, self._types, self._options)
        configurations = configurations_folder(self._configurations)
        includes = [*program.includes, messages, configurations, *library_includes(self._real_boost)]
        main = scratch / "roscfe_main.h"
        main.write_text(main_header(entry.takes_arguments), encoding="utf-8")
        start = scratch / f"{entry.app.lower()}_entry.cpp"
        start.write_text(entry.text(), encoding="utf-8")
        flags = [*LANGUAGE, *PLAIN, *profile_flags(self._options)]
        own = [*flags, *(f"-D{each}" for each in program.definitions), "-include", str(main)]
        made_for_it = (messages.name, configurations.name, main_header(entry.takes_arguments))
        units = []
        for each in program.sources:
            known = _digest(*made_for_it, _label(each, program), *self.sources.read_with(each))
            units.append(CompileUnit(each, own, includes, known))
        header = library_folder() / "include/roscfe/node.h"
        around = _digest(header.read_bytes(), header.with_name("parts.h").read_bytes())
        if entry.nodelet:
            around = _digest(around, *made_for_it, *self.sources.contents.values())
        units.append(CompileUnit(start, flags, includes, _digest(entry.text(), around)))
        units += [self._support(each, flags, includes) for each in program.support]
        core = core_units(self._options, self._real_boost, self._types, self.sources.contents)
        key = _digest(*link_flags(self._options.profile), *(each.key for each in (*core, *units)))
        made = _folder() / f"{entry.app.lower()}-{key}.so"
        mark_used(made, messages, configurations)
        if not made.is_file():
            archive = built_core(self._options.profile, core)
            compile_units(units, entry.name)
            _link(
                [*(str(each.object) for each in units), *WHOLE, str(archive), *NOT_WHOLE],
                made,
                link_flags(self._options.profile),
            )
            with writing_cache(_folder()):
                remove_unused(_folder())
        return BuiltNode(made, entry.symbol, self.sources, self.types)

    def _support(self, source: Path, flags: Sequence[str], includes: Sequence[Path]) -> CompileUnit:
        """Return a library source that is compiled with the program. It does not change when the program changes."""
        known = collect([source], includes).contents
        defined = [f"-D{each}" for each in self._program.definitions if each.startswith("GTEST_")]
        return CompileUnit(source, [*flags, *defined], includes, _digest(*known.values()), needs_cfe=True)


# -- the library -------------------------------------------------------------------------------------------------------


def profile_flags(options: BuildOptions) -> list[str]:
    """Return the flags of a node's sources."""
    return [f"-DROSCFE_PROFILE_{options.profile.name}", *(() if options.has_exceptions else WITHOUT_EXCEPTIONS)]


def core_flags(options: BuildOptions) -> Sequence[str]:
    """Return the flags of the library's own sources, which exceptions of a node pass through."""
    return WITHOUT_TYPES if options.has_exceptions else WITHOUT_EXCEPTIONS


def link_flags(profile: Profile) -> list[str]:
    """Return the linker's flags of a profile. If nodes have an arena, the C++ library's code also allocates there."""
    return [*LINK, *(() if profile is Profile.HOST else (*WITH_ARENA, *OWN_CPP_LIBRARY))]


def messages_folder(types: Sequence[str], library: Library, options: BuildOptions) -> Path:
    """Return a folder in the cache with the headers of message types and of all nested types.

    Args:
        types: full names.
        library: their definitions.
        options: the build options, for the form of messages.
    """
    folder = _folder()
    with _scratch() as scratch:
        made = scratch / "messages"
        made.mkdir()
        files = write_headers(types, made, options.profile, library, options.capacities)
        key = _digest(*(f"{each.relative_to(made)}\0{each.read_text(encoding='utf-8')}" for each in files))
        kept = folder / f"messages-{key}"
        if not kept.is_dir():
            _put(made, kept)
    return kept


def configurations_folder(headers: Mapping[str, str]) -> Path:
    """Return a folder in the cache with the headers of configurations.

    Args:
        headers: texts, by the name in the #include.
    """
    folder = _folder()
    key = _digest(*(f"{name}\0{text}" for name, text in sorted(headers.items())))
    kept = folder / f"configurations-{key}"
    if not kept.is_dir():
        with _scratch() as scratch:
            made = scratch / "configurations"
            made.mkdir()
            for name, text in headers.items():
                write_contained(made, f"/{name}", text.encode())
            _put(made, kept)
    return kept


def core_units(options: BuildOptions, real_boost: bool, library: Library, used: Iterable[Path]) -> list[CompileUnit]:
    """Return the sources of the interface library that a node needs.

    Each has its own cache key, so a node that uses one more part of the library compiles only this part's sources.

    Args:
        options: the build options.
        real_boost: as of `library_includes`.
        library: of message types.
        used: as of `library_sources`.
    """
    files, includes = library_sources(used, real_boost), library_includes(real_boost)
    messages = messages_folder(message_types(collect(files, includes).missing, library), library, options)
    sources = collect(files, [messages, *includes])
    flags = [*LANGUAGE, *PLAIN, *profile_flags(options), *core_flags(options), *STRICT_WARNINGS]
    folder = library_folder()
    return [
        CompileUnit(
            each,
            [*flags, *options.flags_of(each)],
            [messages, *includes],
            _digest(str(each.relative_to(folder)), *sources.read_with(each)),
            needs_cfe=True,
        )
        for each in files
    ]


def built_core(profile: Profile, units: Sequence[CompileUnit]) -> Path:
    """Return the interface library of a profile as an archive, compiled if it is not in the cache.

    Args:
        profile: of the node.
        units: see `core_units`.

    Raises:
        CompilerError: the compiler refused a source.
    """
    key = _digest(*(each.key for each in units), identity())
    archive = _folder() / f"libroscfe-{profile.value}-{key}.a"
    mark_used(archive)
    if not archive.is_file():
        print("cfepy: compiling the interface library of ROS nodes in C++, once", file=sys.stderr, flush=True)
        compile_units(units, "the interface library")
        with _scratch() as scratch:
            made = scratch / archive.name
            _call(["ar", "rcs", str(made), *(str(each.object) for each in units)])
            os.replace(made, archive)
    return archive


# -- compiling ---------------------------------------------------------------------------------------------------------


@dataclass(slots=True)
class CompileUnit:
    """A source to compile.

    Attributes:
        source: the file.
        flags: of the compiler.
        includes: folders of headers.
        known: a digest of all files that are read.
        needs_cfe: whether it includes cFE's headers.
    """

    source: Path
    flags: Sequence[str]
    includes: Sequence[Path]
    known: str
    needs_cfe: bool = False

    @property
    def key(self) -> str:
        """Its cache key, without the release of the compiler."""
        plain = [each for each in self.flags if not each.startswith("/")]
        return _digest(self.known, *plain, *cpp_compiler(), headers_folder().name if self.needs_cfe else "")

    @property
    def object(self) -> Path:
        """The path of its object file in the cache."""
        return _folder() / f"{self.source.stem}-{_digest(self.key, identity())}.o"

    def command(self, made: Path) -> list[str]:
        """Return the compiler's command."""
        folders = [f"-I{each}" for each in self.includes]
        cfe = ["-isystem", str(headers_folder())] if self.needs_cfe else []
        maps = [f"-ffile-prefix-map={self.source.parent}=."]
        watch = ["-MMD", "-MF", str(made.with_suffix(".d"))]
        watch[0] = "-MD"  # also the system's headers
        return [*cpp_compiler(), *self.flags, *folders, *cfe, *maps, *watch, "-c", str(self.source), "-o", str(made)]


def compile_units(units: Iterable[CompileUnit], name: str) -> None:
    """Compile the sources whose object files are not in the cache, a few at once.

    Args:
        units: the sources.
        name: of the thing that they are part of, for the progress.

    Raises:
        CompilerError: the compiler refused a source.
        UsageError: there is no compiler, or a header of a ROS on this computer was used.
    """
    units = list(units)
    mark_used(*(each.object for each in units))
    missing = [each for each in units if not each.object.is_file()]
    with WorkProgress(Stopwatch().elapsed_ns) as progress:
        for at in range(0, len(missing), MOST_AT_ONCE):
            group = missing[at : at + MOST_AT_ONCE]
            with _scratch() as scratch:
                running = [_Compiler(each, scratch / str(index)) for index, each in enumerate(group)]
                try:
                    for number, each in enumerate(running, at + 1):
                        progress.show(f"compiling {name}: {number} of {len(missing)}, {each.source.name}")
                        each.finish(progress.refresh)
                finally:
                    for each in running:
                        each.end()


class _Compiler:
    """A running compiler for one source.

    Args:
        unit: the source.
        folder: folder for its output.

    Attributes:
        source: the source file.
    """

    def __init__(self, unit: CompileUnit, folder: Path) -> None:
        folder.mkdir()
        self.source = unit.source
        self._unit = unit
        self._made = folder / "made.o"
        self._log = folder / "log"
        with self._log.open("wb") as log:
            self._process = start_bounded(unit.command(self._made), log.fileno())

    def finish(self, while_waiting: Callable[[], object]) -> None:
        """Wait for it, and keep the object file. `while_waiting` is called every few seconds."""
        status = end_bounded(self._process, while_waiting)
        if status:
            said = self._log.read_text(encoding="utf-8", errors="replace").rstrip()
            raise CompilerError(said or f"{cpp_compiler()[0]} ended with {status}")
        used = self._made.with_suffix(".d").read_text(encoding="utf-8", errors="replace").split()
        wrong = next((each for each in used if each.startswith(SYSTEM_ROS)), None)
        if wrong is not None:
            text = f"includes {wrong} of the ROS on this computer, which is not available on cFE [system-ros]"
            raise UsageError(text, file=self._unit.source)
        os.replace(self._made, self._unit.object)

    def end(self) -> None:
        """End it if it still runs: another compiler has failed, and its result is not needed."""
        if self._process.poll() is None:
            self._process.terminate()  # GCC's driver ends its child processes
            self._process.wait()


def _call(command: Sequence[str]) -> str:
    status, said = call_bounded(command)
    if status:
        raise CompilerError(said.rstrip() or f"{command[0]} ended with {status}")
    return said.rstrip()


def _link(parts: Sequence[str], made: Path, flags: Iterable[str]) -> None:
    with _scratch() as scratch:
        linked = scratch / made.name
        said = _call([*cpp_compiler(), *flags, *ASK, "-o", str(linked), *parts])
        undefined = [each.name for each in undefined_names(said, with_library=True)]
        if undefined:
            more = f" and {len(undefined) - 4} more" if len(undefined) > 4 else ""
            text = f"uses {', '.join(undefined[:4])}{more}, which no source of the node defines [undefined-name]"
            raise UsageError(text, file=made.name)
        shared = unique_symbols(linked)
        if shared:
            text = f"has {', '.join(shared[:4])}, which all nodes would share [unique-symbol]"
            raise UsageError(text, file=made.name)
        os.replace(linked, made)


def unique_symbols(file: Path) -> list[str]:
    """Return symbols of a shared object that a process has only once, even if several objects have them.

    These are symbols with the binding STB_GNU_UNIQUE.

    Args:
        file: the shared object.
    """
    lines = (line.split() for line in _call(["nm", "-C", str(file)]).splitlines())
    return [" ".join(words[2:]) for words in lines if len(words) > 2 and words[1] == "u"]


@cache
def identity() -> str:
    """Return the version and target of the compiler."""
    return _call([*cpp_compiler(), "-dumpfullversion", "-dumpmachine"])


def _label(source: Path, program: Program) -> str:
    """Return the path of a source in its package, which is the same on each computer."""
    folder = program.package.folder
    return str(source.relative_to(folder)) if source.is_relative_to(folder) else source.name


def _digest(*parts: str | bytes) -> str:
    whole = hashlib.sha256()
    for each in parts:
        data = each.encode() if isinstance(each, str) else each
        whole.update(len(data).to_bytes(8, "big") + data)
    return whole.hexdigest()[:16]


def _folder() -> Path:
    folder = cache_folder() / "roscfe"
    with writing_cache(folder):
        folder.mkdir(exist_ok=True)
    return folder


@contextmanager
def _scratch() -> Iterator[Path]:
    """Provide a folder in the cache for unfinished files. Write errors there are reported to the user."""
    folder = _folder()
    with writing_cache(folder), tempfile.TemporaryDirectory(dir=folder) as scratch:
        yield Path(scratch)


def _put(made: Path, kept: Path) -> None:
    try:
        os.rename(made, kept)
    except OSError:
        if not kept.is_dir():  # otherwise another process was quicker
            raise
