"""The results of a mission that must not depend on the schedule: the section `results` of a mission file.

`cfepy explore` compares them with the results under the default schedule.
docs/how_to/explore_schedules.md describes them.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

from cfepy.reading.marked_yaml import Marked, Mistakes
from cfepy.status import UsageError

LAST, SEQUENCE, ANY_ORDER, COUNT = "last", "sequence", "any order", "count"
FILE, OUTPUT = "file", "output"
OF_MESSAGES = (LAST, SEQUENCE, ANY_ORDER, COUNT)
COMPARISONS = (*OF_MESSAGES, FILE, OUTPUT)
TIMES = ("header.stamp", "header.seq")
"""Left out of messages unless `ignore` says otherwise: a few microseconds more or less are no other result."""


@dataclass(frozen=True, slots=True)
class SelectedResult:
    """A result.

    Attributes:
        name: a topic, a packet of the dictionary or MsgId, a file of the mission, or an application's name.
        compare: one of COMPARISONS.
        ignore: fields of messages that may differ, as paths such as "header.stamp"; in nested messages, too.
    """

    name: str
    compare: str
    ignore: tuple[str, ...] = TIMES

    @property
    def is_of_packet(self) -> bool:
        """Whether its messages are packets of the dictionary, not those of a topic."""
        return self.compare in OF_MESSAGES and not self.name.startswith(("/", "*"))


def read_selected_results(section: Marked, mistakes: Mistakes) -> tuple[SelectedResult, ...]:
    """The section `results:`, without those that are wrong.

    Args:
        section: its value.
        mistakes: takes an unknown field or comparison.
    """
    entries = mistakes.mapping(section).items()
    found = (mistakes.attempt(partial(_selected_result, name, entry)) for name, entry in entries)
    return tuple(each for each in found if each is not None)


def _selected_result(name: str, entry: Marked) -> SelectedResult:
    """One of them: how it is compared, or a mapping with `compare` and `ignore`."""
    fields = entry.mapping(("compare", "ignore")) if isinstance(entry.value, dict) else {"compare": entry}
    if "compare" not in fields:
        raise entry.fail("does not say what of it is compared; add `compare: last`")
    compare = fields["compare"].text()
    if compare not in COMPARISONS:
        raise fields["compare"].fail(f"is {compare!r}, it must be one of {', '.join(COMPARISONS)}")
    if compare == FILE and not name.startswith("/"):
        raise entry.fail(f"is the file {name!r}; a file of the mission has a path such as /ram/log.txt")
    if compare == OUTPUT and name.startswith("/"):
        raise entry.fail(f"is the output of {name!r}; name the node's application, the fourth field of its line")
    if "ignore" not in fields:
        return SelectedResult(name, compare)
    if compare not in OF_MESSAGES:
        raise fields["ignore"].fail(f"names fields, but {name} has none; only messages do")
    return SelectedResult(name, compare, tuple(_path(item) for item in fields["ignore"].items()))


def _path(item: Marked) -> str:
    path = item.text()
    if not all(part.isidentifier() for part in path.split(".")):
        raise _bad_path(item, path)
    return path


def _bad_path(item: Marked, path: str) -> UsageError:
    return item.fail(f"is {path!r}, it must be the path of a field, such as header.stamp")
