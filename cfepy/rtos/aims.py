"""Aims: what is to come directly before what, as a search that is guided by coverage wants it of a run.

    BANK.1@bank.py/14=BANK.2@bank.py/20

An aim names a task in a line of the mission's own code, and another task in a line. The other one does not go on from
its line before the first one has gone on from its own, and the first one waits then until the other one has left its
line. So the one comes after the other, however many calls there are between, in which they would miss each other. Where
nobody else can run an aim is given up.

In full it is FIRST@FILE/LINE[/N]=THEN@FILE/LINE. BANK is the first task of an application or node, BANK.1 the first one
that this started, BANK.1.2 the second one that that did: so names do not depend on who runs when. Files stand without
their folders. N says how many steps the first task makes from its line before it waits; a line in which others can get
in has several. Signs are escaped as in moves.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable
from types import FrameType
from typing import NamedTuple

from cfepy.own_code import is_own_code
from cfepy.rtos.moves import escaped, unescaped
from cfepy.rtos.policy import AskingPolicy, Decision, Policy
from cfepy.rtos.task import Task

Line = tuple[str, int]
"""Name of a source file without its folder, and a line of it."""
_NOWHERE = ("", 0)
_MAIN_TASK = 2  # numbers in the path of the first task of an application
_SIDE = r"(?P<{0}>[\w./+%-]+)@(?P<{0}_file>[\w.+%-]+)/(?P<{0}_line>\d+)"
_AIM = re.compile(rf"{_SIDE.format('first')}(?:/(?P<number>0*[1-9]\d*))?={_SIDE.format('then')}", re.ASCII)


class Aim(NamedTuple):
    """Who is to be where directly before whom.

    Attributes:
        first: the task that is to go first (`child_name`).
        first_line: where.
        then: the task that is to come next.
        then_line: where.
        number: how many times the first task goes on from there before it waits, from 1.
    """

    first: str
    first_line: Line
    then: str
    then_line: Line
    number: int = 1

    def text(self) -> str:
        """As it stands in a schedule; `Aim.parse` gives it again."""
        sides = [
            f"{escaped(task)}@{escaped(file)}/{line}"
            for task, (file, line) in ((self.first, self.first_line), (self.then, self.then_line))
        ]
        return f"{sides[0]}{f'/{self.number}' if self.number > 1 else ''}={sides[1]}"

    @classmethod
    def parse(cls, text: str) -> Aim:
        """The aim that a text means.

        Raises:
            ValueError: it means none.
        """
        match = _AIM.fullmatch(text)
        if match is None:
            raise ValueError(f"{text!r} is no aim")
        first, then = (
            (unescaped(match[side]), (unescaped(match[f"{side}_file"]), int(match[f"{side}_line"])))
            for side in ("first", "then")
        )
        return cls(*first, *then, int(match["number"] or 1))


def child_name(task: Task) -> str:
    """What a task is called in aims: its application, and which child of which of its tasks it is."""
    return ".".join([getattr(task.owner, "name", ""), *task.path.split(".")[_MAIN_TASK:]])


class _Pending:
    """An aim on its way."""

    def __init__(self, aim: Aim) -> None:
        self._aim = aim
        self._left = aim.number
        self.has_begun = False  # the first task has gone on from its line
        self.is_over = False

    def moved(self, task: str, before: Line, now: Line) -> None:
        """A task has gone on from a line."""
        aim = self._aim
        if self.has_begun:
            self.is_over = self.is_over or (task == aim.then and before == aim.then_line != now)
        elif task == aim.first and before == aim.first_line:
            self._left -= 1
            self.has_begun = not self._left

    def holds(self, task: str, line: Line) -> bool:
        """Whether a task that is to go on from a line has to wait."""
        aim = self._aim
        return task == aim.first if self.has_begun else task == aim.then and line == aim.then_line


class AimPolicy(AskingPolicy):
    """Another policy, but for tasks that aims hold up.

    Args:
        aims: what is to be, as far as it is possible.
        inner: decides who of the others runs.
    """

    def __init__(self, aims: Iterable[Aim], inner: Policy) -> None:
        super().__init__(inner)
        self._pending = [_Pending(aim) for aim in aims]
        self._where: dict[str, Line] = {}
        self._names: dict[Task, str] = {}

    def choose(self, decision: Decision) -> int:
        """See `Policy.choose`."""
        choice = self._inner.choose(decision)
        if decision.question is not None or not self._pending:
            return choice
        if decision.running:
            self._look(self._name(decision.tasks[0]), sys._getframe(1))
        names = [self._name(task) for task in decision.tasks]
        if choice >= len(names) or not self._holders(names[choice]):
            return choice
        free = [index for index, name in enumerate(names) if not self._holders(name)]
        if free:
            return free[choice % len(free)]
        for each in self._holders(names[0]):  # they are not possible
            self._pending.remove(each)
        return choice

    def _look(self, task: str, frame: FrameType | None) -> None:
        """Note where the running task is."""
        line, before = _line_of(frame), self._where.get(task)
        if line is None:
            return
        self._where[task] = line
        if before is not None:
            for each in self._pending:
                each.moved(task, before, line)
            self._pending = [each for each in self._pending if not each.is_over]

    def _name(self, task: Task) -> str:
        found = self._names.get(task)
        if found is None:
            found = self._names[task] = child_name(task)
        return found

    def _holders(self, task: str) -> list[_Pending]:
        """The aims that hold a task up."""
        line = self._where.get(task, _NOWHERE)
        return [each for each in self._pending if each.holds(task, line)]


def _line_of(frame: FrameType | None) -> Line | None:
    """The innermost line of the mission's own code; None where there is none."""
    while frame is not None:
        file = frame.f_code.co_filename
        if is_own_code(file):
            return file.rpartition("/")[2], frame.f_lineno
        frame = frame.f_back
    return None
