"""The build of an application: from its folder to a shared object and table files, in one step.

A C source with CFE_TBL_FILEDEF becomes a table file, as with elf2cfetbl. The compiler has laid out the table's object,
and its bytes are copied unchanged from the object file.
"""

from __future__ import annotations

import os
import struct
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from enum import Enum
from io import BytesIO
from pathlib import Path
from typing import Any, NamedTuple

from cfepy.extra.c.elf import MACHINES, check_elf_reader, elf_file
from cfepy.extra.c.toolchain.cfe6 import (
    OPTION,
    advice_about,
    cfe6_flags,
    check_release,
    neighbour_headers,
    removed_in,
    shows_cfe_6,
)
from cfepy.extra.c.toolchain.compiler import CompileJob, CompilerError, compile_file, compile_files, is_cpp, link
from cfepy.extra.c.toolchain.headers import CfsTree, headers_folder, read_tree
from cfepy.extra.c.toolchain.source_files import Sources, find_sources, own_headers
from cfepy.reading.contained_files import write_contained
from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import OBJECT_BYTES
from cfepy.reading.texts import from_bytes
from cfepy.rtos import Stopwatch
from cfepy.status import UsageError
from cfepy.tbl import TableImage
from cfepy.tbl import build as table_file
from cfepy.writing.work_progress import WorkProgress

WITHOUT_DEPRECATED = ("CFE_OMIT_DEPRECATED_6_8", "CFE_OMIT_DEPRECATED_6_7", "CFE_OMIT_DEPRECATED_6_6")
WITHOUT_DEPRECATED_OSAL = "OSAL_OMIT_DEPRECATED"
COVERAGE_FOLDER = ".coverage"
DEBUG = ("-g3", "-fno-eliminate-unused-debug-types")
"""Debug data with macros and all types: from them ground tools know the packets of an application."""
"""Suffix of a shared object's name: the folder of its object files, in which gcov finds its notes."""
DEFINITION = "CFE_TBL_FileDef"
LAYOUT = struct.Struct("<64s40s32s20sI")
"""CFE_TBL_FileDef_t: name of the object, full name of the table, description, name of the file, bytes."""


class TableFiles(Enum):
    """The table files that a build writes: all, none, or all but those whose place has a file with other contents."""

    KEEP = "keep"
    WRITE = "write"
    NONE = "none"


@dataclass(frozen=True, slots=True)
class Options:
    """Options for the build of an application.

    Attributes:
        cfs: a cFS tree whose headers are used; None for cfepy's.
        definitions: a folder of a mission's headers, which go before the application's own.
        cfe: the release of cFE 6 that the sources are written for, "6.5", "6.7" or "6.8"; None for cFE 7.
        optimize: the compiler's -O, such as "2" or "g".
        debug: whether to include debug data (-g).
        omit_deprecated: whether deprecated names are left out, as with OMIT_DEPRECATED in a cFS build: table handles
            and ids of OSAL are other types then.
        coverage: whether the code counts executed lines for gcov.
        sanitize_thread: whether the code reports its memory accesses (-fsanitize=thread); the loader chooses the
            receiver.
        flags: more flags of the compiler.
        tables: the table files to write.
        goes_on_without_tables: whether a source of a table that cannot be compiled is left out.
    """

    cfs: Path | None = None
    definitions: Path | None = None
    cfe: str | None = None
    optimize: str = "1"
    debug: bool = True
    omit_deprecated: bool = False
    coverage: bool = False
    sanitize_thread: bool = False
    flags: Sequence[str] = ()
    tables: TableFiles = TableFiles.KEEP
    goes_on_without_tables: bool = False


@dataclass(slots=True)
class Built:
    """The results of a build.

    Attributes:
        library: the shared object.
        tables: table files that were written, or that have these contents already.
        kept: existing table files with other contents, which were not written.
        warnings: warnings of the compiler and of the table reader.
        refused: sources of tables that the compiler refused, with its text, where the build goes on without them.
        names: full names of the tables, such as SAMPLE_APP.ExampleTable, by the table file.
    """

    library: Path
    tables: list[Path] = field(default_factory=list)
    kept: list[Path] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    refused: dict[Path, str] = field(default_factory=dict)
    names: dict[str, str] = field(default_factory=dict)


