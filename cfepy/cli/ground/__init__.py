"""The commands of a ground system: cmd, tlm, console, graph, export; their options are defined here.

A command belongs here if it works with cFE's packets by their names, over the network or with a mission that it flies.
"""

from __future__ import annotations

import argparse

from cfepy.cli import flight_add_ons
from cfepy.cli.csv_cells import add_quote_formulas
from cfepy.cli.flight_options import add_pace, add_recording
from cfepy.cli.options import (
    LOOK_STATUS,
    MISSION_HELP,
    VALUES_HELP,
    add_count,
    add_drawing,
    add_from,
    add_json,
    add_looked_at,
    add_mission,
    add_output,
    add_raw,
    add_run_options,
    seconds_of,
)

DICTIONARY_HELP = "take names from this mission (default: the services and the apps that cfepy brings along)"


def add(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add these commands to the parser of `cfepy`."""
    _add_cmd(commands)
    _add_tlm(commands)
    _add_console(commands)
    _add_graph(commands)
    _add_export(commands)


def _add_cmd(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    cmd = commands.add_parser(
        "cmd",
        help="send a command by name, or list the commands",
        description="Send a command to a flight computer, or to a mission, which the command runs in virtual time.",
        examples=("cfepy cmd lab CFE_ES_NOOP", "cfepy cmd 127.0.0.1 CFE_EVS_ENABLE_APP_EVENTS AppName=HK"),
        epilog="exit status: 0 well, 1 an ERROR or CRITICAL event followed, an application died, or no application "
        "received the command; 2 bad usage",
    )
    add_mission(
        cmd,
        "target",
        nargs="?",
        metavar="MISSION|HOST[:PORT]",
        help="a mission, live: (a running flight), or where CI_LAB listens: 127.0.0.1, or any name with a port "
        "(default: 1234)",
    )
    cmd.add_argument("name", nargs="?", metavar="NAME", help="such as CFE_ES_NOOP")
    cmd.add_argument("fields", nargs="*", metavar="FIELD=VALUE", help="others are zero")
    add_mission(cmd, "--mission", help=DICTIONARY_HELP)
    cmd.add_argument("--list", nargs="?", const="*", metavar="PATTERN", help="list the commands, such as '*_NOOP'")
    cmd.add_argument("--show", metavar="NAME", help="show a command's fields")
    cmd.add_argument("--hex", action="store_true", help="print the command's bytes instead of sending them")
    cmd.add_argument(
        "--for",
        dest="seconds",
        type=seconds_of,
        metavar="SECONDS",
        help="virtual seconds to wait for its effects (default: 2)",
    )
    add_run_options(cmd, without=["seconds"])
    cmd.set_defaults(module="cfepy.cli.ground.cmd")


def _add_tlm(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    tlm = commands.add_parser(
        "tlm",
        help="show telemetry by name",
        description="Show telemetry that arrives over UDP, or telemetry of a mission, which the command runs in "
        "virtual time.",
        examples=("cfepy tlm lab 'CFE_*_HK_TLM' --for 6", "cfepy tlm --enable 127.0.0.1 --json -"),
        epilog="exit status: 0 well, 1 no packet arrived, 2 bad usage, 130 ended by Ctrl-C",
    )
    add_mission(
        tlm,
        "words",
        nargs="*",
        metavar="WORD",
        help="first a mission, live: (a running flight), or this computer's address to listen at, HOST[:PORT] "
        "(default: any, port 1235); then "
        "the packets by their names, patterns such as 'CFE_*', or MsgIds (default: all)",
    )
    add_mission(tlm, "--mission", help=DICTIONARY_HELP)
    tlm.add_argument(
        "--enable",
        nargs="?",
        const="",
        metavar="HOST[:PORT]",
        help="ask TO_LAB there to begin to send (default: 127.0.0.1:1234)",
    )
    add_count(tlm, "packets")
    tlm.add_argument(
        "--for",
        dest="seconds",
        type=seconds_of,
        metavar="SECONDS",
        help="end after so many seconds (default: a mission flies for 10, else until Ctrl-C)",
    )
    add_raw(tlm)
    add_json(tlm, "an object for each packet, a line each,")
    add_run_options(tlm, without=["seconds"])
    tlm.set_defaults(module="cfepy.cli.ground.tlm")


def _add_console(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    console = commands.add_parser(
        "console",
        help="a ground console: commands, telemetry pages, events",
        description="Command a mission while it runs, or a flight computer over UDP. Lines are commands by name, steps "
        "of a mission script, or words of the console; the word help lists them. Without a terminal, the console reads "
        "lines from standard input.",
        examples=("cfepy console lab", "cfepy console --udp 192.168.1.20 --mission lab --enable"),
        epilog="exit status: 0 well, 1 a step or a line failed, or an application died; 2 bad usage; 130 ended by "
        "Ctrl-C, SIGTERM or SIGHUP",
    )
    add_mission(console, nargs="?", help=f"live:, the running flight of another terminal; or {MISSION_HELP}")
    console.add_argument("--udp", metavar="HOST[:PORT]", help="a flight computer: where CI_LAB listens (port: 1234)")
    console.add_argument("--listen", metavar="HOST[:PORT]", help="where telemetry arrives (default: any, port 1235)")
    console.add_argument(
        "--enable",
        nargs="?",
        const="",
        metavar="HOST[:PORT]",
        help="ask TO_LAB there to begin to send (default: where commands go)",
    )
    add_mission(console, "--mission", dest="names", help=f"with --udp, {DICTIONARY_HELP}")
    console.add_argument(
        "--save-script",
        metavar="FILE",
        help="write the commands and their times as a script; `cfepy run MISSION --script FILE` repeats the run",
    )
    console.add_argument("--plain", action="store_true", help="lines of text, on a terminal too")
    add_run_options(console)
    add_recording(console)
    add_pace(console)
    flight_add_ons.add_options(console)
    console.set_defaults(module="cfepy.cli.ground.console")


def _add_graph(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    graph = commands.add_parser(
        "graph",
        help="show senders, messages and pipes, or the table of MsgIds",
        description="Run a mission quietly for 10 virtual seconds, and show its graph: applications and nodes, the "
        "messages between them with MsgIds, the pipes with depths and limits, services and actions.",
        examples=("cfepy graph capture --svg graph.svg", "cfepy graph capture --mids"),
    )
    add_mission(graph)
    add_run_options(graph)
    graph.add_argument(
        "--all",
        dest="everything",
        action="store_true",
        help="include each of cFE's services, their messages to each other, and the topics that nodes log to",
    )
    graph.add_argument("--mids", action="store_true", help="show the table of MsgIds, with senders and subscribers")
    graph.add_argument(
        "--lock",
        action="store_true",
        help="write topics.lock in the mission's folder, which gives every ROS topic and service a fixed MsgId; ids "
        "that the file already has stay",
    )
    add_json(graph, "the graph, or with --mids the table,")
    add_drawing(graph, "svg", "draw the graph")
    add_drawing(graph, "dot", "write the graph for graphviz")
    graph.set_defaults(module="cfepy.cli.ground.graph")


def _add_export(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    export = commands.add_parser(
        "export",
        help="write values as CSV or Parquet, or packets as XTCE",
        description="Write files for other programs: values over time, or the definitions of a mission's packets.",
        examples=("cfepy export csv run.bag /odom.pose.pose.position -o odom.csv", "cfepy export xtce lab -o lab.xml"),
    )
    export.set_defaults(module="cfepy.cli.ground.export")
    formats = export.add_subparsers(metavar="FORMAT", dest="format", required=True)
    _add_values(formats, "csv", "values over time as comma-separated values", "-")
    _add_values(formats, "parquet", "values over time as Apache Parquet", "values.parquet")
    xtce = formats.add_parser(
        "xtce",
        help="commands and telemetry of a mission in XTCE 1.2, which ground systems read",
        description="Describe a mission's packets in XTCE 1.2, an XML format which ground systems read.",
        examples=("cfepy export xtce lab -o lab.xml",),
    )
    add_mission(xtce)
    add_output(xtce, "standard output", "-")
    cosmos = formats.add_parser(
        "cosmos",
        help="commands and telemetry of a mission as text for COSMOS and OpenC3",
        description="Write a mission's packets as command and telemetry text, a file for the folder `cmd_tlm` of a "
        "target of COSMOS or OpenC3. With a folder as output, NAME/, write a whole plugin.",
        examples=("cfepy export cosmos lab -o lab.txt", "cfepy export cosmos lab --script checks.txt -o plugin/"),
    )
    add_mission(cosmos)
    text = "translate this mission script to a procedure of the plugin"
    cosmos.add_argument("--script", metavar="FILE", help=text)
    add_output(cosmos, "standard output", "-")
    ctf = formats.add_parser(
        "ctf",
        help="commands and telemetry of a mission as JSON for NASA's cFS Test Framework (CTF)",
        description="Write a mission's packets as JSON files for NASA's cFS Test Framework (CTF), one for each MsgId.",
        examples=("cfepy export ctf lab -o ccdd",),
    )
    add_mission(ctf)
    add_output(ctf, "a folder", "ccdd")
    python = formats.add_parser(
        "python",
        help="commands and telemetry of a mission as a Python module",
        description="Write a module with the layouts, commands and telemetry of a mission, for your programs, or as "
        "the ground names of an application.",
        examples=("cfepy export python lab -o lab_packets.py",),
    )
    add_mission(python)
    add_output(python, "standard output", "-")
    ros = formats.add_parser(
        "ros",
        help="telemetry of a mission as ROS messages: a catkin package, for programs beside `--ros-master`",
        description="Write a catkin package of the message types that a mission's telemetry has in ROS (`ros_bridge:` "
        "of its mission file), so that rostopic echo and your own nodes know them by name.",
        examples=("cfepy export ros capture -o catkin_ws/src/cfe_tlm",),
    )
    add_mission(ros)
    add_output(ros, "a folder", "cfe_tlm")


def _add_values(formats: argparse._SubParsersAction[argparse.ArgumentParser], name: str, text: str, usual: str) -> None:
    values = formats.add_parser(
        name,
        help=text,
        description=f"Write {text}: a row for each message, with its virtual time and its time on board in s, and a "
        "column for each field.",
        examples=(f"cfepy export {name} capture /joint_states CFE_ES_HK_TLM -o values.{name}",),
        epilog=LOOK_STATUS,
    )
    add_looked_at(values, with_bags=True)
    values.add_argument("names", metavar="NAME", nargs="+", help=VALUES_HELP)
    add_from(values)
    add_output(values, f"{usual}; into a folder a file for each topic or packet", usual)
    if name == "csv":
        add_quote_formulas(values)
