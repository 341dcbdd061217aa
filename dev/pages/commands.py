"""Write docs/reference/commands.md: every command and option of `cfepy`, from its parsers.

`python -m dev.pages.commands` writes the page. A test fails if the page is out of date.
"""

from __future__ import annotations

import argparse
import re
import textwrap
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from cfepy.cli.main import ALIASES, parser_for
from cfepy.cli.parser import CommandParser, parsers_below

PAGE = Path(__file__).parents[2] / "docs" / "reference" / "commands.md"
WIDTH = 120
HEAD = """\
# Commands and options

`python -m dev.pages.commands` writes this page from the parsers of the command line. `cfepy COMMAND --help`
prints the same text, and `cfepy help flying` the options that commands share.

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
    "flight": "Flight options",
    "real time": "Real time",
    "ROS on this computer": "ROS on this computer",
    "viewers": "Viewers",
    "output": "Output",
    "continuous integration": "Continuous integration",
    "profile": "Profile",
    "journal": "Journal",
    "failures": "Failures of a search",
    "processes": "Processes",
}
"""The title on the page of each group that commands share."""
MORE = {
    "--for": "`rostest` does not take it, because its tests have time limits of their own. `rosparam` runs the mission "
    "only with `--for` or `--script`.",
    "--board": "`cfepy board list` lists the names; a file is [a profile](board_profiles.md).",
    "--tasks": "The trace does not depend on it. [Why there are two](../explanation/design.md#the-kernel).",
    "--schedule": "[How to explore schedules](../how_to/explore_schedules.md); `explore` chooses its own.",
    "--profile": "[Where wall time goes](../how_to/looking_at_a_run.md#where-wall-time-goes).",
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
OF_EXPLORE = {
    "--seeds": "`auto`: until schedules bring nothing new. With `--budget` and without `--seeds` the number is not "
    "limited.",
    "--policy": "`random` chooses at each decision, `pct` preempts at a few places, `abreast` runs tasks side by side, "
    "and `all` takes these in turn. `dfs` runs every schedule with few preemptions, `orders` every order of dependent "
    "steps once.",
    "--depth": "For `pct` the depth of bugs, for `dfs` the most preemptions, for `orders` the most steps that differ.",
    "--hold": "The running task may wait until the next timer, if that is due within this time.",
    "--profile": "[Where wall time goes](../how_to/looking_at_a_run.md#where-wall-time-goes).",
    "--points": "[Between two calls](../how_to/explore_schedules.md#between-two-calls).",
    "--worst": "Also `latency:/cause->/effect` and `age:/topic`.",
    "--livelock": "Such an application neither sends nor receives a message although its tasks run.",
    "--results": "The same command continues from the results in the file.",
    "--replay-all": "It runs each failure again in the mission of today. MISSION is optional.",
    "--shrink": "The default is the number of schedules, at least 300 and at most 800; 0 shrinks nothing.",
}
"""The same for options of the command explore, whose help has a line for each."""
GUIDES = {
    "run": "../tutorials/first_run.md",
    "check": "mission_file.md#checking-a-mission",
    "new": "../tutorials/write_an_app.md",
    "board": "board_profiles.md#does-it-fit",
    "launch": "../how_to/run_a_ros_node.md",
    "node": "../how_to/run_a_ros_node.md",
    "rostest": "../how_to/run_a_ros_node.md#cfepy-rostest",
    "rostopic": "../how_to/bags_and_topics.md",
    "rosservice": "../how_to/bags_and_topics.md",
    "rosparam": "../how_to/tables_and_parameters.md#cfepy-rosparam",
    "rosbag": "../how_to/bags_and_topics.md",
    "rosmsg": "../how_to/bags_and_topics.md",
    "rosnode": "../how_to/bags_and_topics.md#nodes",
    "tf": "../how_to/bags_and_topics.md",
    "explore": "../how_to/explore_schedules.md",
    "sweep": "../how_to/sweep.md",
    "procedures": "../how_to/procedures.md",
    "replay": "../how_to/replay.md",
    "diff": "../how_to/replay.md",
    "trace": "../how_to/looking_at_a_run.md",
    "report": "../how_to/looking_at_a_run.md#the-page",
    "plot": "../how_to/looking_at_a_run.md#values-over-time",
    "cmd": "../how_to/ground_tools.md",
    "tlm": "../how_to/ground_tools.md",
    "console": "../how_to/ground_tools.md#console-all-of-it-at-once",
    "graph": "../how_to/ground_tools.md#the-graph",
    "export": "../how_to/ground_tools.md#export-xtce-for-other-ground-systems",
    "convert": "../how_to/convertor.md",
    "build": "../how_to/c_apps.md#building",
    "tbl": "../how_to/tables_and_parameters.md",
    "log": "../how_to/tables_and_parameters.md#files-that-cfe-writes",
}
"""The page that shows how to use each command."""


def page() -> str:
    """Return the page."""
    root = parser_for([])
    commands = _below(root)
    shared: dict[str, argparse._ArgumentGroup] = {}
    for parser in parsers_below(root):
        for group in parser.shared:
            shared.setdefault(group.title or "", group)
    parts = [HEAD]
    for name, title in SHARED.items():
        parts.append(f"### {title}\n")
        if name == "flight":
            parts.append(DECIDES)
        parts.append(_options(shared[name]._group_actions, MORE))
    for title, names in root._groups.items():  # type: ignore[attr-defined]
        parts.append(f"## {title}\n")
        for name in names:
            if name in GUIDES:  # commands of add-ons in other packages are not on the page
                parts += _command(name, commands[name], _short_help(root, name))
    return "\n".join(parts).rstrip() + "\n"


def _command(name: str, parser: CommandParser, short: str) -> Iterator[str]:
    yield f"### `cfepy {name}`\n"
    aliases = [alias for alias, command in ALIASES.items() if command == name]
    yield _filled(parser.description or f"{short[0].upper()}{short[1:]}.")
    if not _below(parser):
        yield f"Usage: {_usage(parser)}.\n"
    if aliases:
        yield f"Other name: {', '.join(f'`cfepy {alias}`' for alias in aliases)}.\n"
    examples = _listed([f"`{each}`" for each in parser.examples])
    yield f"Examples: {examples}. Guide: [{Path(GUIDES[name].partition('#')[0]).stem}]({GUIDES[name]}).\n"
    actions = _below(parser)
    if actions:
        yield _table(
            ("action", "purpose"),
            [(_usage(below), f"{_short_help(parser, each)}{_own_options(below)}") for each, below in actions.items()],
        )
        shared = sorted({title for below in actions.values() for title in _shared(below)})
    else:
        own = [group for group in parser._action_groups if group not in parser.shared]
        listed = [action for group in own for action in group._group_actions if _is_shown(action)]
        if listed:
            yield _options(listed, OF_EXPLORE if name == "explore" else {})
        shared = _shared(parser)
    if shared:
        links = [f"[{title}](#{title.lower().replace(' ', '-')})" for title in shared]
        yield _filled(f"More options: {_listed(links)}.")
    if parser.epilog and "exit status" in parser.epilog:
        text = parser.epilog.strip()
        yield f"```text\n{text}\n```\n" if "\n" in text else _filled(f"{text[0].upper()}{text[1:]}.")


def _below(parser: argparse.ArgumentParser) -> dict[str, CommandParser]:
    """Return the parsers of the commands below this one, by name."""
    found = [action for action in parser._actions if isinstance(action, argparse._SubParsersAction)]
    return {name: below for action in found for name, below in action.choices.items()}


def _short_help(parser: argparse.ArgumentParser, name: str) -> str:
    """Return the line that the help of a parser has for a command below it."""
    found = next(action for action in parser._actions if isinstance(action, argparse._SubParsersAction))
    return next((each.help or "" for each in found._choices_actions if each.dest == name), "")


def _shared(parser: CommandParser) -> list[str]:
    """Return the titles of the shared groups of a parser."""
    return [SHARED[group.title or ""] for group in parser.shared]


def _is_shown(action: argparse.Action) -> bool:
    return action.help is not argparse.SUPPRESS and "--help" not in action.option_strings


def _own_options(parser: CommandParser) -> str:
    """Return the options of an action of a command as text for a cell of a table."""
    options = [
        each
        for group in parser._action_groups
        if group not in parser.shared
        for each in group._group_actions
        if each.option_strings and _is_shown(each)
    ]
    return "".join(f"; {_words(each)}: {_help(each)}" for each in options)


def _options(actions: Sequence[argparse.Action], more: Mapping[str, str]) -> str:
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