def build(folder: str | Path, library: str | Path | None = None, options: Options | None = None) -> Built:
    """Build an application.

    Args:
        folder: of the application, in the form that cFS has: fsw/src, fsw/inc, fsw/tables, CMakeLists.txt.
        library: the shared object to write; NAME.so in the folder itself when None. Table files come beside it, where a
            different file stays.
        options: the build options; the defaults when None.

    Returns:
        The written files.

    Raises:
        UsageError: the folder has nothing to build, or there is no compiler.
        CompilerError: the compiler refused a file; the text is the compiler's.
    """
    options = options or Options()
    check_options(options)
    return build_sources(find_sources(Path(folder), options.definitions), library, options)


def check_options(options: Options) -> None:
    """Check that options can be combined.

    Raises:
        UsageError: they cannot.
    """
    check_release(options.cfe)
    if options.cfe is not None and options.omit_deprecated:
        text = "cannot be combined with --omit-deprecated, because ids are numbers in cFE 6"
        raise UsageError(text, field=OPTION)
    if options.cfe is not None and options.cfs is not None:
        raise UsageError("cannot be combined with --cfs; cfepy's headers have the names of cFE 6", field=OPTION)


def build_sources(
    sources: Sources, library: str | Path | None, options: Options, progress: WorkProgress | None = None
) -> Built:
    """Build an application whose sources are known.

    Args:
        sources: its sources.
        library: the shared object to write; NAME.so in the application's folder when None.
        options: the build options.
        progress: shows the source that is being compiled; one of its own when None.

    Returns:
        The written files. It raises the errors of `build`.
    """
    built = Built(Path(library) if library is not None else sources.folder / f"{sources.name}.so")
    built.library.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="cfepy-build-") as scratch:
        if progress is not None:
            _Builder(sources, options, Path(scratch), built, progress).build()
            return built
        with WorkProgress(Stopwatch().elapsed_ns) as own:
            _Builder(sources, options, Path(scratch), built, own).build()
    return built


def build_tables(sources: Sources, library: Path, options: Options, progress: WorkProgress) -> Built:
    """Build only the tables of an application, beside a shared object that exists already; see `build_sources`."""
    built = Built(library)
    with tempfile.TemporaryDirectory(prefix="cfepy-build-") as scratch:
        _Builder(sources, options, Path(scratch), built, progress).build_tables()
    return built


