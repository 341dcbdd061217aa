"""`Points`: places where mission code can be preempted, in addition to its calls into cfepy.

lines                before each statement of a function
attributes           before each access to data that several tasks may share
calls                after each call that returns from code outside the mission too
attributes,arm,util  the same, only in the modules arm and util; a package stands for its modules
shared,total,goals   as attributes, but only at attributes, variables and containers with these names
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from cfepy.reading.suggestions import expected
from cfepy.status import UsageError

LINES, ATTRIBUTES, CALLS, SHARED = "lines", "attributes", "calls", "shared"
_MODULE = re.compile(r"[\w.-]+")
_OBJECT = re.compile(r"[\w.]+")


@dataclass(frozen=True, slots=True)
class Points:
    """The places where other tasks may run.

    Args:
        kind: LINES, ATTRIBUTES, CALLS or SHARED; empty for calls into cfepy only.
        modules: names of the files concerned, without their suffix, and of packages; empty for all, and for SHARED.
        names: for SHARED, the names of attributes, variables and containers, as `name_of` returns them.
    """

    kind: str = ""
    modules: tuple[str, ...] = ()
    names: tuple[str, ...] = ()

    @classmethod
    def parse(cls, text: str, field: str = "--points") -> Points:
        """Return the points for a text; `:` may replace the first comma.

        Args:
            text: see the module; empty for none.
            field: the field to name in errors.

        Raises:
            UsageError: if the text is invalid.
        """
        if not text:
            return cls()
        kind, *modules = text.replace(":", ",").split(",")
        kinds = (LINES, ATTRIBUTES, CALLS, SHARED)
        if kind not in kinds:
            raise UsageError(f"invalid kind of points {kind!r}; {expected(kind, kinds)}", field=field)
        wrong = next((each for each in modules if _MODULE.fullmatch(each) is None), None)
        if wrong is not None:
            raise UsageError(f"invalid module {wrong!r}; write for instance {kind}:arm,util", field=field)
        if kind != SHARED:
            return cls(kind, tuple(dict.fromkeys(each.removesuffix(".py") for each in modules)))
        if not modules:
            raise UsageError("missing names; write for instance shared:total,goals", field=field)
        return cls(kind, names=tuple(dict.fromkeys(modules)))

    def text(self) -> str:
        """Return the text from which `parse` makes these points; empty for none."""
        return ",".join((self.kind, *self.modules, *self.names))

    def cover(self, file: str) -> bool:
        """Return whether a source file has points."""
        if not self.kind or not self.modules:
            return bool(self.kind)
        return not source_names(file).isdisjoint(self.modules)

    @property
    def are_at_accesses(self) -> bool:
        """Whether the places are accesses to data."""
        return self.kind in (ATTRIBUTES, SHARED)

    def unmatched(self, files: Iterable[str]) -> list[str]:
        """Return the modules that are in none of some source files."""
        known = {name for file in files for name in source_names(file)}
        return [name for name in self.modules if name not in known]


def name_of(text: str) -> str:
    """Return the name that stands for accesses to an object, from the text of the access.

    Args:
        text: such as `Arm.position`, `self.goals`, or `self.goals['x']`; the last two have the name `goals`.
    """
    found = _OBJECT.search(text)
    return "" if found is None else found[0].rpartition(".")[2]


def source_names(file: str) -> frozenset[str]:
    """Return the names that stand for a source file: its module, and the packages that it is in."""
    path = Path(file)
    names = set() if path.stem == "__init__" else {path.stem}
    for folder in path.parents:
        if not (folder / "__init__.py").is_file():
            break
        names.add(folder.name)
    return frozenset(names)
