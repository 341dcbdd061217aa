"""Figures of the architecture: sizes of packages, dependencies between them, and names that stand for two things."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from typing import NamedTuple

from dev.house.floors import wrong_arrows
from dev.house.tree import Import, Module, Tree

NAMES_OF_NODES: dict[str, str] = {
    "Duration": "genpy's and rospy's",
    "Time": "genpy's and rospy's",
}
"""Class names that ROS fixes, so that they may stand for more than one thing."""


FREE_NAMES = {"events", "packets", "task", "service", "commands", "app", "tables"}
"""Names of modules that mean the same in each service and application."""


class Face(NamedTuple):
    """Imports across packages of cfepy: past the face of the other, and through it."""

    past: int
    through: int


class Room(NamedTuple):
    """A package: its files, their lines, and how many of the lines are docstrings and imports at the head."""

    name: str
    files: int
    lines: int
    head: int


def of_cfepy(tree: Tree) -> list[Module]:
    """Return the modules of cfepy itself."""
    return [module for name, module in tree.modules.items() if name.partition(".")[0] == "cfepy"]


def rooms(tree: Tree) -> list[Room]:
    """Return the packages by name. The modules beside them count as one package."""
    found: dict[str, list[Module]] = {}
    for module in tree.modules.values():
        is_inside = module.room in tree.modules and tree.modules[module.room].is_package and module.room != "cfepy"
        name = module.room.replace(".", "/") if is_inside or module.room == "apps" else "cfepy/*.py"
        found.setdefault(name, []).append(module)
    return [
        Room(name, len(those), sum(each.lines for each in those), sum(each.head for each in those))
        for name, those in sorted(found.items())
    ]


def faces(tree: Tree) -> Face:
    """Return how many pairs of modules of cfepy meet past the face of a package, and how many through it."""
    past = through = 0
    for module in of_cfepy(tree):
        for name in tree.arrows(module):
            target = tree.modules[name]
            if target.name.partition(".")[0] != "cfepy" or target.part == module.part:
                continue
            face = tree.modules.get(target.room)
            if face is not None and face.offers:
                past += name != face.name
                through += name == face.name
    return Face(past, through)


def past_faces(tree: Tree) -> Counter[str]:
    """Count the modules imported directly instead of from their package, by number of importers."""
    found: Counter[str] = Counter()
    for module in of_cfepy(tree):
        for name in (each for each in tree.arrows(module) if each.startswith("cfepy.")):
            target = tree.modules[name]
            face = tree.modules.get(target.room)
            if face is not None and face.offers and name != face.name and target.part != module.part:
                found[name] += 1
    return found


def users(tree: Tree) -> dict[str, set[str]]:
    """Return each module with those that import it."""
    found: dict[str, set[str]] = {name: set() for name in tree.modules}
    for module in tree.modules.values():
        for name in tree.arrows(module):
            found[name].add(module.name)
    return found


def with_one_user(tree: Tree) -> list[Module]:
    """Return the modules of cfepy that exactly one other imports, a module of the same package.

    Packages do not count as modules, and modules that run as programs are excluded.
    """
    imported = users(tree)
    found = []
    for module in of_cfepy(tree):
        if len(imported[module.name]) == 1 and not module.is_package and "__main__" not in module.text:
            user = tree.modules[next(iter(imported[module.name]))]
            if user.part == module.part and not user.is_package:
                found.append(module)
    return found


def circles(tree: Tree, for_types: bool = False) -> list[list[str]]:
    """Return groups of modules that import each other in a circle, largest first.

    Those that exist for type checkers alone are left out, unless they are asked for: then they are all there is.
    """
    running = _circles(tree, lambda imports: any(each.when != "for types" for each in imports))
    return [each for each in _circles(tree, lambda _: True) if each not in running] if for_types else running


def _circles(tree: Tree, counts: Callable[[list[Import]], bool]) -> list[list[str]]:
    arrows = {
        name: sorted(target for target, imports in tree.arrows(module).items() if counts(imports))
        for name, module in tree.modules.items()
    }
    found = [sorted(group) for group in _strongly_connected(arrows) if len(group) > 1]
    return sorted(found, key=lambda group: (-len(group), group))


def _strongly_connected(arrows: dict[str, list[str]]) -> Iterator[list[str]]:
    """Tarjan's algorithm, without recursion."""
    number: dict[str, int] = {}
    low: dict[str, int] = {}
    stack: list[str] = []
    for root in arrows:
        work = [(root, iter(arrows[root]))] if root not in number else []
        while work:
            name, rest = work[-1]
            if name not in number:
                number[name] = low[name] = len(number)
                stack.append(name)
            for other in rest:
                if other not in number:
                    work.append((other, iter(arrows[other])))
                    break
                if other in stack:
                    low[name] = min(low[name], number[other])
            else:
                work.pop()
                if work:
                    low[work[-1][0]] = min(low[work[-1][0]], low[name])
                if low[name] == number[name]:
                    at = stack.index(name)
                    yield stack[at:]
                    del stack[at:]


