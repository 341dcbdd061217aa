"""`Points`: where code of a mission lets others run, besides the calls that it makes into cfepy.

lines                before each statement of a function
attributes           before each access to what several tasks may share
calls                after each call that came back from outside of the mission's code, too
attributes,arm,util  the same, in the modules arm and util alone
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import PurePath

from cfepy.status import UsageError

LINES, ATTRIBUTES, CALLS = "lines", "attributes", "calls"
_MODULE = re.compile(r"[\w.-]+")


@dataclass(frozen=True, slots=True)
class Points:
    """Where others may run.

    Args:
        kind: LINES, ATTRIBUTES or CALLS; empty for calls into cfepy alone, as ever.
        modules: names of the files that it is about, without their suffix; none for all.
    """

    kind: str = ""
    modules: tuple[str, ...] = ()

    @classmethod
    def parse(cls, text: str, field: str = "--points") -> Points:
        """The points that a text means; `:` may stand for the first comma.

        Args:
            text: see the module's; empty for none.
            field: what is to be named as wrong.

        Raises:
            UsageError: it means none.
        """
        if not text:
            return cls()
        kind, *modules = text.replace(":", ",").split(",")
        if kind not in (LINES, ATTRIBUTES, CALLS):
            raise UsageError(f"invalid kind of points {kind!r}; expected lines, attributes or calls", field=field)
        wrong = next((each for each in modules if _MODULE.fullmatch(each) is None), None)
        if wrong is not None:
            raise UsageError(f"invalid module {wrong!r}; write for instance {kind}:arm,util", field=field)
        return cls(kind, tuple(dict.fromkeys(each.removesuffix(".py") for each in modules)))

    def text(self) -> str:
        """The text that `parse` gives these points for; empty for none."""
        return ",".join((self.kind, *self.modules))

    def cover(self, file: str) -> bool:
        """Whether they are in a source file."""
        if not self.kind or not self.modules:
            return bool(self.kind)
        path = PurePath(file)
        return path.stem in self.modules or (path.stem == "__init__" and path.parent.name in self.modules)
