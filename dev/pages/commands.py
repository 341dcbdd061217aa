"""Write docs/reference/commands.md: every command and option of `cfepy`, from its parsers.

`python -m dev.pages.commands` writes the page. A test fails if the page is out of date.
"""

from __future__ import annotations

import argparse
import re
import textwrap
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType

from cfepy.cli.main import parser_for

PAGE = Path(__file__).parents[2] / "docs" / "reference" / "commands.md"
WIDTH = 120
OWN = ("positional arguments", "options")
"""Groups of a parser that belong to one command; commands share all others."""

HEAD = """\
# Commands and options

`python -m dev.pages.commands` writes this page from the parsers of the command line. `cfepy COMMAND --help`
prints the same text.

`MISSION` is one of these:

- a startup script, or a folder with a `startup.scr`;
- the name of a mission that cfepy brings along, such as `capture`, `lab`, `pathfinder` or `sched`;
- a launch file, also as `PACKAGE FILE`;
- a node's `.py` file.

## Exit status

Most commands end with status 0 if the run ended well, 1 if there is
[a problem](../how_to/looking_at_a_run.md#what-a-problem-is), and 2 if the mission cannot boot or the command line is
wrong. Ctrl-C, SIGTERM and SIGHUP end a command with status 130. The section of a command lists its statuses if they
differ.

## Options that commands share

These options are defined once and mean the same for every command that takes them. The section of each command names
the groups that it takes.
"""
DECIDES = """\
These options, the mission and the board decide a run: the same values give the same trace. In Python,
[`cfepy.run`](../how_to/python_api.md) takes them as arguments. Every command that runs a mission reports a fault plan
that does not match the mission or never triggers, and a missing greenlet package.
"""
SHARED = {
    "what decides the run": ("What decides the run", "run"),
    "the wall clock and this computer": ("The wall clock and this computer", "run"),
    "ROS on this computer": ("ROS on this computer", "run"),
    "programs that look at the run while it goes on": ("Programs that watch the run", "run"),
    "what the run leaves behind": ("Output files", "run"),
    "the journal of the run": ("The journal of the run", "run"),
}
"""The title on the page of each shared group, and a command whose parser has it."""
MORE = {
    "--for": "`rostest` does not take it, because its tests have time limits of their own. `param` runs the mission "
    "only with `--for` or `--script`.",
    "--board": "`cfepy boards` lists the names; a file is [a profile](board_profiles.md).",
    "--tasks": "The trace does not depend on it. [Why there are two](../explanation/design.md#the-kernel).",
    "--schedule": "[How to explore schedules](../how_to/explore_schedules.md); `explore` chooses its own.",
    "--points": "[Between two calls](../how_to/explore_schedules.md#between-two-calls).",
    "--script": "[Mission scripts](../how_to/ground_tools.md#mission-scripts).",
    "--faults": "[How to inject faults](../how_to/faults.md).",
    "--stall": "It does not affect the trace. [A node that never gives up the CPU]"
    "(../how_to/run_a_ros_node.md#a-node-that-never-gives-up-the-cpu).",
    "--guard": "[Applications in C](../how_to/c_apps.md).",
    "--races": "The run itself does not change. [Races](../how_to/explore_schedules.md#races).",
    "--cpp-nodes": "[ROS nodes in C++](../how_to/convertor.md#on-cfepy).",
    "--play": "[Play a recording into a run](../how_to/bags_and_topics.md#playing-a-recording-into-a-run).",
    "--with": "[Several processors](../how_to/sbn.md).",
    "--spacecraft-id": "[Several spacecraft](../how_to/ground_tools.md#several-spacecraft).",
    "--processor-id": "[Several spacecraft](../how_to/ground_tools.md#several-spacecraft).",
    "--arg": "`launch` and `rostest` also take such words without the option.",
    "--ros-master": "[Join a mission with ROS](../how_to/ros_host.md).",
    "--foxglove": "[Watch a run live](../how_to/viewers.md).",
    "--rosbridge": "[roslibjs and roslibpy](../how_to/viewers.md#rosbridge).",
    "--record": "[Record and replay a run](../how_to/replay.md).",
    "--bag": "[Bags and topics](../how_to/bags_and_topics.md).",
}
"""Sentences with links that the help of a shared option cannot have."""
EXAMPLES = {
    "run": "cfepy run capture --for 20",
    "check": "cfepy check capture",
    "new": "cfepy new app thermal",
    "boards": "cfepy boards",
    "board": "cfepy board report capture --board rx64m --for 5",
    "launch": "cfepy launch my_package robot.launch rate:=20 --for 10",
    "node": "cfepy node my_package talker.py _rate:=20",
    "rostest": "cfepy rostest my_package talker.test",
    "topic": "cfepy topic echo capture /hand_pose -n 3",
    "service": "cfepy service call my_package robot.launch /reset --at 5",
    "param": "cfepy param get capture /arm",
    "bag": "cfepy bag info run.bag",
    "rosbag": "cfepy rosbag info run.bag",
    "rosmsg": "cfepy rosmsg show sensor_msgs/JointState",
    "rossrv": "cfepy rossrv show std_srvs/SetBool",
    "rosnode": "cfepy rosnode info capture /arm_control",
    "tf": "cfepy tf frames robot.launch",
    "explore": "cfepy explore capture --for 3 --seeds 200",
    "faults": "cfepy faults capture --seed 3",
    "sweep": "cfepy sweep capture --rate 10..1000 --board rx64m",
    "replay": "cfepy replay run.cfepy --break /joint_states",
    "diff": "cfepy diff good.cfepy bad.cfepy",
    "trace": "cfepy trace run.cfepy --perfetto run.json",
    "report": "cfepy report run.cfepy -o run.html",
    "plot": "cfepy plot capture /joint_states.position /phase -o plot.png",
    "cmd": "cfepy cmd lab CFE_ES_NOOP",
    "tlm": "cfepy tlm lab CFE_ES_HK_TLM --for 6",
    "console": "cfepy console lab",
    "mids": "cfepy mids capture",
    "graph": "cfepy graph capture --svg graph.svg",
    "export": "cfepy export xtce lab -o lab.xml",
    "convert": "cfepy convert check my_package",
    "build": "cfepy build thermal",
    "tbl": "cfepy tbl show hk_cpy_tbl.tbl --yaml hk_cpy_tbl.yaml",
    "log": "cfepy log out/ram/cfe_evs.log",
    "completion": "cfepy completion bash",
}
"""One example for each command."""
GUIDES = {
    "run": "../tutorials/first_run.md",
    "check": "mission_file.md#checking-a-mission",
    "new": "../tutorials/write_an_app.md",
    "boards": "board_profiles.md",
    "board": "board_profiles.md#does-it-fit",
    "launch": "../how_to/run_a_ros_node.md",
    "node": "../how_to/run_a_ros_node.md",
    "rostest": "../how_to/run_a_ros_node.md#cfepy-rostest",
    "topic": "../how_to/bags_and_topics.md",
    "service": "../how_to/bags_and_topics.md",
    "param": "../how_to/tables_and_parameters.md#cfepy-param",
    "bag": "../how_to/bags_and_topics.md#cfepy-bag",
    "rosbag": "../how_to/bags_and_topics.md",
    "rosmsg": "../how_to/bags_and_topics.md",
    "rossrv": "../how_to/bags_and_topics.md",
    "rosnode": "../how_to/bags_and_topics.md#nodes",
    "tf": "../how_to/bags_and_topics.md",
    "explore": "../how_to/explore_schedules.md",
    "faults": "../how_to/faults.md",
    "sweep": "../how_to/sweep.md",
    "replay": "../how_to/replay.md",
    "diff": "../how_to/replay.md",
    "trace": "../how_to/looking_at_a_run.md",
    "report": "../how_to/looking_at_a_run.md#the-page",
    "plot": "../how_to/looking_at_a_run.md#values-over-time",
    "cmd": "../how_to/ground_tools.md",
    "tlm": "../how_to/ground_tools.md",
    "console": "../how_to/ground_tools.md#console-all-of-it-at-once",
    "mids": "../how_to/ground_tools.md",
    "graph": "../how_to/ground_tools.md#the-graph",
    "export": "../how_to/ground_tools.md#export-xtce-for-other-ground-systems",
    "convert": "../how_to/convertor.md",
    "build": "../how_to/c_apps.md#building",
    "tbl": "../how_to/tables_and_parameters.md",
    "log": "../how_to/tables_and_parameters.md#files-that-cfe-writes",
    "completion": "../how_to/install.md",
}
"""The page that shows how to use each command."""