class _Builder:
    """Builds one application.

    Args:
        sources: its sources.
        options: the build options.
        scratch: a folder for temporary files.
        built: gets the results.
        progress: shows the source that is being compiled.
    """

    def __init__(self, sources: Sources, options: Options, scratch: Path, built: Built, progress: WorkProgress) -> None:
        self._sources = sources
        self._progress = progress
        self._started = 0
        self._objects: set[Path] = set()
        self._options = options
        self._scratch = scratch
        self._built = built
        tree = CfsTree() if options.cfs is None else read_tree(options.cfs)
        chosen = scratch / "include"
        chosen.mkdir()
        for name, file in (tree.chosen | sources.chosen).items():
            write_contained(chosen, f"/{name}", b"" if file is None else f'#include "{file}"\n'.encode())
        headers = [headers_folder()] if options.cfs is None else tree.includes
        self._flags = [f"-I{each}" for each in (*sources.includes, chosen, *headers)]
        if options.cfe is not None:
            self._flags += [*cfe6_flags(options.cfe, headers_folder()), *neighbour_headers(sources.folder)]
        self._flags.append(f"-ffile-prefix-map={scratch}=.")  # so that two builds give the same bytes
        self._flags += [f"-D{each}" for each in sources.definitions]
        if options.omit_deprecated:
            self._flags += [f"-D{each}" for each in (*WITHOUT_DEPRECATED, WITHOUT_DEPRECATED_OSAL)]

    def build(self) -> None:
        """Build code and tables. Nothing is written before everything is compiled."""
        if self._table_sources:
            check_elf_reader()
        code = self._code()
        tables = self._tables()
        flags = [*(["--coverage"] if self._options.coverage else []), *self._options.flags]
        link(code, self._built.library, flags, with_cpp=any(is_cpp(each) for each in self._sources.code))
        for table in tables:
            self._write(table)

    def build_tables(self) -> None:
        """Build the tables alone."""
        for table in self._tables():
            self._write(table)

    @property
    def _table_sources(self) -> Sequence[Path]:
        return () if self._options.tables is TableFiles.NONE else self._sources.tables

    def _write(self, table: TableObject) -> None:
        """Write a table file. One with other contents stays, because a mission may have its own."""
        path = self._built.library.parent / table.file
        data = table_file(table.table)
        self._built.names[table.file] = table.table.name
        if self._options.tables is TableFiles.KEEP and os.path.lexists(path) and not _has(path, data):
            self._built.kept.append(path)
            return
        write_contained(path.parent, f"/{table.file}", data)
        self._built.tables.append(path)

    def _code(self) -> list[Path]:
        options = self._options
        flags = [*self._flags, f"-O{options.optimize}", *(DEBUG if options.debug else ())]
        where = self._scratch
        if options.coverage:  # its notes are written beside the object files, and gcov needs them later
            flags.append("--coverage")
            where = self._built.library.with_name(self._built.library.name + COVERAGE_FOLDER)
            where.mkdir(exist_ok=True)
        if options.sanitize_thread:
            flags.append("-fsanitize=thread")
        flags += options.flags
        jobs = [CompileJob(each, self._object(each, where.resolve()), flags) for each in self._sources.code]
        try:
            warnings = compile_files(jobs, lambda job: self._show(job.source), self._progress.refresh)
        except CompilerError as error:
            raise self._with_hint(error) from None
        if self._options.cfe is not None:  # C only warns of a function that is declared nowhere
            removed = removed_in("\n".join(warnings), self._all_sources())
            if removed:
                raise CompilerError("\n".join(map(str, removed)))
        self._built.warnings += filter(None, warnings)
        return [each.made for each in jobs]

    def _object(self, source: Path, where: Path) -> Path:
        """Return the object file of a source, in the same subfolders, because sources may share a name."""
        is_inside = ".." not in source.parts and source.is_relative_to(self._sources.folder)
        inner = source.relative_to(self._sources.folder) if is_inside else Path(source.name)
        made = where / inner.with_name(f"{source.name}.o")
        while made in self._objects:  # files outside of the folder may share a name
            made = made.with_name(f"_{made.name}")
        self._objects.add(made)
        made.parent.mkdir(parents=True, exist_ok=True)
        return made

    def _tables(self) -> list[TableObject]:
        found = []
        for source in self._table_sources:
            made = self._scratch / f"table-{source.name}.o"
            names = [f'-DCFE_APP_NAME="{self._sources.name}"', f"-DCFE_TABLE_NAME={source.stem}", "-DCFE_CPU_NAME=cpu1"]
            more = [f"-I{each}" for each in self._sources.table_includes]
            more += [f"-D{each}" for each in self._sources.table_definitions if "CFE_APP_NAME=" not in each]
            try:
                self._compile(source, made, [*self._flags, *more, *names, *self._options.flags])
                table = read_table(read_limited(made, OBJECT_BYTES), source)
            except (CompilerError, UsageError) as error:
                if not self._options.goes_on_without_tables:
                    raise
                self._built.refused[source] = str(error)
                continue
            if table.addresses:
                text = f"{table.addresses} words of the table are addresses, which become 0 in the table file"
                self._built.warnings.append(f"{source}: warning: {text}")
            found.append(table)
        return found

    def _compile(self, source: Path, made: Path, flags: Sequence[str]) -> Path:
        self._show(source)
        try:
            warnings = compile_file(source, made, flags, self._progress.refresh)
        except CompilerError as error:
            raise self._with_hint(error) from None
        if warnings:
            self._built.warnings.append(warnings)
        return made

    def _show(self, source: Path) -> None:
        """Show a source that is about to be compiled."""
        self._started += 1
        total = len(self._sources.code) + len(self._table_sources)
        self._progress.show(f"compiling {self._sources.name}: {self._started} of {total}, {source.name}")

    def _all_sources(self) -> list[Path]:
        return [*self._sources.code, *self._table_sources, *own_headers(self._sources)]

    def _with_hint(self, error: CompilerError) -> CompilerError:
        """Return an error with advice: names of cFE 6, and neighbours that were not found if a header is missing."""
        sources = self._all_sources()
        if self._options.cfe is not None:
            removed = [str(each) for each in removed_in(str(error), sources)]
            if removed:
                return CompilerError("\n".join([str(error), *removed]))
        elif unknown := shows_cfe_6(str(error)):
            return CompilerError(f"{error}\n{advice_about(unknown, sources)}")
        if not self._sources.missing or "No such file" not in str(error):
            return error
        missing = ", ".join(self._sources.missing)
        hint = f"(It uses headers of {missing}: put that folder next to this one, or add --flag=-IFOLDER)"
        return CompilerError(f"{error}\n{hint}")


