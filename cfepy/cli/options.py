"""Options that commands share. `RUN_OPTIONS` has one for each attribute of a `RunPlan`, so every command that flies a
mission understands all of them; `plan_of` makes the plan from the command line. This module imports argparse only.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from cfepy.cli.parser import MissionAction, hand_options_to_nodes, shared_group
from cfepy.status import UsageError

if TYPE_CHECKING:
    from cfepy.pilot import RunPlan

Options = argparse._ActionsContainer  # a parser, or a group of its options
NODE_SUFFIX = ".py"
LONGEST_S = 1e9  # virtual time is a signed 64-bit number of ns
SLOWEST, FASTEST = 1e-3, 1e9  # times real time
DEFAULT_SEED, DEFAULT_TASKS, DEFAULT_SCHEDULE, DEFAULT_STALL_S = 0, "auto", "fifo", 10.0
TASK_KINDS = (DEFAULT_TASKS, "thread", "greenlet")

MISSION_HELP = "a startup script or its folder, a shipped mission, a launch file (or PACKAGE FILE), or a node's .py"
FOR_HELP = "virtual seconds to run (default: 10, or as long as the script takes; until Ctrl-C with --realtime)"
STATUS_HELP = """exit status:
  0    the run ended well
  1    an application died or could not be started, a mission's own application sent an ERROR or CRITICAL event,
       or a failure reset the processor; with --script, a step of the script failed and nothing else counts;
       with --check-determinism, two runs differed, and nothing else counts
  2    bad usage, or a mission that cannot boot
  130  ended by Ctrl-C, SIGTERM or SIGHUP (the report is still printed)"""

# -- the inputs of a run -----------------------------------------------------------------------------------------------


def _add_launch_args(parser: Options) -> None:
    parser.add_argument(
        "--arg",
        dest="launch_args",
        action="append",
        type=launch_argument_of,
        default=[],
        metavar="NAME:=VALUE",
        help="set an argument of the launch file",
    )


def _add_seconds(parser: Options) -> None:
    parser.add_argument("--for", dest="seconds", type=seconds_of, metavar="SECONDS", help=FOR_HELP)


def _add_seed(parser: Options) -> None:
    text = f"seed of all random values in the mission (default: {DEFAULT_SEED})"
    parser.add_argument("--seed", type=whole_number_of, default=DEFAULT_SEED, metavar="N", help=text)


def _add_board(parser: Options) -> None:
    parser.add_argument("--board", metavar="NAME|FILE", help="run on this board instead of the mission's own")


def _add_tasks(parser: Options) -> None:
    text = "kind of tasks (default: auto, which means greenlet if it is installed, else thread); the trace is the same"
    parser.add_argument("--tasks", choices=TASK_KINDS, default=DEFAULT_TASKS, help=text)


def _add_schedule(parser: Options) -> None:
    parser.add_argument(
        "--schedule",
        default=DEFAULT_SCHEDULE,
        metavar="TEXT",
        help="order of tasks where several could run: fifo (default), random[:SEED], pct:SEED:DEPTH[:STEPS], "
        "abreast[:SEED] or at:42=1 (at decision 42 candidate 1); add :any to ignore priorities, :hold=500us to delay "
        "tasks, :connect=50ms to delay connections of nodes",
    )
    parser.add_argument(
        "--points",
        metavar="KIND",
        help="let this schedule preempt Python code at lines, attributes or calls[:MODULE,...], or shared:NAME,..., "
        "not only at its calls of cFE and ROS",
    )


def _add_script(parser: Options) -> None:
    parser.add_argument("--script", metavar="FILE", help="send commands and check their effects, by a mission script")


def _add_stop_on_failure(parser: Options) -> None:
    parser.add_argument(
        "--stop-on-failure", action="store_true", help="end the run with the script's first failed step"
    )


def _add_faults(parser: Options) -> None:
    parser.add_argument(
        "--faults",
        metavar="FILE|seed:N",
        help="inject the faults of a plan, or random ones (seed:N, seed:N:low, :medium, :high); `cfepy new faults` "
        "writes a plan",
    )


def _add_play(parser: Options) -> None:
    text = "play the topics of a bag or an MCAP file into the mission, as rosbag play does"
    parser.add_argument("--play", metavar="BAG", help=text)


def _add_play_options(parser: Options) -> None:
    parser.add_argument(
        "--play-options",
        metavar="TEXT",
        help="options and remappings of rosbag play, such as --play-options='--rate 2 --start 5 --topics /a /a:=/b'",
    )


def _add_stall(parser: Options) -> None:
    parser.add_argument(
        "--stall",
        type=stall_of,
        default=DEFAULT_STALL_S,
        metavar="SECONDS",
        help="fail if a task computes for so many seconds of CPU time without giving up the CPU "
        f"(default: {DEFAULT_STALL_S:g}; 0: never)",
    )


def _add_guard(parser: Options) -> None:
    parser.add_argument(
        "--guard",
        action="store_true",
        help="report writes of compiled applications past a buffer, uses of freed buffers, and resources that "
        "applications do not give back",
    )


def _add_cpp_nodes(parser: Options) -> None:
    parser.add_argument(
        "--cpp-nodes",
        metavar="PROFILE|MISSION",
        help="build nodes in C++ for a profile (host, pool, strict), or by the section cpp_nodes of a mission file",
    )


def _add_races(parser: Options) -> None:
    parser.add_argument(
        "--races",
        action="store_true",
        help="report unordered accesses of Python code to one attribute, item or variable, one of them a write",
    )


def _add_settings(parser: Options) -> None:
    parser.add_argument(
        "--set",
        dest="settings",
        action="append",
        type=setting_of,
        default=[],
        metavar="/PARAM=VALUE",
        help="set a ROS parameter, such as /arm/rate, in place of the mission's value (in YAML)",
    )


def _add_spacecraft_id(parser: Options) -> None:
    parser.add_argument(
        "--spacecraft-id",
        type=whole_number_of,
        metavar="N",
        help="number of the spacecraft, as --scid of NASA's executable (default: the mission's, or 66)",
    )


def _add_processor_id(parser: Options) -> None:
    parser.add_argument(
        "--processor-id",
        type=whole_number_of,
        metavar="N",
        help="number of the processor, as --cpuid of NASA's executable; CI_LAB listens at UDP port 1233 + N (default: "
        "the mission's, or 1)",
    )


def _add_beside(parser: Options) -> None:
    text = "run another processor in the same virtual time and network, from that second on"
    metavar = "MISSION[@SECONDS]"
    parser.add_argument("--with", dest="beside", action="append", default=[], metavar=metavar, help=text)


RUN_OPTIONS: Mapping[str, Callable[[Options], None]] = {
    "launch_args": _add_launch_args,
    "seconds": _add_seconds,
    "seed": _add_seed,
    "board": _add_board,
    "tasks": _add_tasks,
    "schedule": _add_schedule,
    "script": _add_script,
    "stop_on_failure": _add_stop_on_failure,
    "faults": _add_faults,
    "play": _add_play,
    "play_options": _add_play_options,
    "stall": _add_stall,
    "guard": _add_guard,
    "races": _add_races,
    "cpp_nodes": _add_cpp_nodes,
    "settings": _add_settings,
    "spacecraft_id": _add_spacecraft_id,
    "processor_id": _add_processor_id,
    "beside": _add_beside,
}
"""Functions that add the option for each attribute of `RunPlan`, except the words and the command."""


def add_run_options(parser: argparse.ArgumentParser, without: Sequence[str] = ()) -> None:
    """Add the options that decide a run.

    Args:
        parser: parser of the command.
        without: attributes of `RunPlan` that the command sets in another way.
    """
    group = shared_group(parser, "flight")
    for name, add in RUN_OPTIONS.items():
        if name not in without:
            add(group)


def plan_of(arguments: argparse.Namespace, words: Sequence[str], command: str | None = None) -> RunPlan:
    """Make the run plan of a command line.

    Args:
        arguments: the command line; attributes without an option keep their defaults.
        words: the words after the command; for a launch, `launch_words`.
        command: as for `RunPlan`. None means a mission or a node, whichever the words begin with.

    Raises:
        UsageError: the schedule is invalid, or the settings for nodes in C++ do not exist.
    """
    from cfepy.mission import cpp_nodes_source, is_node
    from cfepy.pilot import LAUNCH, NODE, RUN, RunPlan
    from cfepy.schedules import Points, Schedule

    said = {name: getattr(arguments, name) for name in RUN_OPTIONS if hasattr(arguments, name)}
    if "schedule" in said:
        points = Points.parse(getattr(arguments, "points", None) or "").text()
        schedule = Schedule.parse(said["schedule"], said.get("seed", DEFAULT_SEED))
        said["schedule"] = schedule.with_points(points) if points else schedule
    if "launch_args" in said:
        said["launch_args"] = () if command == LAUNCH else tuple(said["launch_args"])
    for name in said.keys() & {"settings", "beside"}:
        said[name] = tuple(said[name])
    if said.get("cpp_nodes") is not None:
        said["cpp_nodes"] = cpp_nodes_source(said["cpp_nodes"])
    if command is None:
        command = NODE if is_node(words[0]) else RUN
    return RunPlan(tuple(words), command, **said)


def plan_of_mission(arguments: argparse.Namespace) -> RunPlan:
    """Make the run plan of a command with `add_mission_or_node`.

    Raises:
        UsageError: as for `plan_of`, or there are words after a mission that is not a node's .py.
    """
    from cfepy.pilot import NODE

    plan = plan_of(arguments, [arguments.mission, *arguments.node_args])
    if len(plan.words) > 1 and plan.command != NODE:
        raise UsageError(f"unexpected {plan.words[1]!r}; expected one mission", field="MISSION")
    return plan


def launch_words(arguments: argparse.Namespace) -> list[str]:
    """Return the words of a command that takes a launch file and its arguments as roslaunch does, or with `--arg`."""
    return [*arguments.words, *(f"{name}:={value}" for name, value in arguments.launch_args)]


def refuse_run_options(arguments: argparse.Namespace, why: str, but: Sequence[str] = ()) -> None:
    """Reject the options of a run for a target that is not a mission to be flown.

    Args:
        arguments: the command line.
        why: the reason, as the end of a sentence that begins with the option.
        but: attributes of `RunPlan` that are permitted.

    Raises:
        UsageError: such an option is given.
    """
    for name, (option, usual) in _USUAL.items():
        if name not in but and getattr(arguments, name, usual) not in (usual, [], ""):
            raise UsageError(why, field=option)


_USUAL: Mapping[str, tuple[str, object]] = {
    "launch_args": ("--arg", None),
    "seconds": ("--for", None),
    "seed": ("--seed", DEFAULT_SEED),
    "board": ("--board", None),
    "tasks": ("--tasks", DEFAULT_TASKS),
    "schedule": ("--schedule", DEFAULT_SCHEDULE),
    "points": ("--points", None),
    "script": ("--script", None),
    "stop_on_failure": ("--stop-on-failure", False),
    "faults": ("--faults", None),
    "play": ("--play", None),
    "play_options": ("--play-options", None),
    "stall": ("--stall", DEFAULT_STALL_S),
    "guard": ("--guard", False),
    "races": ("--races", False),
    "cpp_nodes": ("--cpp-nodes", None),
    "settings": ("--set", None),
    "spacecraft_id": ("--spacecraft-id", None),
    "processor_id": ("--processor-id", None),
    "beside": ("--with", None),
}
"""The option for each attribute, and its default value."""


def add_mission(parser: argparse.ArgumentParser, name: str = "mission", **said: Any) -> None:
    """Add the argument for the mission.

    Args:
        parser: parser of the command.
        name: name of the argument.
        said: settings that override the defaults, as for `ArgumentParser.add_argument`.
    """
    parser.add_argument(name, action=MissionAction, **{"metavar": "MISSION", "help": MISSION_HELP, **said})


def add_mission_or_node(parser: argparse.ArgumentParser, **said: Any) -> None:
    """Add the argument for a mission, or for a node's .py with its own arguments, as `plan_of_mission` reads them.

    Args:
        parser: parser of the command.
        said: see `add_mission`.
    """
    add_mission(parser, **said)
    parser.add_argument("node_args", metavar="ARG", nargs="*", help="arguments of a node's .py")
    hand_options_to_nodes(parser, lambda word: word.endswith(NODE_SUFFIX))


LOOKED_AT_HELP = f"a journal that `cfepy run --record FILE` wrote, or {MISSION_HELP}"
VALUES_HELP = (
    "a topic or packet, with or without a field: /joint_states.position[0], /odom/pose/pose/position/x, "
    "CFE_ES_HK_TLM.CommandCounter, '/arm/*'"
)
LOOK_STATUS = """exit status:
  0    it was written
  1    it was written, but the replay was not the run of the journal
  2    bad usage, or a mission that cannot boot
  130  ended by Ctrl-C"""


def add_looked_at(parser: argparse.ArgumentParser, with_bags: bool = False) -> None:
    """Add the argument for the run that a command shows, and the options that decide it."""
    what, metavar = ("a bag, " if with_bags else ""), ("RUN" if with_bags else "FILE|MISSION")
    add_mission(parser, "source", metavar=metavar, help=what + LOOKED_AT_HELP)
    add_run_options(parser)
    add_until(parser, "the run, or the replay of the journal,")
    add_from_disk(parser)


def add_from_disk(parser: argparse.ArgumentParser) -> None:
    """Add the option that selects the files of a journal's mission."""
    parser.add_argument(
        "--from-disk",
        action="store_true",
        help="use the mission's files on this computer, not those in the journal",
    )


