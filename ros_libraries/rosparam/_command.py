"""The command `rosparam`: delete, dump, get, list, load, set."""

from __future__ import annotations

import sys
from optparse import OptionParser
from typing import Any, NoReturn
from xmlrpc.client import Binary

import rosgraph
from rosgraph.names import GLOBALNS, script_resolve_name

import rosparam
from rosparam._documents import text_of

USAGE = """rosparam is a command-line tool for getting, setting, and deleting parameters from the ROS Parameter Server.

Commands:
\trosparam set\tset parameter
\trosparam get\tget parameter
\trosparam load\tload parameters from file
\trosparam dump\tdump parameters to file
\trosparam delete\tdelete parameter
\trosparam list\tlist parameter names
"""


def print_usage() -> NoReturn:
    """Say how the command is used, and end the program."""
    print(USAGE)
    sys.exit(0)


def run(argv: list[str]) -> None:
    """Run a command line. Errors are printed and end the program."""
    commands = {"get": _get, "dump": _dump, "set": _set, "load": _load, "delete": _delete, "list": _list}
    command = commands.get(argv[1]) if len(argv) > 1 else None
    if command is None:
        print_usage()
    try:
        command(argv[2:])
    except (rosparam.RosParamException, rosgraph.MasterError) as error:
        print(f"ERROR: {error}", file=sys.stderr)
        sys.exit(1)


def _parser(usage: str) -> OptionParser:
    parser = OptionParser(usage=f"usage: %prog {usage}", prog=rosparam.NAME)
    parser.add_option("-v", dest="verbose", default=False, action="store_true", help="turn on verbose output")
    return parser


def _parse(parser: OptionParser, args: list[str], least: int, most: int) -> tuple[Any, list[str]]:
    options, found = parser.parse_args(args)
    if not least <= len(found) <= most:
        parser.error("too many arguments" if len(found) > most else "invalid arguments. Please say what to do it with")
    return options, found


def _resolve(name: str) -> str:
    return str(script_resolve_name(rosparam.NAME, name))


def _get(args: list[str]) -> None:
    parser = _parser("get [options] parameter")
    parser.add_option("-p", dest="pretty", default=False, action="store_true", help="pretty print. WARNING: not YAML")
    options, (name,) = _parse(parser, args, 1, 1)
    value = rosparam.get_param(_resolve(name))
    if options.pretty and isinstance(value, dict):
        _print_pretty(value, "")
    elif options.pretty and isinstance(value, str):
        print(value)
    else:
        print(text_of(value).removesuffix("\n...\n"))


def _print_pretty(tree: dict[str, Any], indent: str) -> None:
    for key, value in sorted(tree.items()):
        if isinstance(value, dict):
            print(f"{indent}{key}:")
            _print_pretty(value, indent + "  ")
        elif isinstance(value, str) and "\n" in value:
            print("\n".join([f"{indent}{key}: |", *(f"{indent}  {line}" for line in value.split("\n"))]))
        else:
            text = value if isinstance(value, str) else text_of(value).removesuffix("...\n").rstrip("\n")
            print(f"{indent}{key}: {text}")


def _dump(args: list[str]) -> None:
    options, found = _parse(_parser("dump [options] file [namespace]"), args, 0, 2)
    file, namespace = (*found, "", "")[:2]
    rosparam.dump_params(file, _resolve(namespace), options.verbose)


def _set(args: list[str]) -> None:
    parser = _parser("set [options] parameter value")
    parser.add_option("-t", "--textfile", dest="text_file", default=None, metavar="TEXT_FILE", help="take a text file")
    parser.add_option("-b", "--binfile", dest="bin_file", default=None, metavar="BINARY_FILE", help="take a file")
    negative = [each for each in args if each[:1] == "-" and each[1:2].isdigit()]  # optparse takes them for options
    options, found = _parse(parser, [each for each in args if each not in negative], 1, 2)
    name, *values = (*found, *negative)
    if options.text_file:
        with open(options.text_file, encoding="utf-8") as text:
            rosparam.set_param_raw(_resolve(name), text.read(), options.verbose)
    elif options.bin_file:
        with open(options.bin_file, "rb") as data:
            rosparam.set_param_raw(_resolve(name), Binary(data.read()), options.verbose)
    elif not values:
        parser.error("invalid arguments. Please specify a parameter value")
    else:
        rosparam.set_param(_resolve(name), values[0] or "!!str", options.verbose)


def _load(args: list[str]) -> None:
    options, found = _parse(_parser("load [options] file [namespace]"), args, 1, 2)
    file, namespace = (*found, "")[:2]
    for values, place in rosparam.load_file(file, _resolve(namespace), options.verbose):
        rosparam.upload_params(place, values, options.verbose)


def _delete(args: list[str]) -> None:
    options, (name,) = _parse(_parser("delete [options] parameter"), args, 1, 1)
    rosparam.delete_param(_resolve(name), options.verbose)


def _list(args: list[str]) -> None:
    _, found = _parse(_parser("list [namespace]"), args, 0, 1)
    print("\n".join(rosparam.list_params(_resolve(found[0]) if found else GLOBALNS)))