# -- tables ------------------------------------------------------------------------------------------------------------


class TableObject(NamedTuple):
    """A table out of an object file.

    Attributes:
        file: the name of the table file.
        table: its contents.
        addresses: number of its words that are addresses, which a table file cannot have: 0 is written for them.
    """

    file: str
    table: TableImage
    addresses: int


def _has(path: Path, data: bytes) -> bool:
    """Return whether a file exists and has these contents."""
    try:
        return os.path.getsize(path) == len(data) and read_limited(path, max(len(data), 1)) == data
    except (OSError, UsageError):
        return False


def read_table(data: bytes, source: Path) -> TableObject:
    """Return the table in an object file.

    Args:
        data: the object file.
        source: its source file, for errors.

    Raises:
        UsageError: it defines no table, or an object that it does not have; or pyelftools is not installed.
    """
    elf = elf_file(BytesIO(data))
    if elf["e_type"] != "ET_REL" or elf["e_machine"] not in MACHINES or not elf.little_endian:
        raise UsageError(
            "must be compiled to an object file of this computer; check that CC is not a cross compiler", file=source
        )
    symbols = {each.name: each for each in elf.get_section_by_name(".symtab").iter_symbols() if each.name}
    if DEFINITION not in symbols:
        raise UsageError(
            "missing table definition; end the file with CFE_TBL_FILEDEF(OBJECT, APP.Table, text, file)", file=source
        )
    definition, _ = _bytes_of(elf, symbols[DEFINITION])
    if len(definition) != LAYOUT.size:
        text = f"{DEFINITION} must have {LAYOUT.size} bytes, not {len(definition)}"
        raise UsageError(f"{text}: it is not the CFE_TBL_FileDef_t of these headers", file=source)
    *texts, size = LAYOUT.unpack(definition)
    name, table, description, file = map(from_bytes, texts)
    if name not in symbols or symbols[name]["st_shndx"] == "SHN_UNDEF":
        raise UsageError(f"CFE_TBL_FILEDEF: {name!r} is not an object in this file", file=source)
    if not file or "/" in file:
        raise UsageError(f"CFE_TBL_FILEDEF: {file!r} is not a valid file name", file=source)
    content, addresses = _bytes_of(elf, symbols[name])
    return TableObject(file, TableImage(table, content[:size], description), addresses)


def _bytes_of(elf: Any, symbol: Any) -> tuple[bytes, int]:
    """Return an object's bytes, and how many words of it the linker would fill in."""
    where, at, size = symbol["st_shndx"], symbol["st_value"], symbol["st_size"]
    if not isinstance(where, int):  # SHN_COMMON: never set
        return bytes(size), 0
    section = elf.get_section(where)
    if section["sh_type"] == "SHT_NOBITS":
        return bytes(size), 0
    addresses = sum(at <= offset < at + size for offset in _filled_in(elf, where))
    return section.data()[at : at + size], addresses


def _filled_in(elf: Any, section: int) -> Iterator[int]:
    """Yield offsets of words in a section that a linker would fill in."""
    for each in elf.iter_sections():
        if each["sh_type"] in ("SHT_RELA", "SHT_REL") and each["sh_info"] == section:
            yield from (relocation["r_offset"] for relocation in each.iter_relocations())
