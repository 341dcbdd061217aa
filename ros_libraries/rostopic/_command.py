"""The command `rostopic`: bw, delay, echo, find, hz, info, list, pub, type."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from optparse import OptionParser
from typing import Any, NoReturn

import rosgraph
import rosgraph.names
import roslib.message
import rospy

import rostopic
from rostopic._publishing import argv_publish, create_publisher, stdin_publish

USAGE = """rostopic is a command-line tool for printing information about ROS Topics.

Commands:
\trostopic bw\tdisplay bandwidth used by topic
\trostopic delay\tdisplay delay of topic from timestamp in header
\trostopic echo\tprint messages to screen
\trostopic find\tfind topics by type
\trostopic hz\tdisplay publishing rate of topic
\trostopic info\tprint information about active topic
\trostopic list\tlist active topics
\trostopic pub\tpublish data to topic
\trostopic type\tprint topic or field type

Type rostopic <command> -h for more detailed usage, e.g. 'rostopic echo -h'
"""


def print_usage() -> NoReturn:
    """Say how the command is used, and end the program."""
    print(USAGE)
    sys.exit(64)


def run(argv: list[str]) -> None:
    """Run a command line. Errors are printed and end the program."""
    argv = rospy.myargv(argv)
    command = COMMANDS.get(argv[1]) if len(argv) > 1 else None
    if command is None:
        print_usage()
    try:
        command(argv[2:])
    except OSError:
        sys.stderr.write("Network communication failed. Most likely failed to communicate with master.\n")
        sys.exit(1)
    except (rosgraph.MasterException, rostopic.ROSTopicException) as error:
        sys.stderr.write(f"ERROR: {error}\n")
        sys.exit(1)


def _parser(usage: str) -> OptionParser:
    return OptionParser(usage=f"usage: %prog {usage}", prog=rostopic.NAME)


def _one(parser: OptionParser, names: list[str], what: str) -> str:
    if len(names) != 1:
        parser.error(f"{what} must be specified" if not names else f"you may only specify one {what}")
    return names[0]


def _resolve(name: str) -> str:
    return rosgraph.names.script_resolve_name(rostopic.NAME, name)


def _number(parser: OptionParser, text: str | None, kind: Callable[[str], Any], what: str) -> Any:
    if text is None:
        return None
    try:
        return kind(text)
    except ValueError:
        parser.error(f"{what} must be {'an integer' if kind is int else 'a number'}")


def _become_a_node(disable_rostime: bool = False) -> None:
    if not rospy.core.is_initialized():
        rospy.init_node(rostopic.NAME, anonymous=True, disable_rostime=disable_rostime)


def _watch(report: Callable[[], None]) -> None:
    """Report each second, until the end."""
    while not rospy.is_shutdown():
        rospy.rostime.wallsleep(1.0)
        report()


def _condition(expression: str | None) -> Callable[[Any], Any] | None:
    """Return a filter of messages from an expression in which `m` is the message."""
    return None if expression is None else lambda m: eval(expression, {"m": m})


# -- questions -------------------------------------------------------------------------------------------------------


def _find(args: list[str]) -> None:
    parser = _parser("find msg-type")
    _, names = parser.parse_args(args)
    print("\n".join(rostopic.find_by_type(_one(parser, names, "message type"))))


def _info(args: list[str]) -> None:
    parser = _parser("info /topic")
    _, names = parser.parse_args(args)
    print(rostopic.get_info_text(_resolve(_one(parser, names, "topic name"))))


def _type(args: list[str]) -> None:
    parser = _parser("type topic_or_field")
    _, names = parser.parse_args(args)
    topic = _resolve(_one(parser, names, "topic"))
    kind, name, _ = rostopic.get_topic_type(topic)
    if kind is None or name is None:
        sys.stderr.write(f"unknown topic type [{topic}]\n")
        sys.exit(1)
    field = topic[len(name) + 1 :]
    print(f"{kind} {field} {_field_type(kind, field)}" if field else kind)


def _field_type(kind: str, path: str) -> str | None:
    """Return the type of a field, or None if there is no such field."""
    found: str | None = kind
    for field in path.split("/") if path else ():
        message_class = roslib.message.get_message_class(found.partition("[")[0]) if found else None
        types = dict(zip(message_class.__slots__, message_class._slot_types, strict=True)) if message_class else {}
        found = types.get(field.partition("[")[0])
    return found


def _list(args: list[str]) -> None:
    parser = _parser("list [/namespace]")
    parser.add_option("-b", "--bag", dest="bag", default=None, help="list topics in .bag file", metavar="BAGFILE")
    for short, name, text in (
        ("-v", "verbose", "list full details about each topic"),
        ("-p", "publishers", "list only publishers"),
        ("-s", "subscribers", "list only subscribers"),
    ):
        parser.add_option(short, f"--{name}", dest=name, default=False, action="store_true", help=text)
    parser.add_option("--host", dest="hostname", default=False, action="store_true", help="group by host name")
    options, names = parser.parse_args(args)
    if len(names) > 1:
        parser.error("you may only specify one input topic")
    if options.publishers and options.subscribers:
        parser.error("you may only specify one of -p, -s")
    topic = _resolve(names[0]) if names else None
    if options.bag:
        _list_bag(options.bag, topic)
        return
    master = rosgraph.Master(rostopic._ID)
    sides = rostopic.get_topic_list(master)
    publishers, subscribers = ([row for row in rows if _below(row[0], topic)] for rows in sides)
    hosts: dict[str, tuple[Any, Any]] = {"": (publishers, subscribers)}
    if options.hostname:
        published, subscribed = rostopic._rostopic_list_group_by_host(master, publishers, subscribers)
        names = sorted({**published, **subscribed})
        hosts = {host: (published.get(host, []), subscribed.get(host, [])) for host in names}
    for host, (ours, theirs) in hosts.items():
        if host:
            print(f"Host [{host}]:")
        _print_rows([] if options.subscribers else ours, [] if options.publishers else theirs, options, host)


def _below(name: str, topic: str | None) -> bool:
    return topic is None or name == topic or name.startswith(rosgraph.names.make_global_ns(topic))


def _print_rows(published: list[rostopic._Row], subscribed: list[rostopic.Row], options: Any, host: str) -> None:
    indent = "  " if host else ""
    if not options.verbose:
        names = sorted({row[0] for row in (*published, *subscribed)})
        print("\n".join(indent + name for name in names))
        return
    for title, one, rows, wanted in (
        ("Published topics:", "publisher", published, not options.subscribers),
        ("Subscribed topics:", "subscriber", subscribed, not options.publishers),
    ):
        if wanted:
            print(f"\n{indent}{title}")
            for name, kind, nodes in rows:
                print(f"{indent} * {name} [{kind}] {len(nodes)} {one}{'s' if len(nodes) > 1 else ''}")
    print()


def _list_bag(file: str, topic: str | None) -> None:
    import time

    import rosbag

    if not os.path.exists(file):
        raise rostopic.ROSTopicException(f"bag file [{file}] does not exist")
    with rosbag.Bag(file) as bag:
        found = [(name, stamp) for name, _, stamp in bag.read_messages(raw=True) if _below(name, topic)]
    if topic is None:
        print("\n".join(dict.fromkeys(name for name, _ in found)))
        return
    ends = [stamp.to_time() for _, stamp in (found[0], found[-1])] if found else [0.0, 0.0]
    first, last = (time.strftime("%d %b %Y %H:%M:%S", time.localtime(end)) for end in ends)
    print(f"{len(found)} message(s) from {first} to {last}")


# -- watching --------------------------------------------------------------------------------------------------------


def _hz(args: list[str]) -> None:
    parser = _parser("hz [options] /topic_0 [/topic_1 [topic_2 [..]]]")
    parser.add_option("-w", "--window", dest="window", default="-1", metavar="WINDOW", help="window size in messages")
    parser.add_option("--filter", dest="filter", default=None, metavar="EXPR", help="only measure matching messages")
    parser.add_option("--wall-time", dest="wall", default=False, action="store_true", help="use wall time")
    parser.add_option("--tcpnodelay", dest="no_delay", default=False, action="store_true", help="accepted")
    options, names = parser.parse_args(args)
    if not names:
        parser.error("topic must be specified")
    window = _number(parser, options.window, int, "window size")
    rostopic._check_master()
    _become_a_node()
    rates = rostopic.ROSTopicHz(window, _condition(options.filter), options.wall)
    topics = [_resolve(name) for name in names]
    for topic in topics:
        message_class, name, _ = rostopic.get_topic_class(topic, blocking=True)
        if name is None:
            return
        kind = rospy.AnyMsg if options.filter is None else message_class
        rospy.Subscriber(name, kind, rates.callback_hz, callback_args=topic)
        print(f"subscribed to [{name}]")
    _watch(lambda: rates.print_hz(topics))


def _delay(args: list[str]) -> None:
    parser = _parser("delay [options] /topic")
    parser.add_option("-w", "--window", dest="window", default="-1", metavar="WINDOW", help="window size in messages")
    parser.add_option("--tcpnodelay", dest="no_delay", default=False, action="store_true", help="accepted")
    options, names = parser.parse_args(args)
    message_class, name, _ = rostopic.get_topic_class(_resolve(_one(parser, names, "topic")), blocking=True)
    if name is None:
        return
    _become_a_node()
    delays = rostopic.ROSTopicDelay(_number(parser, options.window, int, "window size"))
    rospy.Subscriber(name, message_class, delays.callback_delay)
    print(f"subscribed to [{name}]")
    _watch(delays.print_delay)


def _bw(args: list[str]) -> None:
    parser = _parser("bw /topic")
    parser.add_option("-w", "--window", dest="window", default=None, metavar="WINDOW", help="window size in messages")
    options, names = parser.parse_args(args)
    topic = _resolve(_one(parser, names, "topic"))
    rostopic._check_master()
    _, name, _ = rostopic.get_topic_type(topic, blocking=True)
    if name is None:
        return
    _become_a_node(disable_rostime=True)
    counted = rostopic.ROSTopicBandwidth(_number(parser, options.window, int, "window size"))
    rospy.Subscriber(name, rospy.AnyMsg, counted.callback)
    print(f"subscribed to [{name}]")
    _watch(counted.print_bw)


def _echo(args: list[str]) -> None:
    parser = _parser("echo [options] /topic")
    parser.add_option("-b", "--bag", dest="bag", default=None, metavar="BAGFILE", help="echo messages from .bag file")
    parser.add_option("-w", dest="width", default=None, metavar="NUM_WIDTH", help="fixed width for numeric values")
    parser.add_option("--filter", dest="filter", default=None, metavar="EXPR", help="print matching messages only")
    parser.add_option("-n", dest="count", default=None, metavar="COUNT", help="number of messages to echo")
    for names, name, text in (
        (["-p"], "plot", "echo in a plotting friendly format"),
        (["--nostr"], "nostr", "exclude string fields"),
        (["--noarr"], "noarr", "exclude arrays"),
        (["-c", "--clear"], "clear", "clear screen before printing next message"),
        (["-a", "--all"], "all_topics", "display all messages in bag, only valid with -b option"),
        (["--offset"], "offset", "display time as offsets from current time (in seconds)"),
    ):
        parser.add_option(*names, dest=name, default=False, action="store_true", help=text)
    options, found = parser.parse_args(args)
    if options.all_topics and not options.bag:
        parser.error("Display all option is only valid when echoing from bag files")
    topic = "" if options.all_topics else _resolve(_one(parser, found, "topic"))
    echo = rostopic.CallbackEcho(
        topic,
        None,
        plot=options.plot,
        filter_fn=_condition(options.filter),
        echo_clear=options.clear,
        echo_all_topics=options.all_topics,
        offset_time=options.offset,
        count=_number(parser, options.count, int, "COUNT"),
        field_filter_fn=rostopic.create_field_filter(options.nostr, options.noarr) if options.plot else None,
        value_transform_fn=None if options.plot else rostopic.create_value_transform(options.nostr, options.noarr),
        fixed_numeric_width=_number(parser, options.width, int, "NUM_WIDTH"),
    )
    if options.bag:
        _echo_bag(echo, options.bag)
    else:
        _echo_topic(echo, topic)


def _echo_topic(echo: rostopic.CallbackEcho, topic: str) -> None:
    rostopic._check_master()
    _become_a_node()
    kind, name, evaluate = rostopic.get_topic_type(topic, blocking=True)
    if kind is None or name is None:
        return
    message_class, _, _ = rostopic.get_topic_class(name)
    echo.msg_eval = evaluate
    field = topic[len(name) :].strip("/")
    details = {"topic": topic, "type_information": _field_type(kind, field) if field else None}
    rospy.Subscriber(name, message_class, echo.callback, details)
    while not rospy.is_shutdown() and not echo.done:
        rospy.rostime.wallsleep(0.1)


def _echo_bag(echo: rostopic.CallbackEcho, file: str) -> None:
    import rosbag

    if not os.path.exists(file):
        raise rostopic.ROSTopicException(f"bag file [{file}] does not exist")
    rospy.rostime.set_rostime_initialized(True)
    with rosbag.Bag(file) as bag:
        for name, message, stamp in bag.read_messages():
            echo.callback(message, {"topic": _resolve(name)}, current_time=stamp)
            if echo.done:
                break


# -- publishing ------------------------------------------------------------------------------------------------------


def _pub(args: list[str]) -> None:
    import yaml

    parser = _parser("pub /topic type [args...]")
    parser.add_option("-r", "--rate", dest="rate", default=None, help="publishing rate (hz)")
    parser.add_option("-f", "--file", dest="file", metavar="FILE", default=None, help="read args from YAML file")
    for names, name, text in (
        (["-v"], "verbose", "print verbose output"),
        (["-1", "--once"], "once", "publish one message and exit"),
        (["-l", "--latch"], "latch", "enable latching for -f, -r and piped input"),
        (["-s", "--substitute-keywords"], "substitute", "replace 'now' and 'auto' for each message"),
        (["--use-rostime"], "use_rostime", "use rostime for time stamps, else walltime is used"),
    ):
        parser.add_option(*names, dest=name, default=False, action="store_true", help=text)
    options, found = parser.parse_args(args)
    rate = _number(parser, options.rate, float, "rate")
    if rate is not None and (rate <= 0 or options.once):
        parser.error("You cannot select both -r and -1 (--once)" if options.once else "rate must be greater than zero")
    if len(found) < 2:
        parser.error("topic type must be specified" if found else "/topic must be specified")
    if len(found) > 2 and options.file:
        parser.error("args conflict with -f setting")
    topic, kind, *values = found
    rostopic._check_master()
    publisher, message_class = create_publisher(topic, kind, rate is None or options.latch, not options.use_rostime)
    if values or not message_class.__slots__:
        plain = [yaml.safe_load(value) for value in values]
        argv_publish(publisher, message_class, plain, rate, options.once, options.verbose, options.substitute)
        return
    if rate is None and not options.latch and not options.once:
        rate = 10.0
    stdin_publish(publisher, message_class, rate, options.once, options.file, options.verbose)


COMMANDS: dict[str, Callable[[list[str]], None]] = {
    "bw": _bw,
    "delay": _delay,
    "echo": _echo,
    "find": _find,
    "hz": _hz,
    "info": _info,
    "list": _list,
    "pub": _pub,
    "type": _type,
}
