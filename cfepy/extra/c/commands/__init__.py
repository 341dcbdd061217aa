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
        help="compile an application in C, and its tables",
        examples=("cfepy build thermal", "cfepy build apps/hk -o my_mission/hk.so --cfs cFS"),
        description="Compile a cFS application, a folder with fsw/src, fsw/inc and fsw/tables, to NAME.so and its "
        "table files. No cFS tree is needed: cfepy has headers of cFE, OSAL and the PSP.",
        epilog="exit status: 0 built, 1 the compiler refused a file, 2 bad usage, nothing to build or no compiler",
    )
    build.add_argument("folder", metavar="FOLDER", nargs="?", help="the application's folder")
    add_output(build, "NAME.so in the application's folder; table files come beside it")
    tables = build.add_mutually_exclusive_group()
    text = "write all table files; by default a file with other contents stays"
    tables.add_argument("--tables", dest="tables", action="store_const", const="write", default="keep", help=text)
    text = "write no table files"
    tables.add_argument("--no-tables", dest="tables", action="store_const", const="none", help=text)
    build.add_argument("--cfs", metavar="TREE", help="take the headers of this cFS tree in place of cfepy's")
    build.add_argument(
        "--defs", metavar="DIR", help="a folder of a mission's headers, which go before the application's own"
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
    build.add_argument(
        "--headers", action="store_true", help="print the folder of cfepy's headers, for an editor or another build"
    )
    build.add_argument(
        "--gdb-symbols", action="store_true", help="print the script that gives gdb the symbols of applications"
    )
    build.set_defaults(module=f"{__name__}.build")