# -- files, begin and end ----------------------------------------------------------------------------------------------


def add_action(
    actions: argparse._SubParsersAction[argparse.ArgumentParser], name: str, text: str, example: str, status: str
) -> argparse.ArgumentParser:
    """Add an action of a command, such as `list` of `cfepy rostopic`, whose help is also its description.

    Args:
        actions: the actions of the command.
        name: name of the action.
        text: its help, without a capital letter and a full stop.
        example: a command line without `cfepy`.
        status: its exit statuses.

    Returns:
        The parser of the action.
    """
    description = f"{text[0].upper()}{text[1:]}."
    return actions.add_parser(name, help=text, description=description, examples=(f"cfepy {example}",), epilog=status)


def add_json(parser: Options, what: str) -> None:
    """Add the option for a command's findings in JSON; see `cfepy.cli.json_output`.

    Args:
        parser: parser of the command.
        what: the data that is written, for the help.
    """
    text = f"write {what} as JSON; - writes to standard output"
    parser.add_argument("--json", metavar="FILE|-", help=text)


NO_CI_OUTPUTS = {"junit": None, "sarif": None, "github": False}


def add_ci_outputs(parser: Options) -> None:
    """Add the options for continuous integration; see `cfepy.cli.ci_outputs`."""
    text = "write the results as JUnit XML, for GitLab, Jenkins and others; - writes to standard output"
    parser.add_argument("--junit", metavar="FILE|-", help=text)
    text = "write the findings as SARIF 2.1.0, for code hosts and editors; - writes to standard output"
    parser.add_argument("--sarif", metavar="FILE|-", help=text)
    parser.add_argument("--github", action="store_true", help="print the findings as annotations of GitHub, too")


