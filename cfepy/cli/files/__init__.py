"""The commands tbl and log, which work on cFE's files; their options are defined here.

A command belongs here if it makes, shows or checks a file that goes to a flight computer or comes from it. A command
that flies a mission does not.
"""

from __future__ import annotations

import argparse

from cfepy.cli.options import MISSION_HELP, add_action, add_json, add_mission, add_output, add_perfetto

TBL_STATUS = "exit status: 0 well, 1 differences or faults were found, 2 bad usage or an unreadable file"


def add(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add these commands to the parser of `cfepy`."""
    _add_tbl(commands)
    _add_log(commands)


def _add_tbl(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    tbl = commands.add_parser(
        "tbl",
        help="make, show, compare and check table files",
        description="Convert table files from YAML and back, by the names of their fields; compare and check them.",
        examples=("cfepy tbl show hk_cpy_tbl.tbl --yaml hk_cpy_tbl.yaml", "cfepy tbl build hk_cpy_tbl.yaml"),
        epilog=TBL_STATUS,
    )
    actions = tbl.add_subparsers(metavar="ACTION", dest="action", required=True)
    build = _add_action(actions, "build", "make a table file from a YAML file", "hk_cpy_tbl.yaml")
    build.add_argument("file", metavar="FILE.yaml", help="the table's headers and rows")
    add_output(build, "the YAML file's name with .tbl")
    show = _add_action(actions, "show", "show a table file", "hk_cpy_tbl.tbl --yaml hk_cpy_tbl.yaml")
    show.add_argument("file", metavar="FILE.tbl", help="a table file")
    show.add_argument(
        "--yaml",
        metavar="FILE|-",
        help="write it as YAML, from which build makes the same bytes again, to a file, or with - to standard output "
        "and nothing else there",
    )
    add_json(show, "the table")
    diff = _add_action(actions, "diff", "show the fields in which two tables differ", "old.tbl new.tbl")
    diff.add_argument("file", metavar="A", help="a table file, or a YAML file")
    diff.add_argument("other", metavar="B", help="another")
    verify = _add_action(actions, "verify", "check table files", "tables/hk_cpy_tbl.tbl --mission lab")
    verify.add_argument("files", metavar="FILE.tbl", nargs="+", help="table files")


def _add_action(
    actions: argparse._SubParsersAction[argparse.ArgumentParser], name: str, text: str, example: str
) -> argparse.ArgumentParser:
    action = add_action(actions, name, text, f"tbl {name} {example}", TBL_STATUS)
    add_mission(
        action,
        "--mission",
        help=f"take the tables' layouts from this mission, instead of the folder of a file: {MISSION_HELP}",
    )
    action.add_argument("--layout", metavar="FILE.yaml", help="take a table's layout from a YAML file that has one")
    action.set_defaults(module="cfepy.cli.files.tbl")
    return action


def _add_log(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    log = commands.add_parser(
        "log",
        help="show cFE's files: logs, registries, performance data",
        description="Show the contents of files that cFE wrote; their headers say which kind they are.",
        examples=("cfepy log out/ram/cfe_evs.log", "cfepy log out/ram/cfe_es_perf.dat --perfetto perf.json"),
        epilog="exit status: 0 well, 2 a file that cannot be read or is cut off",
    )
    log.add_argument("files", metavar="FILE", nargs="+", help="a file with a cFE header")
    add_json(log, "an object for each file")
    add_perfetto(log)
    log.set_defaults(module="cfepy.cli.files.log")
