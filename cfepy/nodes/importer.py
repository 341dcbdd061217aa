"""Import system of a universe: its `__import__`, module table and search path.

Names are looked up in this order: the node's table; modules given to the universe (rospy, message packages); modules
made for it (`time`, `_thread`, `os`, ...); the node's own folders; libraries of its owner; the standard library and the
installed packages, executed again or shared as `cfepy.nodes.module_origins` determines. The host's `sys.modules` is not
changed. A few modules are lazy: their code runs when a name in them is first needed, as with
`importlib.util.LazyLoader`. A thread that loads a module which another thread is executing waits for it, as in Python.
"""

from __future__ import annotations

import builtins
import importlib.util
import os
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from copy import copy
from functools import cache
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from types import CodeType, ModuleType
from typing import TYPE_CHECKING, Any

from cfepy.nodes import module_origins as sharing
from cfepy.nodes.made_modules import proxy
from cfepy.nodes.node_sources import code_of_file, code_of_library
from cfepy.rtos import WaitList

if TYPE_CHECKING:
    from cfepy.nodes.accesses import Accesses
    from cfepy.nodes.universe import Universe
    from cfepy.rtos import Kernel, Task

_RUN = "__run__"
Factory = Callable[["Universe"], ModuleType]
ShownNames = Callable[[str], Mapping[str, str] | None]
_WHERE = "(put its source near the node or on ROS_PACKAGE_PATH, or install it into the Python that cfepy runs in)"


class LateModule(ModuleType):
    """A module before its code has run."""

    def __getattr__(self, name: str) -> Any:
        if name == "__path__":  # requested of every module that something is loaded from; a package is never lazy
            raise AttributeError(f"module {self.__name__!r} has no attribute {name!r}")
        _wake(self)
        return getattr(self, name)

    def __setattr__(self, name: str, value: Any) -> None:
        _wake(self)
        setattr(self, name, value)

    def __delattr__(self, name: str) -> None:
        _wake(self)
        delattr(self, name)

    def __dir__(self) -> list[str]:
        _wake(self)
        return dir(self)


def postpone(module: ModuleType, run: Callable[[], object]) -> ModuleType:
    """Delay the execution of a module's code until its first use.

    Args:
        module: a new module.
        run: executes its code.
    """
    vars(module)[_RUN] = run
    module.__class__ = LateModule
    return module


def show_only(module: ModuleType, shown: Mapping[str, str], load: Callable[[str], ModuleType]) -> None:
    """Let a module show some names only. Its own code finds the others among its builtins.

    Args:
        module: the module.
        shown: the names, and where those are from that the module does not define.
        load: imports a module.
    """
    names = vars(module)
    for name in [name for name in names if not (name.startswith("_") or name in shown or _is_part(module, name))]:
        names.setdefault("__builtins__", {})[name] = names.pop(name)
    private = f"{module.__name__.partition('.')[0]}._"
    for name, home in shown.items():
        if not home and str(getattr(names.get(name), "__module__", "")).startswith(private):
            names[name].__module__ = module.__name__  # a class or function of a private module
    late = {name: home for name, home in shown.items() if home and name not in names}
    if late:
        _add_late_names(module, late, load)


def _is_part(module: ModuleType, name: str) -> bool:
    """Return whether a name of a module is its submodule; a package shows it as soon as any program imports it."""
    part = vars(module)[name]
    return isinstance(part, ModuleType) and part.__name__ == f"{module.__name__}.{name}"


def _add_late_names(module: ModuleType, late: Mapping[str, str], load: Callable[[str], ModuleType]) -> None:
    """Give a module names from other modules, which are imported when the name is first needed."""
    names = vars(module)
    own = names.get("__getattr__")

    def find(name: str) -> Any:
        if name not in late:
            if own is not None:
                return own(name)
            raise AttributeError(f"module {module.__name__!r} has no attribute {name!r}")
        names[name] = value = imported(late[name], load, module.__name__)
        return value

    names["__getattr__"] = find
    names["__dir__"] = lambda: sorted({*names, *late})


def imported(home: str, load: Callable[[str], ModuleType], user: str) -> Any:
    """Return a module, or a name of a module.

    Args:
        home: "module" or "module:name".
        load: imports a module.
        user: the module that shows it.

    Raises:
        AttributeError: it is not available.
    """
    owner, _, name = home.partition(":")
    try:
        module = load(owner)
        return getattr(module, name) if name else module
    except (ImportError, AttributeError) as error:
        raise AttributeError(f"module {user!r} has no attribute {name or owner!r}") from error


def _wake(module: ModuleType) -> None:
    """Run the module's code; meanwhile it is an ordinary module."""
    run = vars(module).pop(_RUN)
    object.__setattr__(module, "__class__", ModuleType)
    try:
        run()
    except BaseException:
        postpone(module, run)
        raise