def page() -> str:
    """Return the page."""
    root = parser_for([])
    commands = _below(root)
    parts = [HEAD]
    for group, (title, command) in SHARED.items():
        parts.append(f"### {title}\n")
        if title == "What decides the run":
            parts.append(DECIDES)
        parts.append(_options(_groups(commands[command])[group], MORE))
    for title, names in root._groups.items():  # type: ignore[attr-defined]
        parts.append(f"## {title}\n")
        for name in names:
            if name in EXAMPLES:  # commands of add-ons in other packages are not on the page
                parts += _command(name, commands[name], _short_help(root, name))
    return "\n".join(parts).rstrip() + "\n"


def _command(name: str, parser: argparse.ArgumentParser, short: str) -> Iterator[str]:
    yield f"### `cfepy {name}`\n"
    yield _filled(parser.description or f"{short[0].upper()}{short[1:]}.")
    if not _below(parser):
        yield f"Usage: {_usage(parser)}.\n"
    yield f"Example: `{EXAMPLES[name]}`. Guide: [{Path(GUIDES[name].partition('#')[0]).stem}]({GUIDES[name]}).\n"
    actions = _below(parser)
    if actions:
        yield _table(
            ("action", "purpose"),
            [(_usage(below), f"{_short_help(parser, each)}{_own_options(below)}") for each, below in actions.items()],
        )
        shared = sorted({title for below in actions.values() for title in _shared(below)})
    else:
        groups = _groups(parser)
        listed = [action for title in OWN for action in groups.get(title, ()) if _is_shown(action)]
        if listed:
            yield _options(listed)
        shared = _shared(parser)
    if shared:
        links = [f"[{title.lower().replace('ros', 'ROS')}](#{title.lower().replace(' ', '-')})" for title in shared]
        yield _filled(f"It also takes the options of {_listed(links)}.")
    if parser.epilog and "exit status" in parser.epilog:
        text = parser.epilog.strip()
        yield f"```text\n{text}\n```\n" if "\n" in text else _filled(f"{text[0].upper()}{text[1:]}.")


