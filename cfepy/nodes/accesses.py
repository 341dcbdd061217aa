"""`Accesses`: reports the reads and writes of tasks in mission code to observers, with optional scheduling points.

Code compiled by `cfepy.nodes.instrument` calls the hooks of a run just before it reads or writes an attribute, an item
of a container, or a variable that several functions share. A scheduling point comes before the access. Each object gets
a number in order of first access, so the same run always reports the same numbers. If there are no observers and no
points, code is compiled unchanged and this module has no cost.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, MutableMapping, MutableSequence, MutableSet
from contextlib import contextmanager
from pathlib import PurePath
from types import CodeType, FrameType, FunctionType, MemberDescriptorType, ModuleType
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar, cast
from weakref import ref

from cfepy.rtos import Task
from cfepy.schedules import CALLS, LINES, Points, name_of

if TYPE_CHECKING:
    from cfepy.nodes.instrument import Kinds
    from cfepy.rtos import Kernel
    from cfepy.schedules import CallPointKernel

WHOLE = "*"
"""Key of an access to a whole container: its length, order or membership."""
T = TypeVar("T")
_HEAP_TYPE = 1 << 9  # Py_TPFLAGS_HEAPTYPE: a class defined in Python; other objects have no attributes to share
_SIMPLE = (str, int, float, bool, bytes, type(None))
_SWEEP_AT = 512


class Touch(NamedTuple):
    """One access that a task is about to make.

    Attributes:
        task: the task.
        thing: number of the object: an object with attributes, a container, or the variables of a module or function.
        key: name of an attribute or variable, `[key]` for an item, WHOLE for a whole container.
        is_write: whether it is a write.
        name: readable name: `Arm.position`, `self.goals['x']`.
        code: the code that makes the access.
        line: line number in its file.
    """

    task: Task
    thing: int
    key: str
    is_write: bool
    name: str
    code: CodeType
    line: int

    @property
    def file(self) -> str:
        """Source file, as the mission sees it."""
        return self.code.co_filename

    @property
    def place(self) -> str:
        """Place of the access, such as `Arm.move (arm.py:12)`."""
        return f"{self.code.co_qualname} ({PurePath(self.code.co_filename).name}:{self.line})"


Observer = Callable[[Touch], object]


class ThingNumbers:
    """Numbers of objects, in order of first access. Objects are not kept alive for long."""

    def __init__(self) -> None:
        self._last = 0
        self.on_gone: Callable[[int], object] = lambda number: None
        self._weak: dict[int, tuple[int, ref[Any]]] = {}
        self._kept: dict[int, tuple[int, Any]] = {}  # objects that do not support weak references
        self._sweep_at = _SWEEP_AT

    def of(self, thing: Any) -> int:
        """Return the number of an object, from 1."""
        address = id(thing)
        found = self._weak.get(address) or self._kept.get(address)
        if found is not None:
            return found[0]
        self._last = number = self._last + 1
        try:
            self._weak[address] = number, ref(thing, lambda gone: self._forget(address))
        except TypeError:
            if len(self._kept) >= self._sweep_at:
                self._sweep()
            self._kept[address] = number, thing
        return number

    def _forget(self, address: int) -> None:
        found = self._weak.pop(address, None)
        if found is not None:
            self.on_gone(found[0])

    def _sweep(self) -> None:
        """Drop objects that are referenced only here; they can never be accessed again."""
        entry: tuple[int, Any] = (0, object())
        alone = sys.getrefcount(entry[1])
        gone = [address for address, entry in self._kept.items() if sys.getrefcount(entry[1]) <= alone]
        for address in gone:
            self.on_gone(self._kept.pop(address)[0])
        self._sweep_at = max(_SWEEP_AT, 2 * len(self._kept))


class Accesses:
    """Hooks of one run.

    Args:
        kernel: kernel of the mission; its policy determines the scheduling points.

    Attributes:
        observers: receive each access; set before the mission boots.
        files: source files whose code has hooks.
        seen: all source files of the mission that were loaded while hooks were wanted.
    """

    def __init__(self, kernel: Kernel) -> None:
        self.observers: list[Observer] = []
        self.files: set[str] = set()
        self.seen: set[str] = set()
        self._kernel = kernel
        self._points = Points.parse("" if kernel.policy is None else kernel.policy.points)
        self._point = None if kernel.policy is None else _point_of(kernel)
        self._has_points = self._points.are_at_accesses
        self._names = frozenset(self._points.names)
        self._named: dict[str, bool] = {}
        self._loading: dict[Task, int] = {}  # tasks that are executing the body of a module
        self._covered: dict[str, bool] = {}
        self._local: dict[type, bool] = {}
        self._numbers = ThingNumbers()
        self._modules: dict[int, str] = {}  # names of modules, by number of their variables
        self._held: dict[tuple[int, int], tuple[Any, ...]] = {}

    @property
    def is_on(self) -> bool:
        """Whether code has to be compiled with hooks."""
        return bool(self.observers or self._points.kind)

    def kinds(self, file: str, is_main: bool) -> Kinds | None:
        """Return which hooks the code of a file gets; None for none.

        Args:
            file: the source file.
            is_main: whether it is a node's script.
        """
        self.seen.add(file)
        kind = self._points.kind if self._points.cover(file) else ""
        if not (self.observers or kind):
            return None
        from cfepy.nodes.instrument import Kinds

        self.files.add(file)
        has_points = bool(kind) and self._points.are_at_accesses
        names = frozenset() if self.observers else self._names
        return Kinds(bool(self.observers) or has_points, kind == LINES, kind == CALLS, is_main, names)

    def number(self, thing: object) -> int:
        """Return the number of an object, from 1."""
        return self._numbers.of(thing)

    def on_gone(self, action: Callable[[int], object]) -> None:
        """Call `action` with the number of each object that has been freed, at some time after it was freed."""
        self._numbers.on_gone = action

    def hooks(self) -> dict[str, Callable[..., Any]]:
        """Return the hooks that instrumented code needs among its builtins."""
        return {f"__{name}__": getattr(self, name) for name in _HOOKS}

    def adopt(self, variables: dict[str, Any]) -> None:
        """Register the variables of a mission module that is about to be executed."""
        name = variables.get("__name__", "")
        if name == "__main__" or "." not in name:
            name = PurePath(variables.get("__file__") or name).stem
        self._modules[self._numbers.of(variables)] = name.rpartition(".")[2]

    @contextmanager
    def loading(self) -> Iterator[None]:
        """Mark the current task as executing a module body: it holds an import lock, so there are no
        scheduling points.
        """
        task = self._kernel.current
        self._loading[task] = self._loading.get(task, 0) + 1
        try:
            yield
        finally:
            self._loading[task] -= 1
            if not self._loading[task]:
                del self._loading[task]

    # -- telling -------------------------------------------------------------------------------------------------------

    def _let_in(self, frame: FrameType, name: str) -> None:
        """Let other tasks run before an access."""
        if (
            self._has_points
            and self._point is not None
            and (not self._names or self._is_named(name))
            and self._covers(frame.f_code.co_filename)
            and self._kernel.current not in self._loading
        ):
            self._point()

    def _is_named(self, name: str) -> bool:
        """Return whether the points name the object of an access."""
        found = self._named.get(name)
        if found is None:
            found = self._named[name] = name_of(name) in self._names
        return found

    def _covers(self, file: str) -> bool:
        found = self._covered.get(file)
        if found is None:
            found = self._covered[file] = self._points.cover(file)
        return found

    def _tell(self, frame: FrameType, thing: int, key: str, is_write: bool, name: str) -> None:
        """Let other tasks run, then report an access."""
        if self._has_points:
            self._let_in(frame, name)
        self._tell_now(frame, thing, key, is_write, name)

    def _tell_now(self, frame: FrameType, thing: int, key: str, is_write: bool, name: str) -> None:
        if self.observers:
            access = Touch(self._kernel.current, thing, key, is_write, name, frame.f_code, frame.f_lineno)
            for observer in self.observers:
                observer(access)

    # -- points --------------------------------------------------------------------------------------------------------

    def line(self) -> None:
        """A statement begins."""
        if self._point is not None and self._kernel.current not in self._loading:
            self._point()

    def called(self, value: T) -> T:
        """Let other tasks run after a call that entered cfepy, so that the values it read can become outdated."""
        kernel = cast("CallPointKernel", self._kernel)
        task = kernel.current
        if kernel.entered.pop(task, False) and task not in self._loading:
            kernel.point()
            kernel.entered.pop(task, None)
        return value

    # -- attributes ----------------------------------------------------------------------------------------------------

    def reads_attribute(self, thing: T, name: str) -> T:
        """An attribute is about to be read."""
        found = self._attribute(thing, name, is_write=False)
        if found is not None:
            self._tell(sys._getframe(1), *found, False, self._name_of(thing, name))
        return thing

    def writes_attribute(self, thing: T, name: str) -> T:
        """An attribute is about to be set or removed."""
        found = self._attribute(thing, name, is_write=True)
        if found is not None:
            self._tell(sys._getframe(1), *found, True, self._name_of(thing, name))
        return thing

    def updates_attribute(self, thing: T, name: str, site: int) -> T:
        """An attribute is about to be read for an augmented assignment, which then sets it to the result."""
        frame = sys._getframe(1)
        self._held.pop((id(frame), site), None)
        found = self._attribute(thing, name, is_write=False)
        if found is not None:
            text = self._name_of(thing, name)
            self._tell(frame, *found, False, text)
            written = self._attribute(thing, name, is_write=True)
            if written is not None:
                self._held[id(frame), site] = (*written, text)
        return thing

    def updated(self, value: T, site: int) -> T:
        """The result of an augmented assignment is about to be stored."""
        frame = sys._getframe(1)
        held = self._held.pop((id(frame), site), None)
        if held is not None:
            thing, key, name = held
            self._tell(frame, thing, key, True, name)
        return value

    def _attribute(self, thing: Any, name: str, is_write: bool) -> tuple[int, str] | None:
        """Return the number of the object that has an attribute, and the key; None if it is not mission state."""
        kind = type(thing)
        if kind is ModuleType:
            number = self._numbers.of(vars(thing))
            return (number, name) if number in self._modules else None
        if not kind.__flags__ & _HEAP_TYPE and (kind is not type or not thing.__flags__ & _HEAP_TYPE):
            return None
        if isinstance(thing, type):
            owner = thing if is_write else _class_with(thing, name)
            if owner is None or not owner.__flags__ & _HEAP_TYPE or _is_code(vars(owner).get(name)):
                return None
            return self._numbers.of(owner), name
        if self._is_local(kind):
            return None
        for owner in kind.__mro__:
            if name in owner.__dict__:
                break
        else:
            return self._numbers.of(thing), name
        value = owner.__dict__[name]
        if isinstance(value, MemberDescriptorType):
            return self._numbers.of(thing), name
        if hasattr(type(value), "__set__"):
            return None  # a property: its own code reports its accesses
        if is_write or name in _variables(thing):
            return self._numbers.of(thing), name
        return None if _is_code(value) else (self._numbers.of(owner), name)

    def _is_local(self, kind: type) -> bool:
        """Return whether a class is a `threading.local`, whose attributes are separate for each thread."""
        found = self._local.get(kind)
        if found is None:
            found = any(each.__name__ == "_local" and each.__module__ == "_thread" for each in kind.__mro__)
            self._local[kind] = found
        return found

    def _name_of(self, thing: Any, name: str) -> str:
        if type(thing) is ModuleType:
            return f"{self._modules[self._numbers.of(vars(thing))]}.{name}"
        return f"{thing.__name__ if isinstance(thing, type) else type(thing).__name__}.{name}"

    # -- items ---------------------------------------------------------------------------------------------------------

    def reads_item(self, thing: T, key: Any, text: str) -> T:
        """An item is about to be read."""
        if _is_container(thing):
            self._tell_item(sys._getframe(1), thing, self._item(thing, key), False, text)
        return thing

    def writes_item(self, thing: T, key: Any, text: str) -> T:
        """An item is about to be set."""
        if _is_container(thing):
            self._tell_written(sys._getframe(1), thing, key, text)
        return thing

    def updates_item(self, thing: T, key: Any, text: str, site: int) -> T:
        """An item is about to be read for an augmented assignment."""
        self._update(sys._getframe(1), thing, key, text, site)
        return thing

    def updates_all(self, thing: T, text: str, site: int) -> T:
        """A slice of a container is about to be read for an augmented assignment."""
        frame = sys._getframe(1)
        self._held.pop((id(frame), site), None)
        if _is_container(thing):
            self._tell_item(frame, thing, WHOLE, False, text)
            self._held[id(frame), site] = self._numbers.of(thing), WHOLE, text
        return thing

    def holds(self, thing: T, text: str, site: int) -> T:
        """Hold a container whose item is about to be accessed, until its key has been evaluated."""
        self._held[id(sys._getframe(1)), site] = thing, text
        return thing

    def reads_key(self, key: T, site: int) -> T:
        """Return the key of an item that is about to be read."""
        frame = sys._getframe(1)
        thing, text = self._held.pop((id(frame), site))
        if _is_container(thing):
            self._tell_item(frame, thing, self._item(thing, key), False, text)
        return key

    def writes_key(self, key: T, site: int) -> T:
        """Return the key of an item that is about to be set."""
        frame = sys._getframe(1)
        thing, text = self._held.pop((id(frame), site))
        if _is_container(thing):
            self._tell_written(frame, thing, key, text)
        return key

    def updates_key(self, key: T, site: int) -> T:
        """Return the key of an item that is about to be read, in order to be set."""
        frame = sys._getframe(1)
        thing, text = self._held.pop((id(frame), site))
        self._update(frame, thing, key, text, site)
        return key

    def _update(self, frame: FrameType, thing: Any, key: Any, text: str, site: int) -> None:
        self._held.pop((id(frame), site), None)
        if _is_container(thing):
            item = self._item(thing, key)
            self._tell_item(frame, thing, item, False, text)
            self._held[id(frame), site] = self._numbers.of(thing), item, _item_name(text, item)

    def _tell_written(self, frame: FrameType, thing: Any, key: Any, text: str) -> None:
        """Report a write to an item: a new key of a dictionary changes the whole dictionary."""
        self._let_in(frame, text)
        try:
            item = WHOLE if issubclass(type(thing), dict) and key not in thing else self._item(thing, key)
        except TypeError:  # not a valid key; the program is about to get the error itself
            return
        self._tell_now(frame, self._numbers.of(thing), item, True, _item_name(text, item))

    def _tell_item(self, frame: FrameType, thing: Any, item: str, is_write: bool, text: str) -> None:
        self._tell(frame, self._numbers.of(thing), item, is_write, _item_name(text, item))

    def _item(self, thing: Any, key: Any) -> str:
        """Return the key of an item as text: simple keys as they are, others by their number."""
        if type(key) is int and key < 0 and issubclass(type(thing), MutableSequence):
            key += len(thing)
        if type(key) is tuple and all(type(each) in _SIMPLE for each in key):
            return f"[{key!r}]"
        if isinstance(key, slice):
            return WHOLE
        return f"[{key!r}]" if type(key) in _SIMPLE else f"[{type(key).__name__} {self._numbers.of(key)}]"

    # -- containers as a whole -----------------------------------------------------------------------------------------

    def looks_into(self, thing: T, text: str, site: int = 0) -> T:
        """A container is about to be iterated, counted or searched."""
        frame = sys._getframe(1)
        if _is_container(thing):
            self._tell_item(frame, thing, WHOLE, False, text)
            if site:
                self._held[id(frame), site] = self._numbers.of(thing), text
        elif site:
            self._held.pop((id(frame), site), None)
        return thing

    def looks_again(self, site: int) -> None:
        """The next item of an iterated container is about to be used."""
        frame = sys._getframe(1)
        held = self._held.get((id(frame), site))
        if held is not None:
            number, text = held
            self._tell(frame, number, WHOLE, False, text)

    def changes(self, thing: T, text: str) -> T:
        """A container is about to get another length or order."""
        if _is_container(thing):
            self._tell_item(sys._getframe(1), thing, WHOLE, True, text)
        return thing

    def calls_method(self, thing: T, name: str, text: str) -> T:
        """A method is about to be called that containers may have."""
        self._tell_call(sys._getframe(1), thing, name, text)
        return thing

    def holds_method(self, thing: T, name: str, text: str, site: int) -> T:
        """Such a method is about to be called, but its arguments are not evaluated yet: keep it until they are."""
        self._held[id(sys._getframe(1)), site] = thing, name, text
        return thing

    def calls_held(self, value: T, site: int) -> T:
        """The last argument of such a method has been evaluated."""
        frame = sys._getframe(1)
        self._tell_call(frame, *self._held.pop((id(frame), site)))
        return value

    def _tell_call(self, frame: FrameType, thing: Any, name: str, text: str) -> None:
        if _is_container(thing):
            from cfepy.nodes.instrument import CHANGING_METHODS

            self._tell_item(frame, thing, WHOLE, name in CHANGING_METHODS, text)
            return
        found = self._attribute(thing, name, is_write=False)
        if found is not None:
            self._tell(frame, *found, False, self._name_of(thing, name))

    # -- variables -----------------------------------------------------------------------------------------------------

    def read_variable(self, name: str, user: FunctionType | None = None) -> None:
        """A variable is about to be read."""
        self._tell_variable(sys._getframe(1), name, user, False)

    def write_variable(self, name: str, user: FunctionType | None = None) -> None:
        """A variable is about to be removed."""
        self._tell_variable(sys._getframe(1), name, user, True)

    def wrote_variable(self, name: str, user: FunctionType | None = None) -> None:
        """A variable was set as one of several targets."""
        self._tell_variable(sys._getframe(1), name, user, True)

    def writes_variable(self, value: T, name: str, user: FunctionType | None = None) -> T:
        """A variable is about to be set."""
        self._tell_variable(sys._getframe(1), name, user, True)
        return value

    def _tell_variable(self, frame: FrameType, name: str, user: FunctionType | None, is_write: bool) -> None:
        if user is None:
            number = self._numbers.of(frame.f_globals)
            owner = self._modules.get(number, "")
        else:
            assert user.__closure__ is not None
            number = self._numbers.of(user.__closure__[0])
            owner = user.__qualname__.partition(".<locals>")[0]
        self._tell(frame, number, name, is_write, f"{owner}.{name}")


def _point_of(kernel: Kernel) -> Callable[[], object]:
    """Return the scheduling point of a kernel with a policy; a run without one does not load that kernel."""
    from cfepy.schedules import ExploringKernel

    assert isinstance(kernel, ExploringKernel)
    return kernel.point


_HOOKS = (
    *("line", "called", "reads_attribute", "writes_attribute", "updates_attribute", "updated", "reads_item"),
    *("writes_item", "updates_item", "updates_all", "holds", "reads_key", "writes_key", "updates_key", "looks_into"),
    *("looks_again", "changes", "calls_method", "holds_method", "calls_held", "read_variable", "write_variable"),
    *("wrote_variable", "writes_variable"),
)
"""Methods of `Accesses` that instrumented code calls, with two underscores on each side."""


def _class_with(kind: type, name: str) -> type | None:
    """Return the class that an attribute of a class is found in."""
    return next((each for each in kind.__mro__ if name in each.__dict__), None)


def _is_code(value: object) -> bool:
    """Return whether a class attribute is a function or another descriptor, and not a value."""
    return hasattr(type(value), "__get__")


def _variables(thing: Any) -> dict[str, Any]:
    """Return the attributes of the object itself."""
    try:
        found: dict[str, Any] = object.__getattribute__(thing, "__dict__")
    except AttributeError:
        return {}
    return found


def _is_container(thing: Any) -> bool:
    """Return whether an object is a mutable container that is not implemented in mission code."""
    kind = type(thing)
    if kind in (dict, list, set):
        return True
    if kind in (str, tuple, int, float, bytes, frozenset, range, type(None), bool):
        return False
    return issubclass(kind, (MutableMapping, MutableSequence, MutableSet)) or kind.__name__ == "ndarray"


def _item_name(text: str, item: str) -> str:
    """Return the name of an item, or of a whole container."""
    return text if item == WHOLE else f"{text}{item}"
