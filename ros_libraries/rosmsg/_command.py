"""The commands `rosmsg` and `rossrv`: show, info, list, md5, package, packages."""

from __future__ import annotations

import sys
from collections.abc import Callable
from optparse import OptionParser
from typing import Any

import rospkg

import rosmsg
from rosmsg._texts import expanded

USAGE = """{0} is a command-line tool for displaying information about ROS {1} types.

Commands:
\t{0} show\tShow {2} description
\t{0} info\tAlias for {0} show
\t{0} list\tList all {2}s
\t{0} md5\tDisplay {2} md5sum
\t{0} package\tList {2}s in a package
\t{0} packages\tList packages that contain {2}s

Type {0} <command> -h for more detailed usage
"""


def usage(mode: str) -> str:
    """How the command is used."""
    what = "Service" if mode == rosmsg.MODE_SRV else "Message"
    return USAGE.format(f"ros{mode[1:]}", what, what.lower())


def run(mode: str) -> None:
    """Run the command line of sys.argv. Errors are printed and end the program."""
    command = COMMANDS.get(sys.argv[1]) if len(sys.argv) > 1 else None
    if command is None:
        print(usage(mode))
        sys.exit(0 if len(sys.argv) < 2 or sys.argv[1] == "--help" else 64)
    try:
        sys.exit(command(mode, sys.argv[2:]))
    except rospkg.ResourceNotFound as error:
        print(f"Invalid package: {error}", file=sys.stderr)
        sys.exit(64)
    except (rosmsg.ROSMsgException, OSError) as error:
        print(error, file=sys.stderr)
        sys.exit(1)


def _parser(mode: str, usage: str, *flags: tuple[str, str, str]) -> OptionParser:
    parser = OptionParser(usage=f"usage: ros{mode[1:]} {usage}")
    for short, name, text in flags:
        parser.add_option(short, f"--{name}", dest=name, default=False, action="store_true", help=text)
    return parser


def _parse(
    mode: str, usage: str, args: list[str], *flags: tuple[str, str, str], most: int = 1
) -> tuple[Any, list[str]]:
    return _parsed(_parser(mode, usage, *flags), args, most)


def _parsed(parser: OptionParser, args: list[str], most: int = 1) -> tuple[Any, list[str]]:
    options, names = parser.parse_args(args)
    if most and not names:
        names = [sys.stdin.readline().strip()]
    if len(names) > most or (most and not names[0]):
        parser.error("you may only specify one name" if len(names) > most else "please say which one")
    return options, names


def _named(mode: str, name: str) -> list[str]:
    """Return the full names of the types that a name stands for."""
    name = name.removesuffix(mode)
    return [name] if "/" in name else list(rosmsg.rosmsg_search(rospkg.RosPack(), mode, name))


def _show(mode: str, args: list[str]) -> int:
    parser = _parser(mode, "show [options] <type>", ("-r", "raw", "show raw text, including comments"))
    parser.add_option("-b", "--bag", dest="bag", metavar="BAGFILE", help="show a message as a bag has it")
    options, (name,) = _parsed(parser, args)
    found: list[Any] = _in_bag(options.bag, name) if options.bag else _named(mode, name)
    if not found:
        print(f"Could not find msg '{name}'", file=sys.stderr)
        return 1
    for each in found:
        if options.bag:
            print(each._full_text if options.raw else expanded(each))
            continue
        if "/" not in name:
            print(f"[{each}]:")
        rosmsg.rosmsg_debug(None, mode, each, options.raw)
    return 0


def _in_bag(file: str, name: str) -> list[Any]:
    """Return a list with the class of a message, made from its definition in a bag, or an empty list.

    Raises:
        rosmsg.ROSMsgException: there is no such bag, or it is broken.
    """
    import rosbag  # which few need
    from genpy.dynamic import generate_dynamic

    try:
        with rosbag.Bag(file, skip_index=True) as bag:
            texts = {each.datatype: each.msg_def for each in bag._connections.values()}
    except FileNotFoundError:
        raise rosmsg.ROSMsgException(f"ERROR: bag file [{file}] does not exist") from None
    except rosbag.ROSBagException as error:
        raise rosmsg.ROSMsgException(f"ERROR reading {file}: {error}") from None
    return [generate_dynamic(name, texts[name])[name]] if name in texts else []


def _md5(mode: str, args: list[str]) -> int:
    _, (name,) = _parse(mode, "md5 <type>", args)
    found = _named(mode, name)
    for each in found:
        try:
            md5sum = rosmsg.rosmsg_md5(mode, each)
        except (rosmsg.ROSMsgException, OSError) as error:
            print(error, file=sys.stderr)
            return 0  # also without a type of that name, as on ROS
        print(md5sum if "/" in name else f"[{each}]: {md5sum}")
    if not found:
        print(f"No messages matching the name [{name}]", file=sys.stderr)
    return 0


def _package(mode: str, args: list[str]) -> int:
    options, (name,) = _parse(mode, "package <package>", args, ("-s", "single", "list all on a single line"))
    print((" " if options.single else "\n").join(rosmsg.list_types(name, mode)))
    return 0


def _packages(mode: str, args: list[str]) -> int:
    options, _ = _parse(mode, "packages", args, ("-s", "single", "list all on a single line"), most=0)
    names = sorted(name for name, _ in rosmsg.iterate_packages(rospkg.RosPack(), mode))
    print((" " if options.single else "\n").join(names))
    return 0


def _list(mode: str, args: list[str]) -> int:
    _parse(mode, "list", args, most=0)
    for package, _ in sorted(rosmsg.iterate_packages(rospkg.RosPack(), mode)):
        print("\n".join(rosmsg.list_types(package, mode)))
    return 0


COMMANDS: dict[str, Callable[[str, list[str]], int]] = {
    "info": _show,
    "list": _list,
    "md5": _md5,
    "package": _package,
    "packages": _packages,
    "show": _show,
}