def by_name(tree: Tree) -> list[tuple[str, str]]:
    """Return dependencies hidden in a string: modules of cfepy that load a module of another package by its name."""
    return sorted(
        (module.name, each.name)
        for module in of_cfepy(tree)
        for each in module.imports
        if each.when == "by name" and each.module and tree.modules.get(each.module, module).part != module.part
    )


def names_twice(tree: Tree) -> dict[str, list[str]]:
    """Return public classes at the top of modules that have the same name, with the modules."""
    found: dict[str, list[str]] = {}
    for module in tree.modules.values():
        for name in module.classes:
            found.setdefault(name, []).append(module.name)
    return {name: places for name, places in sorted(found.items()) if len(places) > 1}


def modules_named_twice(tree: Tree) -> dict[str, list[str]]:
    """Return names that stand for two modules or packages, with their locations.

    Excluded are `FREE_NAMES`, and three patterns whose location makes the meaning clear: the module of a command,
    which has its name; the parts of the API in C, which are named like the packages; a package and its central module.
    """
    found: dict[str, list[str]] = {}
    for name, module in tree.modules.items():
        parts = name.split(".")
        last = parts[-1]
        is_command = "commands" in parts or (parts[:2] == ["cfepy", "cli"] and (module.is_package or len(parts) == 4))
        is_part_of_api = name.startswith("cfepy.extra.c.api.")
        is_central = len(parts) > 1 and parts[-2] == last
        if last not in FREE_NAMES and not (is_command or is_part_of_api or is_central):
            found.setdefault(last, []).append(module.where)
    return {name: places for name, places in sorted(found.items()) if len(places) > 1}


def class_names(tree: Tree) -> int:
    """Return how many names of public classes there are."""
    return len({name for module in tree.modules.values() for name in module.classes})


def most_complex(tree: Tree, count: int = 10) -> list[tuple[int, str]]:
    """Return the functions of highest complexity, with where they are."""
    found = [
        (function.complexity, f"{module.where}:{function.name}")
        for module in tree.modules.values()
        for function in module.functions()
    ]
    return sorted(found, key=lambda pair: (-pair[0], pair[1]))[:count]


def offered(tree: Tree) -> list[str]:
    """Return the names that `import cfepy` offers: `__all__`, or else the names that its module binds."""
    names: list[str] = []
    for node in tree.modules["cfepy"].tree.body:
        if not isinstance(node, ast.Assign | ast.AnnAssign) or node.value is None:
            continue
        for target in node.targets if isinstance(node, ast.Assign) else [node.target]:
            if isinstance(target, ast.Name) and target.id == "__all__" and isinstance(node.value, ast.List | ast.Tuple):
                return [element.value for element in node.value.elts if isinstance(element, ast.Constant)]  # type: ignore[misc]
            if isinstance(target, ast.Name) and (not target.id.startswith("_") or target.id == "__version__"):
                names.append(target.id)
    return names