def add_output(parser: argparse.ArgumentParser, text: str, default: str | None = None) -> None:
    """Add the option for the file or folder that a command makes.

    Args:
        parser: parser of the command.
        text: the default, for the help.
        default: the default value.
    """
    parser.add_argument("-o", "--output", metavar="PATH", default=default, help=f"where to write (default: {text})")


def add_cfe(parser: argparse.ArgumentParser) -> None:
    """Add the option for the release of cFE that sources in C are written for."""
    text = "the sources are for cFE 6.5, 6.7 or 6.8 (default: 7)"
    parser.add_argument("--cfe", metavar="RELEASE", help=text)


def add_drawing(parser: argparse.ArgumentParser, kind: str, text: str) -> None:
    """Add the option for a drawing, or for the input of a drawing program.

    Args:
        parser: parser of the command.
        kind: file name extension, which is also the name of the option.
        text: the effect, for the help.
    """
    parser.add_argument(f"--{kind}", metavar="FILE|-", help=f"{text} to a file, or with - to standard output")


def add_raw(parser: argparse.ArgumentParser) -> None:
    """Add the option that shows measurements of packets as raw numbers."""
    parser.add_argument("--raw", action="store_true", help="raw numbers instead of values with units and limits")


def add_count(parser: argparse.ArgumentParser, what: str) -> None:
    """Add the option for the number of messages or packets after which a command ends."""
    parser.add_argument("-n", "--count", type=count_of, metavar="N", help=f"end after so many {what}")


