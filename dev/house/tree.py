"""The source text of a checkout as modules: imports, classes and functions, found without running anything.

All imports count: those at the top, those inside functions, those for type checkers only, and those by a name given to
`import_module` or `__import__`. Templates of `cfepy new` are not modules. Code of ROS nodes (`NODE_CODE`) is kept
apart, because other rules hold for it.
"""

from __future__ import annotations

import ast
import functools
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

ROOT = Path(__file__).parents[2]
TOPS = ("cfepy", "rospy_shim", "rclpy_shim", "ros_libraries", "apps")
NODE_CODE = (
    "ros_libraries",
    "rclpy_shim/libraries",
    "rospy_shim/rospy_modules",
    "rospy_shim/roslaunch/tools",
    "rospy_shim/stand_ins",
)
IMPORTERS = ("import_module", "__import__")

When = Literal["at once", "late", "for types", "by name"]


@dataclass(frozen=True)
class Import:
    """One imported name: in full, the module of the tree that has it ("" for others), and how it is imported."""

    name: str
    module: str
    line: int
    when: When


@dataclass(frozen=True)
class Function:
    """A function or method: its name with the class before it, its first line, and its cyclomatic complexity."""

    name: str
    line: int
    complexity: int


class Module:
    """One file of source text."""

    def __init__(self, name: str, path: Path, root: Path) -> None:
        self.name = name
        self.path = path
        self.where = str(path.relative_to(root))
        self.is_package = path.name == "__init__.py"
        self.text = path.read_text(encoding="utf-8")
        self.tree = ast.parse(self.text)
        self.lines = len(self.text.splitlines())
        self.imports: list[Import] = []
        self.unread: list[int] = []
        """Lines of calls of `import_module` whose argument is made at run time."""

    @property
    def part(self) -> str:
        """The package of cfepy that it belongs to, or its own name: sb, status, rospy_shim, apps, __init__.

        An add-on is a part of its own, as if it stood beside the others; so are the types of `rospy_shim`.
        """
        top, *rest = self.name.split(".")
        if top == "rospy_shim" and rest[:1] == ["types"]:
            return "types"
        if top != "cfepy":
            return top
        if rest[:1] == ["extra"] and len(rest) > 1:
            return rest[1]
        return rest[0] if rest else "__init__"

    @property
    def room(self) -> str:
        """The package of its part, by the name that it is imported by."""
        if self.part == "types":
            return "rospy_shim.types"
        top, *rest = self.name.split(".")
        depth = 2 if rest[:1] == ["extra"] and len(rest) > 1 else 1
        return ".".join((top, *rest[:depth])) if top == "cfepy" else top

    @property
    def offers(self) -> bool:
        """Whether it is a package that defines its public names."""
        return self.is_package and "__all__" in self.text

    @property
    def package(self) -> str:
        """The package that contains it, or itself if it is a package."""
        return self.name if self.is_package else self.name.rpartition(".")[0]

    @property
    def purpose(self) -> str:
        """The first sentence of its docstring."""
        text = " ".join((ast.get_docstring(self.tree) or "").split("\n\n")[0].split())
        end = text.find(". ")
        return text[: end + 1] if end >= 0 else text

    @property
    def head(self) -> int:
        """Lines up to the last import at the top: docstring, imports, those for type checkers."""
        ends = [_end(node) for node in self.tree.body[:1] if isinstance(node, ast.Expr)]
        for node in self.tree.body:
            if isinstance(node, ast.Import | ast.ImportFrom) or _is_type_checking(node):
                ends.append(_end(node))
        return max(ends, default=0)

    @property
    def classes(self) -> list[str]:
        """Public classes at the top."""
        found = [node.name for node in self.tree.body if isinstance(node, ast.ClassDef)]
        return [name for name in found if not name.startswith("_")]

    def functions(self) -> Iterator[Function]:
        """Yield all functions with their complexity. A nested function also counts for the enclosing one."""
        yield from _functions(self.tree.body, "")


class Tree:
    """All modules of a checkout, by name."""

    def __init__(self, root: Path = ROOT) -> None:
        self.root = root
        self.modules = self._read(of_nodes=False)

    @functools.cached_property
    def node_code(self) -> dict[str, Module]:
        """Modules that run as code of ROS nodes."""
        return self._read(of_nodes=True)

    def _read(self, of_nodes: bool) -> dict[str, Module]:
        found: dict[str, Module] = {}
        for path in (path for top in TOPS for path in sorted((self.root / top).rglob("*.py"))):
            inside = path.relative_to(self.root)
            if "templates" in inside.parts or any(map(inside.is_relative_to, NODE_CODE)) != of_nodes:
                continue
            name = ".".join(inside.with_suffix("").parts).removesuffix(".__init__")
            found[name] = Module(name, path, self.root)
        for module in found.values():
            _Imports(found, module).read()
        return found

    def arrows(self, module: Module) -> dict[str, list[Import]]:
        """Return the imports of a module within the tree, by imported module.

        `cfepy.__version__` belongs to no module.
        """
        found: dict[str, list[Import]] = {}
        for each in module.imports:
            if each.module in self.modules and each.module != module.name and each.name != "cfepy.__version__":
                found.setdefault(each.module, []).append(each)
        return found


