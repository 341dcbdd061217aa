"""How long a shrunk schedule lasts: the planted bugs after small edits, one at a time, under the earlier schedule.

A schedule of moves names the task and the call of each switch; one of decisions uses their numbers, and an edit adds
decisions. For both, the program counts whether the bug still shows.
"""

from __future__ import annotations

import ast
import shutil
import tempfile
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from cfepy.extra.exploration.trial import Trial
from cfepy.schedules import Schedule
from dev.quality.bugs import BUGS, Bug, reference_trial
from dev.quality.report import SHRUNK, load

COMMENT = "# What this is for is told in the handbook.\n# It has a second line.\n"
IN_NODE, IN_APP = "rospy.logdebug('here')", "{cfe}.es.write_to_sys_log('here')"
PUBLISHES = """import std_msgs.msg
rospy.Publisher('other', std_msgs.msg.Empty, queue_size=1).publish()"""
BUSY_NODE = """import rospy
from std_msgs.msg import Empty

rospy.init_node("busy")
busy = rospy.Publisher("busy", Empty, queue_size=10)
rospy.Subscriber("busy", Empty, lambda message: None)
rate = rospy.Rate(100)
while not rospy.is_shutdown():
    busy.publish()
    rate.sleep()
"""
BUSY_LINE = "CFE_APP, busy.py, __main__, BUSY, 100, 16384, 0x0, 0;\n"
SCRIPT = "startup.scr"


class Edit(NamedTuple):
    """One small change of a mission.

    Attributes:
        kind: its kind, for the table.
        text: a description of the change.
        make: performs it in a copy of the mission's folder.
    """

    kind: str
    text: str
    make: Callable[[Path], object]


def edits_of(folder: Path) -> Iterator[Edit]:
    """Yield all that are tried with a mission.

    Args:
        folder: of the mission.
    """
    sources = {path.name: path.read_text(encoding="utf-8") for path in sorted(folder.glob("*.py"))}

    def comment(copy: Path) -> None:
        for name, text in sources.items():
            (copy / name).write_text(COMMENT + text, encoding="utf-8")

    yield Edit("two lines of comment at the top of each file", "", comment)
    for name, text in sources.items():
        for place, statement in _logs(text):
            yield _inserting("a log call at the start of a function", name, text, place, statement)
    for name, text in sources.items():
        place, statement = _boot(text, "rospy.get_param('/other', 0)", "cfe.es.get_app_id()")
        kind = "another parameter (or, in an application, its id) asked for at boot"
        yield _inserting(kind, name, text, place, statement)
    for name, text in sources.items():
        if _is_node(text):
            place, statement = _boot(text, PUBLISHES, "")
            kind = "another topic advertised and published to, in one of the nodes"
            yield _inserting(kind, name, text, place, statement)
    script = (folder / SCRIPT).read_text(encoding="utf-8")
    for is_first in (True, False):
        yield _with_another_node(script, is_first)


def _inserting(kind: str, name: str, text: str, line: int, statement: str) -> Edit:
    lines = text.splitlines(keepends=True)
    indent = lines[line - 1][: len(lines[line - 1]) - len(lines[line - 1].lstrip())]
    inserted = [f"{indent}{each}\n" for each in statement.splitlines()]
    changed = "".join([*lines[: line - 1], *inserted, *lines[line - 1 :]])
    return Edit(kind, f"{name}:{line}", lambda copy: (copy / name).write_text(changed, encoding="utf-8"))


def _with_another_node(script: str, is_first: bool) -> Edit:
    head, mark, rest = script.partition("!")
    changed = f"{BUSY_LINE if is_first else ''}{head}{'' if is_first else BUSY_LINE}{mark}{rest}"

    def make(copy: Path) -> None:
        (copy / "busy.py").write_text(BUSY_NODE, encoding="utf-8")
        (copy / SCRIPT).write_text(changed, encoding="utf-8")

    kind = "another node in the startup script, first or last, which publishes at 100 Hz to itself"
    return Edit(kind, "first" if is_first else "last", make)


def _is_node(text: str) -> bool:
    return "rospy.init_node(" in text


def _logs(text: str) -> Iterator[tuple[int, str]]:
    """Yield the line before which to insert a log call, and the call, for each function that can log."""
    for function in ast.walk(ast.parse(text)):
        if not isinstance(function, ast.FunctionDef) or function.name == "__init__":
            continue
        names = [argument.arg for argument in function.args.args]
        cfe = "cfe" if "cfe" in names else "self.cfe"
        if _is_node(text):
            yield function.body[0].lineno, IN_NODE
        elif cfe == "cfe" or (names[:1] == ["self"] and "self.cfe = cfe" in text):
            yield function.body[0].lineno, IN_APP.format(cfe=cfe)


def _boot(text: str, in_node: str, in_app: str) -> tuple[int, str]:
    """Return the line before which to insert a text, and the text: after `init_node`, or at an application's start."""
    tree = ast.parse(text)
    if _is_node(text):
        calls = (each for each in ast.walk(tree) if isinstance(each, ast.Expr) and "init_node(" in ast.unparse(each))
        return next(calls).lineno + 1, in_node
    main = next(each for each in tree.body if isinstance(each, ast.FunctionDef) and each.name.endswith("_AppMain"))
    return main.body[0].lineno, in_app


class Lasting(NamedTuple):
    """Whether a bug still shows after an edit, under each kind of schedule."""

    edit: Edit
    moves: bool
    numbers: bool


def lasting(bug: Bug, schedule: Schedule) -> Iterator[Lasting]:
    """Fly a bug's mission after each edit.

    Args:
        bug: it.
        schedule: of moves, which shows it.
    """
    tried = reference_trial(bug.folder).run(schedule)
    numbers = schedule.at(dict(tried.deviations))
    for edit in edits_of(bug.folder):
        with tempfile.TemporaryDirectory() as place:
            copy = Path(place) / bug.name
            shutil.copytree(bug.folder, copy, ignore=shutil.ignore_patterns("__pycache__", "fix.yaml"))
            edit.make(copy)
            trial = reference_trial(copy)
            if trial.run(Schedule()).failed:
                continue  # this edit would be a mistake itself: a rate in a mission whose clock jumps back
            yield Lasting(edit, _shows(bug, trial, schedule), _shows(bug, trial, numbers))


def _shows(bug: Bug, trial: Trial, schedule: Schedule) -> bool:
    found = trial.run(schedule)
    assert not found.trouble, found.trouble
    return any(failure.kind in bug.kinds for failure in found.failures)


def measure(names: Sequence[str]) -> None:
    """Print the table.

    Args:
        names: names of the bugs; all of them if empty.
    """
    edits, moves, numbers = Counter[str](), Counter[str](), Counter[str]()
    shrunk = load()
    for bug in BUGS:
        if names and bug.name not in names:
            continue
        for each in lasting(bug, Schedule.parse(shrunk[bug.name][SHRUNK]["schedule"])):
            edits[each.edit.kind] += 1
            moves[each.edit.kind] += each.moves
            numbers[each.edit.kind] += each.numbers
            if not each.moves:
                print(f"{bug.name}: {each.edit.kind}: {each.edit.text}: lost", flush=True)
    print("| edit | edits | `moves:` still fails | `at:` still fails |\n|---|---|---|---|")
    for kind, count in edits.items():
        print(f"| {kind} | {count} | {moves[kind]} | {numbers[kind]} |")
    print(f"| all | {edits.total()} | {moves.total()} | {numbers.total()} |")