def add_until(parser: argparse.ArgumentParser, text: str) -> None:
    """Add the option for the virtual time of the end.

    Args:
        parser: parser of the command.
        text: the subject of the help text, such as "the run".
    """
    parser.add_argument("--until", type=seconds_of, metavar="SECONDS", help=f"{text} ends at this virtual time")


def add_perfetto(parser: argparse.ArgumentParser) -> None:
    """Add the option for a file for Perfetto instead of a text."""
    text = "write a trace in the Trace Event Format, which ui.perfetto.dev opens, to this file"
    parser.add_argument("--perfetto", metavar="FILE", help=text)


def add_from(parser: argparse.ArgumentParser) -> None:
    """Add the option for the virtual time at which the output begins."""
    parser.add_argument("--from", dest="from_s", type=seconds_of, metavar="SECONDS", help="begin at this virtual time")


# -- types of arguments ------------------------------------------------------------------------------------------------


def seconds_of(text: str) -> float:
    """Parse a time in s, for argparse: a number of seconds, or one with a unit, such as 600ms or 500us."""
    number, per_s = next(((text.removesuffix(unit), per_s) for unit, per_s in _UNITS if text.endswith(unit)), (text, 1))
    try:
        seconds = float(number) / per_s
    except ValueError:
        seconds = 0.0
    if not 0 < seconds <= LONGEST_S:
        text = f"invalid number of seconds {text!r}; expected more than 0 to {LONGEST_S:g}, or a time such as 600ms"
        raise argparse.ArgumentTypeError(text)
    return seconds