class ImportLocks:
    """Modules that threads are executing.

    Args:
        kernel: kernel of the importing tasks.
    """

    def __init__(self, kernel: Kernel) -> None:
        self._kernel = kernel
        self._loading: dict[str, tuple[Task, WaitList]] = {}
        self._waiting: dict[Task, str] = {}

    @property
    def busy(self) -> bool:
        """Whether any module is being executed now."""
        return bool(self._loading)

    @contextmanager
    def loading(self, name: str) -> Iterator[None]:
        """Mark the module `name` as being executed by the current task."""
        waits = WaitList(f"the import of {name}")
        self._loading[name] = self._kernel.current, waits
        try:
            yield
        finally:
            del self._loading[name]
            if waits:
                self._kernel.wake_all(waits)

    def wait_for(self, name: str) -> None:
        """Wait until no other task is executing the module `name`."""
        current = self._kernel.current
        entry = self._loading.get(name)
        if entry is None or current is self._kernel.host or self._is_circular(entry[0]):
            return
        self._waiting[current] = name
        try:
            self._kernel.wait_on(entry[1])
        finally:
            del self._waiting[current]

    def _is_circular(self, loader: Task) -> bool:
        """Return whether `loader` is, or waits for, the current task."""
        current: Task | None = loader
        while current is not None and current is not self._kernel.current:
            name = self._waiting.get(current)
            entry = self._loading.get(name) if name is not None else None
            current = entry[0] if entry is not None else None
        return current is not None


