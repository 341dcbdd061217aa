"""`Points`: places where mission code can be preempted, in addition to its calls into cfepy.

lines                before each statement of a function
attributes           before each access to data that several tasks may share
calls                after each call that returns from code outside the mission too
attributes,arm,util  the same, only in the modules arm and util
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import PurePath

from cfepy.reading.suggestions import expected
from cfepy.status import UsageError

LINES, ATTRIBUTES, CALLS = "lines", "attributes", "calls"
_MODULE = re.compile(r"[\w.-]+")


@dataclass(frozen=True, slots=True)
class Points:
    """The places where other tasks may run.

    Args:
        kind: LINES, ATTRIBUTES or CALLS; empty for calls into cfepy only.
        modules: names of the files concerned, without their suffix; empty for all.
    """

    kind: str = ""
    modules: tuple[str, ...] = ()

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
        kinds = (LINES, ATTRIBUTES, CALLS)
        if kind not in kinds:
            raise UsageError(f"invalid kind of points {kind!r}; {expected(kind, kinds)}", field=field)
        wrong = next((each for each in modules if _MODULE.fullmatch(each) is None), None)
        if wrong is not None:
            raise UsageError(f"invalid module {wrong!r}; write for instance {kind}:arm,util", field=field)
        return cls(kind, tuple(dict.fromkeys(each.removesuffix(".py") for each in modules)))

    def text(self) -> str:
        """Return the text from which `parse` makes these points; empty for none."""
        return ",".join((self.kind, *self.modules))

    def cover(self, file: str) -> bool:
        """Return whether a source file has points."""
        if not self.kind or not self.modules:
            return bool(self.kind)
        path = PurePath(file)
        return path.stem in self.modules or (path.stem == "__init__" and path.parent.name in self.modules)
