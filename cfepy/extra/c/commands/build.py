"""`cfepy build`: compile an application in C, in the form of cFS applications, or a whole mission tree."""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from pathlib import Path

from cfepy.cli.json_output import check_json, write_json
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS
from cfepy.cli.user_notes import writing
from cfepy.extra.c import (
    GDB_SYMBOLS,
    Built,
    CompilerError,
    Options,
    TableFiles,
    build,
    ground_differences,
    headers_folder,
)
from cfepy.extra.c.trees import CMAKE_NOTE, TreeOptions, build_tree, is_tree, read_with_cmake
from cfepy.status import UsageError


def run(arguments: argparse.Namespace) -> int:
    """Build the application that the command line names.

    Returns:
        The exit status.

    Raises:
        UsageError: there is nothing to build, no compiler, or a file cannot be written.
    """
    if arguments.headers:
        print(headers_folder())
    if arguments.gdb_symbols:
        print(GDB_SYMBOLS)
    if arguments.folder is None:
        if arguments.headers or arguments.gdb_symbols:
            return ENDED_WELL
        raise UsageError("missing folder: cfepy build FOLDER", field="FOLDER")
    if is_tree(Path(arguments.folder), arguments.defs):
        return _build_tree(arguments)
    _refuse_tree_options(arguments)
    try:
        with writing(arguments.output or arguments.folder, "--output"):
            built = build(arguments.folder, arguments.output, _options(arguments))
    except CompilerError as error:
        print(error, file=sys.stderr)
        return FOUND_PROBLEMS
    _tell(built)
    return ENDED_WELL


def _build_tree(arguments: argparse.Namespace) -> int:
    """Build a mission folder from a tree, and print the report."""
    if arguments.cmake:
        print(CMAKE_NOTE, file=sys.stderr)
    check_json(arguments)
    folder = None if arguments.output is None else Path(arguments.output)
    report = build_tree(Path(arguments.folder), folder, _tree_options(arguments))
    for line in report.lines():
        print(line)
    for step in report.steps:
        print(f"to do: {step}")
    print(f"\nNow: cfepy run {report.folder}")
    write_json(arguments, report.to_json())
    return ENDED_WELL if report.is_complete else FOUND_PROBLEMS


def _tree_options(arguments: argparse.Namespace) -> TreeOptions:
    options = TreeOptions(
        cpu=arguments.cpu,
        definitions=arguments.defs,
        modules=tuple(arguments.modules),
        startup=None if arguments.startup is None else Path(arguments.startup),
        only=tuple(arguments.only),
        stand_ins=tuple(arguments.stand_ins),
        build=replace(_options(arguments), definitions=None),
    )
    return replace(options, reader=read_with_cmake) if arguments.cmake else options


def _refuse_tree_options(arguments: argparse.Namespace) -> None:
    given = {
        name: getattr(arguments, name) for name in ("cpu", "startup", "only", "stand_ins", "modules", "cmake", "json")
    }
    for name, value in given.items():
        if value:
            option = "--stand-in" if name == "stand_ins" else f"--{name}"
            raise UsageError("only valid for a mission tree, a folder with NAME_defs/targets.cmake", field=option)


def _options(arguments: argparse.Namespace) -> Options:
    return Options(
        cfs=None if arguments.cfs is None else Path(arguments.cfs),
        definitions=None if arguments.defs is None else Path(arguments.defs),
        cfe=arguments.cfe,
        optimize=arguments.optimize,
        debug=not arguments.no_debug,
        omit_deprecated=arguments.omit_deprecated,
        coverage=arguments.coverage,
        sanitize_thread=arguments.sanitize_thread,
        flags=arguments.flag,
        tables=TableFiles(arguments.tables),
    )


def _tell(built: Built) -> None:
    library = built.library.resolve()
    for warning in (*built.warnings, *ground_differences(f"/cf/{library.name}", library.parent)):
        print(warning, file=sys.stderr)
    for file in (built.library, *built.tables):
        print(file)
    for file in built.kept:
        note = "kept: it differs from the table in the application's sources; --tables overwrites it"
        print(f"{file}: {note}", file=sys.stderr)
