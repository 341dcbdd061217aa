"""`Suite` and `Group` of `openc3.script.suite`: which tests a suite has, and in which order they run.

COSMOS collects the methods of a group whose names begin with test_, script_ or op_, in alphabetical order, and runs
the setup of the suite, then for each group its setup, tests and teardown, and the teardown of the suite.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

from cfepy.status import UsageError

BEGINNINGS = ("test_", "script_", "op_")
SETUP, TEARDOWN = "setup", "teardown"


class ProcedureGroup:
    """Base class of the groups of procedures."""

    _write: Callable[[str], object] = staticmethod(print)
    _current: tuple[str, str, str] | None = None  # of the running method, set on this class only

    @classmethod
    def current_suite(cls) -> str | None:
        """Return the name of the running suite."""
        return None if ProcedureGroup._current is None else ProcedureGroup._current[0]

    @classmethod
    def current_group(cls) -> str | None:
        """Return the name of the running group."""
        return None if ProcedureGroup._current is None else ProcedureGroup._current[1]

    @classmethod
    def current_script(cls) -> str | None:
        """Return the name of the running method."""
        return None if ProcedureGroup._current is None else ProcedureGroup._current[2]

    @classmethod
    def print(cls, *given: Any) -> None:
        """Print a line to the output of the test."""
        ProcedureGroup._write(" ".join(map(str, given)))

    puts = print

    @classmethod
    def scripts(cls) -> list[str]:
        """Return the names of the tests, in alphabetical order."""
        return scripts_of(cls)

    @classmethod
    def screens(cls) -> list[str]:
        """Return no screens, because there are none here."""
        return []


class ProcedureSuite:
    """Base class of suites. A derived class adds its groups in `__init__`."""

    def __new__(cls, *given: Any, **options: Any) -> ProcedureSuite:
        suite = super().__new__(cls)
        suite._plan = []
        return suite

    _plan: list[tuple[type, str]]

    def add_group(self, group: type | str) -> None:
        """Add setup, all tests and teardown of a group."""
        found = self._class(group)
        self._plan += [(found, each) for each in (SETUP, *scripts_of(found), TEARDOWN)]

    def add_script(self, group: type | str, script: str) -> None:
        """Add one test of a group."""
        self._plan.append((self._class(group), script))

    def add_group_setup(self, group: type | str) -> None:
        """Add the setup of a group."""
        self._plan.append((self._class(group), SETUP))

    def add_group_teardown(self, group: type | str) -> None:
        """Add the teardown of a group."""
        self._plan.append((self._class(group), TEARDOWN))

    def _class(self, group: type | str) -> type:
        if isinstance(group, type):
            return group
        import sys

        found = getattr(sys.modules.get(type(self).__module__), group, None) or _NAMES.get(group)
        if not isinstance(found, type):
            raise UsageError(f"unknown group {group}; load its file with load_utility")
        return found


_NAMES: dict[str, type] = {}


class ProcedureStep(NamedTuple):
    """A method that a suite runs.

    Attributes:
        suite: name of the suite.
        group: name of the group; empty for the suite's own setup and teardown.
        script: name of the method.
        call: runs it.
        text: its docstring.
    """

    suite: str
    group: str
    script: str
    call: Callable[[], Any]
    text: str = ""

    @property
    def is_test(self) -> bool:
        """Whether it is a test, and not a setup or teardown."""
        return self.script not in (SETUP, TEARDOWN)

    @property
    def name(self) -> str:
        """Its name in reports."""
        return f"{self.group}::{self.script}" if self.group else f"{self.suite}::{self.script}"


def scripts_of(group: type) -> list[str]:
    """Return the names of the tests of a group, in alphabetical order; values such as `test_file = "a"` are none."""
    return sorted(each for each in dir(group) if each.startswith(BEGINNINGS) and callable(getattr(group, each)))


def steps_of(kind: type) -> Iterator[ProcedureStep]:
    """Yield the methods of a suite in the order of COSMOS; those that the classes do not have are left out.

    Args:
        kind: the class of the suite.
    """
    suite = kind()
    objects: dict[type, Any] = {}
    yield from _step(kind.__name__, "", suite, SETUP)
    for group, script in suite._plan:
        if group not in objects:
            objects[group] = group()
        yield from _step(kind.__name__, group.__name__, objects[group], script)
    yield from _step(kind.__name__, "", suite, TEARDOWN)


def _step(suite: str, group: str, owner: Any, script: str) -> Iterator[ProcedureStep]:
    call = getattr(owner, script, None)
    if call is None and script in (SETUP, TEARDOWN):
        return
    if not callable(call):
        raise UsageError(f"{group} has no script {script}")
    yield ProcedureStep(suite, group, script, call, (call.__doc__ or "").strip())


def is_suite(value: Any, own: type) -> bool:
    """Return whether a value is a suite that a procedure declares."""
    return isinstance(value, type) and issubclass(value, own) and value is not own
