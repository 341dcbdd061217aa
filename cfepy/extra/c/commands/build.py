"""`cfepy build`: compile an application in C, in the form of cFS applications, to a shared object and table files."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

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
    try:
        with writing(arguments.output or arguments.folder, "--output"):
            built = build(arguments.folder, arguments.output, _options(arguments))
    except CompilerError as error:
        print(error, file=sys.stderr)
        return FOUND_PROBLEMS
    _tell(built)
    return ENDED_WELL


def _options(arguments: argparse.Namespace) -> Options:
    return Options(
        cfs=None if arguments.cfs is None else Path(arguments.cfs),
        definitions=None if arguments.defs is None else Path(arguments.defs),
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
