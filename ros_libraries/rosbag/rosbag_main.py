"""The subcommands of `rosbag` that work on files, for nodes and tools that call `rosbagmain`.

`record` and `play` are nodes: `rosbag._record` and `rosbag._play`. Imports the modules beside it.
"""

from __future__ import annotations

import argparse
import os
import shutil
import sys
from collections.abc import Callable, Sequence
from typing import Any

import genpy.message
from rosbag_storage import ROSBagException, ROSBagUnindexedException

from .bag import Bag, Compression

EXPRESSIONS = "topic: name of the topic; m: the message; t: its time, with t.secs and t.nsecs"


def rosbagmain(argv: Sequence[str] | None = None) -> None:
    """Run the command `rosbag`.

    Args:
        argv: the command line with the program's name; None takes that of the node.

    Raises:
        SystemExit: an invalid command line, or a bag that cannot be read.
    """
    words = list(sys.argv if argv is None else argv)[1:]
    if words and words[0] in ("record", "play"):
        _start_node(words[0], words[1:])
        return
    chosen = _parser().parse_args(words)
    chosen.run(chosen)


def _start_node(name: str, words: list[str]) -> None:
    from . import _play, _record

    (_record if name == "record" else _play).main([f"rosbag {name}", *words])


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="rosbag", description="Record, replay and work on bags.")
    commands = parser.add_subparsers(metavar="COMMAND", required=True)
    commands.add_parser("record", help="record topics into a bag")
    commands.add_parser("play", help="play bags back")
    _add_info(commands)
    _add_check(commands)
    _add_filter(commands)
    compress = _add_rewrite(commands, "compress", "compress bags", lambda chosen: _recompress(chosen, chosen.kind))
    compress.add_argument("-j", "--bz2", dest="kind", action="store_const", const=Compression.BZ2)
    compress.add_argument("--lz4", dest="kind", action="store_const", const=Compression.LZ4)
    compress.set_defaults(kind=Compression.BZ2)
    _add_rewrite(commands, "decompress", "decompress bags", lambda chosen: _recompress(chosen, Compression.NONE))
    _add_rewrite(commands, "reindex", "rebuild the index of bags", _reindex)
    return parser


# -- info --------------------------------------------------------------------------------------------------------------


def _add_info(commands: Any) -> None:
    info = commands.add_parser("info", help="summarize the contents of bags")
    info.add_argument("bags", nargs="+")
    info.add_argument("-y", "--yaml", action="store_true", help="as YAML")
    info.add_argument("-k", "--key", help="only one value of the YAML")
    info.add_argument("--freq", action="store_true", help="with the frequencies of topics")
    info.set_defaults(run=_info)


def _info(chosen: Any) -> None:
    if chosen.key and not chosen.yaml:
        sys.exit("rosbag info: You can only specify key when printing in YAML format.")
    for number, name in enumerate(chosen.bags):
        with _opened(name, skip_index=not chosen.freq) as bag:
            text = bag._get_yaml_info(chosen.key) if chosen.yaml else str(bag)
        if number:
            print("---")
        if text is not None:
            print(text)


def _opened(name: str, **options: Any) -> Bag:
    try:
        return Bag(name, **options)
    except ROSBagUnindexedException:
        sys.exit(f"ERROR bag unindexed: {name}.  Run rosbag reindex.")
    except (ROSBagException, OSError) as error:
        sys.exit(f"ERROR reading {name}: {error}")


# -- check -------------------------------------------------------------------------------------------------------------


def _add_check(commands: Any) -> None:
    check = commands.add_parser("check", help="tell which messages of a bag have other definitions than here")
    check.add_argument("bag")
    check.set_defaults(run=_check)


def _check(chosen: Any) -> None:
    """Check the message types. Without migration rules, a message type with another md5sum cannot be used."""
    with _opened(chosen.bag) as bag:
        kinds = dict.fromkeys((each.datatype, each.md5sum) for each in bag._connections.values())
    migrations = [(*kind, _sum_of(kind[0])) for kind in kinds if kind[1] != _sum_of(kind[0])]
    if not migrations:
        print("Bag file does not need any migrations.")
        return
    print("The following migrations need to occur:")
    for name, there, here in migrations:
        print(f" * From: {name} [{there}]\n   To:   {f'{name} [{here}]' if here else 'Unknown'}")
    sys.exit(1)


