"""Aims: their text, and the tasks that they hold up."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cfepy.rtos import Aim, Decision, Policy, Schedule
from cfepy.rtos.aims import AimPolicy
from cfepy.status import UsageError

NAMES = st.text("ab.1 ~=,@/:#+%", min_size=1, max_size=6)
FILES = st.text("ab.-~=,@: +%", min_size=1, max_size=6)
LINES = st.tuples(FILES, st.integers(0, 10**6))


@settings(max_examples=20)
@given(st.lists(st.builds(Aim, NAMES, LINES, NAMES, LINES, st.integers(1, 99)), min_size=1), st.integers(0, 10**9))
def test_the_text_of_a_schedule_with_aims_means_it(aims: list[Aim], seed: int) -> None:
    schedule = Schedule("at", any_priority=True, from_ns=600_000_000).with_aims(aims, seed)
    assert Schedule.parse(schedule.text()) == schedule


@pytest.mark.parametrize("text", ["aims:0:A@b.py", "aims:0:A@b.py/1=B", "aims:0:A@b.py/1/0=B@b.py/2", "aims:0:x"])
def test_what_is_no_aim_is_told(text: str) -> None:
    with pytest.raises(UsageError, match="is no aim; write for instance aims:0:"):
        Schedule.parse(text)


class Steps:
    """Tasks that go from line to line of a file, as far as a policy lets them."""

    def __init__(self, *aims: Aim, second: tuple[int, ...] = (11, 12)) -> None:
        self._policy = AimPolicy(aims, Policy())
        self._left = {"A": [1, 2, 3], "B": list(second)}
        self.went: list[str] = []

    def run(self, monkeypatch: pytest.MonkeyPatch) -> str:
        """Who went when: each decision is asked by the task that is at the line behind its name."""
        tasks = [self._task("1.7"), self._task("1.8")]
        names = {tasks[0]: "A", tasks[1]: "B"}
        at = ("", 0)
        monkeypatch.setattr("cfepy.rtos.aims._line_of", lambda frame: at)
        while self._left:
            ready = sorted((task for task in tasks if names[task] in self._left), key=self._last)
            if len(ready) == 1:
                chosen = ready[0]
            else:
                at = ("x.py", self._left[names[ready[0]]][0])
                chosen = ready[self._policy.choose(Decision(0, 0, ready, True, False, None))]
            name = names[chosen]
            self.went.append(f"{name}{self._left[name].pop(0)}")
            if not self._left[name]:
                del self._left[name]
        return " ".join(self.went)

    def _last(self, task: Any) -> bool:
        """The one that went last comes first, as the one that is running."""
        return not (self.went and self.went[-1].startswith(task.owner.name))

    @staticmethod
    def _task(path: str) -> Any:
        owner = SimpleNamespace(name="A" if path == "1.7" else "B")
        return _Task(owner, path)


class _Task:
    def __init__(self, owner: Any, path: str) -> None:
        self.owner, self.path = owner, path


def test_without_aims_it_is_the_other_policy(monkeypatch: pytest.MonkeyPatch) -> None:
    assert Steps().run(monkeypatch) == "A1 A2 A3 B11 B12"


def test_the_first_task_waits_until_the_other_one_has_left_its_line(monkeypatch: pytest.MonkeyPatch) -> None:
    aim = Aim("A", ("x.py", 1), "B", ("x.py", 11))
    assert Steps(aim).run(monkeypatch) == "A1 B11 B12 A2 A3"
    later = Aim("A", ("x.py", 2), "B", ("x.py", 11))
    assert Steps(later).run(monkeypatch) == "A1 A2 B11 B12 A3"


def test_the_other_task_waits_in_its_line_for_the_first_one(monkeypatch: pytest.MonkeyPatch) -> None:
    steps = Steps(Aim("A", ("x.py", 2), "B", ("x.py", 11)), second=(10, 11, 12))
    steps.went.append("B")  # it is running
    assert steps.run(monkeypatch) == "B B10 A1 A2 B11 B12 A3"


def test_what_cannot_be_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    both = Aim("A", ("x.py", 3), "B", ("x.py", 11)), Aim("B", ("x.py", 12), "A", ("x.py", 2))
    assert sorted(Steps(*both).run(monkeypatch).split()) == ["A1", "A2", "A3", "B11", "B12"]