class Importer:
    """Finds and executes the modules of one universe.

    Args:
        universe: universe of the modules.
        folders: the node's own folders, searched first.
        libraries: folders of packages that are executed for each node, searched next.
        fallbacks: folders that are searched last.
        ordered: whether set displays in the node's code make ordered sets.
        provision: replacements for the host's modules.
        find_factory: looks up names for which the provision has no factory; None if it does not know the name.
        shown_names: returns the public names that a module of a library shows, each with the module that it is from,
            or "module:name", or "" if it is the module's own; None if a module shows all that it has.
        accesses: where the accesses of the node's own code are reported; None for no reports.
    """

    def __init__(
        self,
        universe: Universe,
        *,
        folders: Sequence[str],
        libraries: Sequence[str],
        fallbacks: Sequence[str],
        ordered: bool,
        provision: sharing.Provision,
        find_factory: Callable[[str], Factory | None],
        shown_names: ShownNames,
        accesses: Accesses | None = None,
    ) -> None:
        self.modules: dict[str, ModuleType] = {}
        self.path: list[str] = [*folders, *libraries, *sys.path]
        self._universe = universe
        self._ordered = ordered
        self._own = frozenset(folders)
        self._libraries = list(libraries)
        self._fallbacks = list(fallbacks)
        self._hosts = frozenset((*libraries, *sys.path))
        self._provision = provision
        self._find_factory = find_factory
        self._shown_names = shown_names
        self._accesses = accesses if accesses is not None and accesses.is_on else None
        self._shared: set[str] = set()
        self._locks = ImportLocks(universe.kernel)

    # -- called by the node --------------------------------------------------------------------------------------------

    def import_name(
        self,
        name: str,
        globals: Mapping[str, Any] | None = None,
        locals: Mapping[str, Any] | None = None,
        fromlist: Sequence[str] | None = (),
        level: int = 0,
    ) -> ModuleType:
        """`__import__`, called by every import statement of the node."""
        if level:
            name = _absolute(name, globals or {}, level)
        module = self.modules.get(name)
        if module is None or self._locks.busy:
            module = self.load(name)
        if not fromlist:
            return self.modules[name.partition(".")[0]] if "." in name else module
        if hasattr(module, "__path__"):
            self._import_parts(module, name, fromlist)
        return module

    def import_module(self, name: str, package: str | None = None) -> ModuleType:
        """`importlib.import_module`."""
        level = len(name) - len(name.lstrip("."))
        if not level:
            return self.load(name)
        if not package:
            raise TypeError(f"the 'package' argument is required to perform a relative import for {name!r}")
        return self.load(_absolute(name[level:], {"__package__": package}, level))

    def reload(self, module: ModuleType) -> ModuleType:
        """`importlib.reload`."""
        spec = module.__spec__
        if spec is None or spec.origin is None or module.__name__ in self._shared:
            raise ImportError(f"{module.__name__} cannot be reloaded in a node")
        self._execute(module, spec, self._is_own(spec.origin))
        return module

    def find_spec(self, name: str, package: str | None = None) -> ModuleSpec | None:
        """`importlib.util.find_spec`."""
        if self._factory(name) is not None:
            return ModuleSpec(name, None)
        parent = name.rpartition(".")[0]
        if parent:
            folders = getattr(self.load(parent), "__path__", None)
            return None if folders is None else PathFinder.find_spec(name, list(folders))
        return PathFinder.find_spec(name, self._node_folders() + self._libraries) or importlib.util.find_spec(name)

    def has_own(self, name: str) -> bool:
        """Return whether the node's own folders have the code of a module or package called `name`."""
        found = PathFinder.find_spec(name, self._node_folders())
        return found is not None and found.loader is not None

    # -- loading -----------------------------------------------------------------------------------------------------

    def load(self, name: str) -> ModuleType:
        """Return the module called `name`, from the table or newly loaded.

        Raises:
            ImportError: if there is none, or it is not available in a node.
        """
        self._locks.wait_for(name)
        module = self.modules.get(name)
        if module is not None:
            return module
        parent, _, child = name.rpartition(".")
        package = self.load(parent) if parent else None
        if name in self.modules:
            return self.modules[name]
        if self._is_shared(parent) and self._factory(name) is None:
            return self._share(name, package)
        module = self._load_own(name, package)
        if package is not None:
            setattr(package, child, module)
        return module

    def load_standard(self, name: str) -> ModuleType:
        """Return a module of the standard library, for factories that build on it."""
        module = self.modules.get(name)
        return self._from_spec(_library_spec(name), own=False) if module is None else module

    def load_file(self, name: str, file: str, folder: str | None = None) -> ModuleType:
        """Execute a source file as the module `name` of this universe, for factories of whole packages.

        Args:
            name: the full module name.
            file: the source file.
            folder: for a package, the folder of its submodules.
        """
        locations = None if folder is None else [folder]
        loader = SourceFileLoader(name, file)
        spec = importlib.util.spec_from_file_location(name, file, loader=loader, submodule_search_locations=locations)
        if spec is None:
            raise ImportError(f"{file} is not a Python source file", name=name)
        return self._from_spec(spec, own=False)

    def _load_own(self, name: str, package: ModuleType | None) -> ModuleType:
        factory = self._factory(name)
        if factory is not None:
            module = factory(self._universe)
            self.modules[name] = module
            return module
        if package is None:
            return self._load_top(name)
        folders = getattr(package, "__path__", None)
        if folders is None:
            raise ModuleNotFoundError(f"No module named {name!r}; {package.__name__!r} is not a package", name=name)
        if name in sharing.HOST_SUBMODULES:
            return self._share(name, package)
        spec = PathFinder.find_spec(name, list(folders)) or self._library_part(name)
        if spec is None:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)
        return self._from_spec(spec, self._is_own(spec.origin))

    def _library_part(self, name: str) -> ModuleSpec | None:
        """Return a submodule that the node's own copy of a library lacks, such as the compiled part of an unbuilt
        source.
        """
        *packages, _ = name.split(".")
        return PathFinder.find_spec(name, [os.path.join(folder, *packages) for folder in self._libraries])

    def _load_top(self, name: str) -> ModuleType:
        found = PathFinder.find_spec(name, self._node_folders())
        if found is not None and found.loader is not None:
            return self._from_spec(found, own=True)
        library = PathFinder.find_spec(name, self._libraries)
        if library is not None and library.loader is not None:
            return self._from_spec(library, own=False)
        if sharing.is_stdlib(name):
            if not self._provision.executes(name):
                return self._share(name)
            standard = _library_spec(name)
            return self._late(standard) if name in sharing.LATE else self._from_spec(standard, own=False)
        if name in sharing.HOST_PACKAGES:
            return self._share(name)
        spec = importlib.util.find_spec(name) or found  # a folder of the node without code comes last, as in Python
        spec = spec or PathFinder.find_spec(name, self._fallbacks)
        if spec is None:
            error = ModuleNotFoundError(f"No module named {name!r}", name=name)
            error.add_note(_WHERE)
            raise error
        return self._from_spec(spec, own=False) if self._provision.executes_package(spec) else self._share(name)

    def _from_spec(self, spec: ModuleSpec, own: bool) -> ModuleType:
        """Return a module from a file; it is added to the table and its package before its code runs."""
        name = spec.name
        module = _empty_module(spec)
        if spec.origin is not None:
            module.__file__ = self._universe.shown(spec.origin)
        self.modules[name] = module
        parent, _, child = name.rpartition(".")
        if parent:
            setattr(self.modules[parent], child, module)
        try:
            self._execute(module, spec, own)
        except BaseException:
            self.modules.pop(name, None)
            if parent:
                vars(self.modules[parent]).pop(child, None)
            raise
        fix = self._provision.fixes.get(name)
        if fix is not None and not own:
            fix(self._universe, module)
        return self.modules.get(name, module)

    def _late(self, spec: ModuleSpec) -> ModuleType:
        """Return a module of the standard library whose code runs on first use."""

        def run() -> None:
            self._execute(module, spec, own=False)
            fix = self._provision.fixes.get(spec.name)
            if fix is not None:
                fix(self._universe, module)

        module = self.modules[spec.name] = postpone(_empty_module(spec), run)
        return module

    def _execute(self, module: ModuleType, spec: ModuleSpec, own: bool) -> None:
        if spec.origin is None:
            return  # a namespace package has no code
        if own:
            if not isinstance(spec.loader, SourceFileLoader) or spec.origin is None:
                raise ImportError(f"{spec.name}: a node's own module must be a Python source file, not {spec.origin}")
            code = self.own_code(spec.origin, self._universe.shown(spec.origin))
        else:
            code = code_of_library(spec)
        shown = None if own else self._shown_names(spec.name)
        known = vars(self._universe.builtins)
        vars(module)["__builtins__"] = known if shown is None else self._universe.builtins.copy_for_library()
        with self._locks.loading(spec.name):
            if own and self._accesses is not None:
                self._accesses.adopt(vars(module))
                with self._accesses.loading():
                    exec(code, vars(module))
            else:
                exec(code, vars(module))
        if shown is not None:
            show_only(module, shown, self.load)

    def own_code(self, file: str, name: str, is_main: bool = False) -> CodeType:
        """Return the code of a source file of the node; see `code_of_file` for the errors.

        Args:
            file: the file.
            name: file name that the code sees.
            is_main: whether it is the node's script.
        """
        kinds = None if self._accesses is None else self._accesses.kinds(name, is_main)
        return code_of_file(file, self._ordered, name, kinds)

    def _is_shared(self, package: str) -> bool:
        """Return whether the modules in a package are shared with the host."""
        return package in self._shared or package.partition(".")[0] in sharing.HOST_BELOW

    def _share(self, name: str, package: ModuleType | None = None) -> ModuleType:
        """Return the host's own module, or a copy of its names if changes by the node must not affect others."""
        builtins.__import__(name)
        module = sys.modules[name]
        if self._provision.copies(name):
            module = proxy(module)
            if package is not None:
                setattr(package, name.rpartition(".")[2], module)
        self.modules[name] = module
        self._shared.add(name)
        return module

    # -- finding -----------------------------------------------------------------------------------------------------

    def _factory(self, name: str) -> Factory | None:
        return self._provision.factories.get(name) or self._find_factory(name)

    def _node_folders(self) -> list[str]:
        """Return the folders of the search path that belong to the node or were added by it."""
        return [
            place
            for folder in self.path
            if isinstance(folder, str) and (folder in self._own or folder not in self._hosts)
            for place in self._universe.places(folder)
        ]

    def _is_own(self, origin: str | None) -> bool:
        """Return whether a file belongs to the node, and not to the standard library or an installed package."""
        return origin is not None and origin.startswith(tuple(os.path.join(f, "") for f in self._node_folders()))

    def _import_parts(self, module: ModuleType, name: str, parts: Sequence[str]) -> None:
        """`from package import part`: load those parts that are modules."""
        for part in parts:
            if part == "*":
                self._import_parts(module, name, getattr(module, "__all__", ()))
            elif not hasattr(module, part):
                full = f"{name}.{part}"
                try:
                    self.load(full)
                except ModuleNotFoundError as error:
                    if error.name != full:
                        raise