@functools.cache
def the_tree(root: Path = ROOT) -> Tree:
    """Return the tree of a checkout, read once in a process."""
    return Tree(root)


class _Imports:
    """Collects the imports of a module."""

    def __init__(self, modules: Collection[str], module: Module) -> None:
        self._modules = modules
        self._module = module
        self._constants = {
            target.id: node.value.value
            for node in module.tree.body
            if isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant)
            for target in node.targets
            if isinstance(target, ast.Name) and isinstance(node.value.value, str)
        }

    def read(self) -> None:
        """Read all of them."""
        self._statements(self._module.tree.body, "at once")
        if any(name in self._module.text for name in IMPORTERS):
            self._names()

    def _statements(self, body: list[ast.stmt], when: When) -> None:
        for node in body:
            if isinstance(node, ast.Import):
                for alias in node.names:
                    self._add(alias.name, node.lineno, when)
            elif isinstance(node, ast.ImportFrom):
                self._from(node, when)
            else:
                inner: When = "for types" if _is_type_checking(node) else when
                if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                    inner = "late"
                for name in ("body", "orelse", "finalbody"):
                    self._statements(getattr(node, name, []), inner if name == "body" else when)
                for part in (*getattr(node, "handlers", []), *getattr(node, "cases", [])):
                    self._statements(part.body, when)

    def _from(self, node: ast.ImportFrom, when: When) -> None:
        base = node.module or ""
        if node.level:
            package = self._module.package.split(".")
            base = ".".join([*package[: len(package) - node.level + 1], *([node.module] if node.module else [])])
        for alias in node.names:
            self._add(f"{base}.{alias.name}", node.lineno, when)

    def _names(self) -> None:
        """Read names that are given to `import_module`, and tables from which one name is taken."""
        nodes = list(ast.walk(self._module.tree))
        calls = [node for node in nodes if isinstance(node, ast.Call) and node.args and _called(node) in IMPORTERS]
        for call in calls:
            name = self._text(call.args[0])
            if name and name.startswith("."):
                name = self._module.package + name
            if name is None:
                self._module.unread.append(call.lineno)
            else:
                self._add(name, call.lineno, "by name")
        named = {name for name in self._modules if "." in name}
        for node in nodes if calls else ():
            if isinstance(node, ast.Constant) and isinstance(node.value, str) and node.value in named:
                self._add(node.value, node.lineno, "by name")

    def _text(self, node: ast.expr) -> str | None:
        """Return a text that can be read off: a constant, a named one, or one put together from such."""
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            return node.value
        if isinstance(node, ast.Name):
            return self._module.name if node.id == "__name__" else self._constants.get(node.id)
        if isinstance(node, ast.JoinedStr):
            parts = [self._text(part.value if isinstance(part, ast.FormattedValue) else part) for part in node.values]
            made = "".join(part if part is not None else "*" for part in parts)
            return made if "*" not in made or made.startswith(f"{self._module.package}.") else None
        return None

    def _add(self, name: str, line: int, when: When) -> None:
        home = name
        while home and home not in self._modules:
            home = home.rpartition(".")[0]
        self._module.imports.append(Import(name, home, line, when))


def _called(call: ast.Call) -> str:
    return call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")


def _is_type_checking(node: ast.stmt) -> bool:
    return isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"


def _end(node: ast.stmt) -> int:
    return node.end_lineno or node.lineno


def _functions(body: list[ast.stmt], prefix: str) -> Iterator[Function]:
    for node in body:
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            yield Function(prefix + node.name, node.lineno, complexity(node))
            yield from _functions(node.body, f"{prefix}{node.name}.")
        elif isinstance(node, ast.ClassDef):
            yield from _functions(node.body, f"{prefix}{node.name}.")


def complexity(function: ast.AST) -> int:
    """McCabe's number: one, and one more for each branch, loop, handler, condition and case."""
    count = 1
    for node in ast.walk(function):
        if isinstance(node, ast.If | ast.IfExp | ast.For | ast.AsyncFor | ast.While | ast.ExceptHandler | ast.Assert):
            count += 1
        elif isinstance(node, ast.BoolOp):
            count += len(node.values) - 1
        elif isinstance(node, ast.comprehension):
            count += 1 + len(node.ifs)
        elif isinstance(node, ast.match_case):
            count += 1
    return count
