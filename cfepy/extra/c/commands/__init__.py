"""The options of the command build, which compiles applications.

A command belongs here when it works on applications in C.
"""

from __future__ import annotations

import argparse

from cfepy.cli.options import add_cfe, add_output


def add(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add this command to the parser of `cfepy`."""
    build = commands.add_parser(
        "build",
        help="compile an application in C and its tables, or a whole cFS mission tree",
        examples=(
            "cfepy build thermal",
            "cfepy build apps/hk -o my_mission/hk.so --cfs cFS",
            "cfepy build cFS -o my_mission",
        ),
        description="Compile a cFS application, a folder with fsw/src, to NAME.so and its table files; cfepy has the "
        "headers of cFE, OSAL and the PSP. Of a mission tree, a folder with NAME_defs/targets.cmake, make a mission "
        "folder, and report its parts: built, stood in for, or left out.",
        epilog="exit status: 0 built, 1 a file was refused or an application left out, 2 bad usage or no compiler",
    )
    build.add_argument("folder", metavar="FOLDER", nargs="?", help="an application's folder, or a mission tree")
    add_output(build, "NAME.so in the application's folder; of a tree TREE_CPU")
    tables = build.add_mutually_exclusive_group()
    text = "write all table files, also over changed ones"
    tables.add_argument("--tables", dest="tables", action="store_const", const="write", default="keep", help=text)
    text = "write no table files"
    tables.add_argument("--no-tables", dest="tables", action="store_const", const="none", help=text)
    build.add_argument("--cfs", metavar="TREE", help="take this cFS tree's headers, not cfepy's")
    build.add_argument(
        "--defs",
        metavar="DIR",
        help="a mission's headers; of a tree, its definitions",
    )
    add_cfe(build)
    build.add_argument(
        "--flag", metavar="FLAG", action="append", default=[], help="a flag of the compiler, as --flag=-DNAME=1"
    )
    build.add_argument("-O", dest="optimize", metavar="LEVEL", default="1", help="the compiler's -O (default: 1)")
    build.add_argument("--no-debug", action="store_true", help="leave debug data out")
    build.add_argument(
        "--omit-deprecated",
        action="store_true",
        help="leave deprecated names out, as OMIT_DEPRECATED=true",
    )
    build.add_argument("--coverage", action="store_true", help="count the executed lines, for gcov")
    build.add_argument("--sanitize-thread", action="store_true", help="compile so that a run finds races")
    _add_tree(build.add_argument_group("mission trees"))
    build.add_argument("--headers", action="store_true", help="print the folder of cfepy's headers")
    build.add_argument("--gdb-symbols", action="store_true", help="print a script with symbols for gdb")
    build.set_defaults(module=f"{__name__}.build")


def _add_tree(options: argparse._ArgumentGroup) -> None:
    options.add_argument("--cpu", metavar="NAME", help="the processor (default: the first one)")
    options.add_argument(
        "--modules",
        metavar="DIR",
        action="append",
        default=[],
        help="find modules here first (CFS_APP_PATH)",
    )
    options.add_argument("--startup", metavar="FILE", help="use this startup script, not the tree's")
    options.add_argument(
        "--only", metavar="APP", action="append", default=[], help="build only this application; repeatable"
    )
    options.add_argument(
        "--stand-in",
        dest="stand_ins",
        metavar="APP",
        action="append",
        default=[],
        help="take cfepy's own application; repeatable",
    )
    options.add_argument(
        "--cmake",
        action="store_true",
        help="ask CMake for the sources; it executes files",
    )
    options.add_argument("--json", metavar="FILE|-", help="write the report as JSON; - writes to standard output")