def _below(parser: argparse.ArgumentParser) -> dict[str, argparse.ArgumentParser]:
    """Return the parsers of the commands below this one, by name."""
    found = [action for action in parser._actions if isinstance(action, argparse._SubParsersAction)]
    return {name: below for action in found for name, below in action.choices.items()}


def _short_help(parser: argparse.ArgumentParser, name: str) -> str:
    """Return the line that the help of a parser has for a command below it."""
    found = next(action for action in parser._actions if isinstance(action, argparse._SubParsersAction))
    return next((each.help or "" for each in found._choices_actions if each.dest == name), "")


def _groups(parser: argparse.ArgumentParser) -> dict[str, list[argparse.Action]]:
    return {group.title or "": group._group_actions for group in parser._action_groups if group._group_actions}


def _shared(parser: argparse.ArgumentParser) -> list[str]:
    """Return the titles of the shared groups of a parser."""
    return [SHARED[title][0] for title in _groups(parser) if title in SHARED]


def _is_shown(action: argparse.Action) -> bool:
    return action.help is not argparse.SUPPRESS and "--help" not in action.option_strings


def _own_options(parser: argparse.ArgumentParser) -> str:
    """Return the options of an action of a command as text for a cell of a table."""
    options = [each for each in _groups(parser).get("options", ()) if _is_shown(each)]
    return "".join(f"; {_words(each)}: {_help(each)}" for each in options)


def _options(actions: Sequence[argparse.Action], more: Mapping[str, str] = MappingProxyType({})) -> str:
    """Return a table of options and arguments, with more sentences about some."""
    rows = []
    for action in actions:
        if not _is_shown(action):
            continue
        sentence = next((more[each] for each in action.option_strings if each in more), "")
        text = _help(action)
        rows.append((_words(action), f"{text}. {sentence}" if sentence else text))
    return _table(("option", "meaning"), rows)


def _words(action: argparse.Action) -> str:
    """Return an option with its value, or an argument, as code."""
    metavar = action.metavar or (
        "{" + ",".join(map(str, action.choices)) + "}" if action.choices else action.dest.upper()
    )
    value = " ".join(metavar) if isinstance(metavar, tuple) else metavar
    if not action.option_strings:
        return f"`{value}`"
    if action.nargs == 0:
        return ", ".join(f"`{each}`" for each in action.option_strings)
    value = {"?": f"[{value}]", "+": f"{value} ...", "*": f"[{value} ...]"}.get(str(action.nargs), value)
    return ", ".join(f"`{each} {value}`" for each in action.option_strings)


def _help(action: argparse.Action) -> str:
    values = {**vars(action), "prog": "cfepy"}
    return ((action.help or "") % values).strip()


def _usage(parser: argparse.ArgumentParser) -> str:
    """Return the words of a command, without its options, as code."""
    words = []
    for action in parser._actions:
        if action.option_strings or isinstance(action, argparse._SubParsersAction):
            continue
        value = action.dest.upper() if action.choices and not action.metavar else _words(action).strip("`")
        words.append({"?": f"[{value}]", "*": f"[{value} ...]", "+": f"{value} ..."}.get(str(action.nargs), value))
    has_options = any(_is_shown(each) for each in parser._actions if each.option_strings)
    return f"`{' '.join([parser.prog, *(['[OPTION ...]'] if has_options else []), *words])}`"


def _table(head: tuple[str, str], rows: Sequence[tuple[str, str]]) -> str:
    lines = [head, ("---", "---"), *rows]
    return (
        "\n".join(
            f"| {' | '.join(' '.join(cell.split()).replace('|', chr(92) + '|') for cell in row)} |" for row in lines
        )
        + "\n"
    )


def _filled(text: str) -> str:
    text = re.sub(r"(<\w+>)", r"`\1`", " ".join(text.split()))
    return textwrap.fill(text, WIDTH, break_on_hyphens=False, break_long_words=False) + "\n"


def _listed(words: Sequence[str]) -> str:
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"


def main() -> None:
    """Write the page."""
    argparse.ArgumentParser(prog="python -m dev.pages.commands", description=__doc__).parse_args()
    PAGE.write_text(page(), encoding="utf-8")
    print(f"wrote {PAGE.relative_to(Path(__file__).parents[2])}")


if __name__ == "__main__":
    main()