def _library_spec(name: str) -> ModuleSpec:
    """Return the spec of a standard library module with its source file; some are frozen into the interpreter."""
    spec = copy(_found_in_library(name))
    if spec.submodule_search_locations is not None:
        spec.submodule_search_locations = list(spec.submodule_search_locations)
    return spec


@cache
def _found_in_library(name: str) -> ModuleSpec:
    """Return the spec, cached because the standard library does not change."""
    spec = PathFinder.find_spec(name, [os.path.dirname(os.__file__)])
    if spec is None:
        raise ModuleNotFoundError(f"No module named {name!r}", name=name)
    return spec


def _empty_module(spec: ModuleSpec) -> ModuleType:
    module = ModuleType(spec.name)
    names = vars(module)
    names.update(__spec__=spec, __loader__=spec.loader, __package__=spec.parent, __file__=spec.origin)
    if spec.cached is not None:
        names["__cached__"] = spec.cached
    if spec.submodule_search_locations is not None:
        names["__path__"] = spec.submodule_search_locations
    return module


def _absolute(name: str, names: Mapping[str, Any], level: int) -> str:
    """Return the full name that a relative import means."""
    package = names.get("__package__")
    if package is None:
        package = names.get("__name__", "")
        if "__path__" not in names:
            package = package.rpartition(".")[0]
    if not package:
        raise ImportError("attempted relative import with no known parent package")
    parts = package.rsplit(".", level - 1)
    if len(parts) < level:
        raise ImportError("attempted relative import beyond top-level package")
    return f"{parts[0]}.{name}" if name else str(parts[0])