def entries(tree: Tree) -> list[str]:
    """Return the modules and packages right below `cfepy/`."""
    return sorted({name.split(".")[1] for name in tree.modules if name.startswith("cfepy.")})


ABOUT_IMPORTS = re.compile(
    r"\b(imports? (only|nothing|no[nt]|every)|imports? [^.]{0,60} only|(may|must not|can) import)",
    re.IGNORECASE,
)


def sentences_about_imports(tree: Tree) -> list[str]:
    """Return the modules whose docstring lists imports, which the rule of the floors already covers."""
    return [
        module.name
        for module in tree.modules.values()
        if ABOUT_IMPORTS.search(" ".join((ast.get_docstring(module.tree) or "").split()))
    ]


def table(rows: Iterable[tuple[object, ...]], *titles: str) -> str:
    """Return a table in Markdown."""
    lines = [titles, *(("---",) * len(titles),), *rows]
    return "".join(f"| {' | '.join(str(cell) for cell in line)} |\n" for line in lines)


def report(tree: Tree) -> str:
    """Return all figures as Markdown."""
    modules = of_cfepy(tree)
    lines = sum(module.lines for module in modules)
    head = sum(module.head for module in modules)
    alone = with_one_user(tree)
    face = faces(tree)
    rings, of_types = circles(tree), circles(tree, for_types=True)
    hidden = by_name(tree)
    twice = names_twice(tree)
    told = sentences_about_imports(tree)
    named_twice = modules_named_twice(tree)
    longest = sorted(modules, key=lambda module: -module.lines)[:5]
    what = [
        ("files and lines in `cfepy`", f"{len(modules):,}; {lines:,}"),
        ("head (docstring and imports) of all lines", f"{100 * head / lines:.1f} %"),
        ("modules imported by exactly one sibling", f"{len(alone)} ({sum(each.lines for each in alone):,} lines)"),
        ("files below 60 lines, above 600", f"{_below(modules, 60)}, {sum(each.lines > 600 for each in modules)}"),
        ("longest", ", ".join(f"`{each.where}` {each.lines}" for each in longest)),
        ("imports past a package's face; through it", f"{face.past}; {face.through}"),
        ("circles of imports, lazy ones included", "; ".join((str(len(rings)), *map(_ring, rings)))),
        ("circles for type checkers alone", "; ".join((str(len(of_types)), *map(_ring, of_types)))),
        ("imports up or of a peer", len(list(wrong_arrows(tree)))),
        ("imports of other packages by name", f"{len(hidden)}, not readable: {_unread(tree)}"),
        ("public class names that stand for two things", f"{len(twice)} of {class_names(tree)}: {', '.join(twice)}"),
        ("names that stand for two modules", f"{len(named_twice)}: {', '.join(named_twice)}"),
        ("entries of `cfepy/`", len(entries(tree))),
        ("what `import cfepy` offers", f"{len(offered(tree))}: {', '.join(offered(tree))}"),
        ("module heads that say what is imported", len(told)),
    ]
    return "\n".join(
        (
            table(what, "what", "figure"),
            table(
                ((f"`{each.name}`", each.files, f"{each.lines:,}") for each in rooms(tree)), "room", "files", "lines"
            ),
            table(((f"`{where}`", number) for number, where in most_complex(tree)), "function", "complexity"),
        )
    )


def _below(modules: list[Module], lines: int) -> int:
    return sum(module.lines < lines and not module.is_package for module in modules)


def _ring(names: list[str]) -> str:
    return f"{len(names)}: {', '.join(names[:6])}{' ...' if len(names) > 6 else ''}"


def _unread(tree: Tree) -> int:
    return sum(len(module.unread) for module in tree.modules.values())