_UNITS = (("ns", 1_000_000_000), ("us", 1_000_000), ("ms", 1_000), ("s", 1))


def stall_of(text: str) -> float:
    """Parse a time in s or 0, for argparse."""
    return 0.0 if text in ("0", "0.0") else seconds_of(text)


def count_of(text: str) -> int:
    """Parse a count of at least one, for argparse."""
    if not text.isdecimal() or int(text) == 0:
        raise argparse.ArgumentTypeError(f"invalid count {text!r}; expected 1 or more")
    return int(text)


def launch_argument_of(text: str) -> tuple[str, str]:
    """Parse an argument of a launch file and its value, for argparse."""
    name, mark, value = text.partition(":=")
    if not mark or not name:
        raise argparse.ArgumentTypeError(f"invalid launch argument {text!r}; expected NAME:=VALUE, such as rate:=20")
    return name, value


def setting_of(text: str) -> tuple[str, str]:
    """Parse a parameter and its value, for argparse."""
    name, mark, value = text.partition("=")
    if not mark or not name.startswith("/"):
        raise argparse.ArgumentTypeError(
            f"invalid parameter setting {text!r}; expected /NAME=VALUE, such as /arm/rate=20"
        )
    return name, value


def whole_number_of(text: str) -> int:
    """Parse a whole number, for argparse."""
    try:
        return int(text, 0)
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"invalid number {text!r}; expected a whole number such as 67 or 0x43"
        ) from None


def factor_of(text: str) -> float:
    """Parse a speed as a multiple of the wall clock, for argparse."""
    try:
        factor = float(text)
    except ValueError:
        factor = 0.0
    if not SLOWEST <= factor <= FASTEST:
        raise argparse.ArgumentTypeError(f"invalid factor {text!r}; expected {SLOWEST:g} to {FASTEST:g}")
    return factor