def _sum_of(name: str) -> str | None:
    """Return the md5sum of a message type on this computer, or None if there is no such type."""
    kind = genpy.message.get_message_class(name)
    return None if kind is None else str(kind._md5sum)


# -- filter ------------------------------------------------------------------------------------------------------------


def _add_filter(commands: Any) -> None:
    chosen = commands.add_parser("filter", help="copy some messages of a bag", epilog=EXPRESSIONS)
    for name in ("inbag", "outbag", "expression"):
        chosen.add_argument(name)
    chosen.add_argument("-p", "--print", dest="shown", help="an expression to print for each message")
    chosen.set_defaults(run=_filter)


def _filter(chosen: Any) -> None:
    if not os.path.isfile(chosen.inbag):
        print(f"Cannot locate input bag file [{chosen.inbag}]", file=sys.stderr)
        sys.exit(2)
    if os.path.realpath(chosen.inbag) == os.path.realpath(chosen.outbag):
        print(f"Cannot use same file as input and output [{chosen.inbag}]", file=sys.stderr)
        sys.exit(3)
    wanted = _function(chosen.expression)
    shown = _function(chosen.shown) if chosen.shown else None
    with _opened(chosen.inbag) as source, Bag(chosen.outbag, "w") as target:
        for topic, message, stamp, header in source.read_messages(return_connection_header=True):
            is_wanted = wanted(topic, message, stamp)
            if shown is not None:
                print("MATCH" if is_wanted else "NO MATCH", shown(topic, message, stamp))
            if is_wanted:
                target.write(topic, message, stamp, connection_header=header)


def _function(expression: str) -> Callable[..., Any]:
    made: Callable[..., Any] = eval(f"lambda topic, m, t: {expression}")
    return made


# -- writing anew ------------------------------------------------------------------------------------------------------


def _add_rewrite(commands: Any, name: str, text: str, run: Callable[[Any], None]) -> Any:
    chosen = commands.add_parser(name, help=text)
    chosen.add_argument("bags", nargs="+")
    chosen.add_argument("--output-dir", help="where to write; the default keeps the old bag as NAME.orig.bag")
    chosen.add_argument("-f", "--force", action="store_true", help="overwrite an older NAME.orig.bag")
    chosen.add_argument("-q", "--quiet", action="store_true", help="say less")
    chosen.set_defaults(run=run)
    return chosen


def _places(chosen: Any, name: str) -> tuple[str, str] | None:
    """Return the paths for reading and writing a bag; the old one is moved. None means that the bag must stay."""
    if chosen.output_dir is not None:
        return name, os.path.join(chosen.output_dir, os.path.basename(name))
    stem, ending = os.path.splitext(name)
    kept = f"{stem}.orig{ending}"
    if os.path.exists(kept) and not chosen.force:
        if not chosen.quiet:
            print(f"Skipping {name}. Backup path {kept} already exists.", file=sys.stderr)
        return None
    os.rename(name, kept)
    return kept, name


def _recompress(chosen: Any, kind: str) -> None:
    for name in chosen.bags:
        _opened(name, skip_index=True).close()
        places = _places(chosen, name)
        if places is None:
            continue
        with _opened(places[0]) as source, Bag(places[1], "w", compression=kind) as target:
            for topic, parts, stamp, header in source.read_messages(raw=True, return_connection_header=True):
                target.write(topic, parts, stamp, raw=True, connection_header=header)


def _reindex(chosen: Any) -> None:
    for name in chosen.bags:
        places = _places(chosen, name)
        if places is None:
            continue
        shutil.copyfile(*places)
        with Bag(places[1], "a", allow_unindexed=True) as bag:
            for _ in bag.reindex():
                pass
