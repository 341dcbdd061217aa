"""The options of the command build, which compiles applications.

A command belongs here when it works on applications in C.
"""

from __future__ import annotations

import argparse

from cfepy.cli.options import add_output


def add(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add this command to the parser of `cfepy`."""
    build = commands.add_parser(
        "build",
        help="compile an application in C and its tables, or a whole cFS mission tree",
        examples=(
            "cfepy build thermal",
            "cfepy build apps/hk -o my_mission/hk.so --cfs cFS",
            "cfepy build cFS && cfepy run cFS_cpu1",
        ),
        description="Compile a cFS application, a folder with fsw/src, fsw/inc and fsw/tables, to NAME.so and its "
        "table files. No cFS tree is needed: cfepy has headers of cFE, OSAL and the PSP. For a mission tree, a folder "
        "with NAME_defs/targets.cmake, make a mission folder of all applications of a processor, and report what was "
        "built, what stands in for a missing part, and what was left out and why.",
        epilog="exit status: 0 built, 1 the compiler refused a file (of a tree: an application of the startup script "
        "was left out), 2 bad usage, nothing to build or no compiler",
    )
    build.add_argument("folder", metavar="FOLDER", nargs="?", help="the folder of an application, or a mission tree")
    add_output(build, "NAME.so in the application's folder, with table files beside it; for a tree the folder TREE_CPU")
    tables = build.add_mutually_exclusive_group()
    text = "write all table files; by default a file with other contents stays"
    tables.add_argument("--tables", dest="tables", action="store_const", const="write", default="keep", help=text)
    text = "write no table files"
    tables.add_argument("--no-tables", dest="tables", action="store_const", const="none", help=text)
    build.add_argument("--cfs", metavar="TREE", help="take the headers of this cFS tree in place of cfepy's")
    build.add_argument(
        "--defs",
        metavar="DIR",
        help="a folder of a mission's headers, which go before the application's own; of a tree, its folder of "
        "definitions if it has several",
    )
    build.add_argument(
        "--flag", metavar="FLAG", action="append", default=[], help="one more flag of the compiler, as --flag=-DNAME=1"
    )
    build.add_argument("-O", dest="optimize", metavar="LEVEL", default="1", help="the compiler's -O (default: 1)")
    build.add_argument("--no-debug", action="store_true", help="leave debug data out")
    build.add_argument(
        "--omit-deprecated",
        action="store_true",
        help="leave deprecated names out, as OMIT_DEPRECATED=true does in a cFS build: table handles have 32 bits then",
    )
    build.add_argument(
        "--coverage", action="store_true", help="make the code count the lines that it executes, for gcov"
    )
    build.add_argument(
        "--sanitize-thread", action="store_true", help="compile with -fsanitize=thread, so that a run finds races"
    )
    _add_tree(build.add_argument_group("mission trees"))
    build.add_argument(
        "--headers", action="store_true", help="print the folder of cfepy's headers, for an editor or another build"
    )
    build.add_argument(
        "--gdb-symbols", action="store_true", help="print the script that gives gdb the symbols of applications"
    )
    build.set_defaults(module=f"{__name__}.build")


def _add_tree(options: argparse._ArgumentGroup) -> None:
    options.add_argument("--cpu", metavar="NAME", help="the processor of the tree (default: the first one)")
    options.add_argument("--startup", metavar="FILE", help="use this startup script in place of the tree's")
    options.add_argument(
        "--only", metavar="APP", action="append", default=[], help="build only this application; may be given again"
    )
    options.add_argument(
        "--stand-in",
        dest="stand_ins",
        metavar="APP",
        action="append",
        default=[],
        help="use cfepy's own application of this name, in Python, in place of the tree's; may be given again",
    )
    options.add_argument(
        "--cmake",
        action="store_true",
        help="ask CMake for the sources of the tree, which executes what its files contain; cfepy's own reader "
        "executes nothing",
    )
    options.add_argument("--json", metavar="FILE|-", help="write the report as JSON; - writes to standard output")
