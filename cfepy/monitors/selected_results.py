"""Results of a mission that must not depend on the schedule: the section `results` of a mission file.

`cfepy explore` compares them with the results under the default schedule. See docs/how_to/explore_schedules.md.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

from cfepy.reading.marked_yaml import Marked
from cfepy.reading.mistakes import Mistakes
from cfepy.reading.suggestions import expected
from cfepy.status import UsageError

LAST, SEQUENCE, ANY_ORDER, COUNT = "last", "sequence", "any order", "count"
FILE, OUTPUT = "file", "output"
OF_MESSAGES = (LAST, SEQUENCE, ANY_ORDER, COUNT)
COMPARISONS = (*OF_MESSAGES, FILE, OUTPUT)
FIELDS = ("compare", "ignore")
TIMES = ("header.stamp", "header.seq")
"""Fields ignored by default: a difference of a few microseconds is not another result."""


@dataclass(frozen=True, slots=True)
class SelectedResult:
    """A result.

    Attributes:
        name: a topic, a packet in the dictionary or MsgId, a file of the mission, or an application's name.
        compare: one of COMPARISONS.
        ignore: fields of messages that may differ, as paths such as "header.stamp"; also in nested messages.
    """

    name: str
    compare: str
    ignore: tuple[str, ...] = TIMES

    @property
    def is_of_packet(self) -> bool:
        """Whether its messages are packets of the dictionary and not of a topic."""
        return self.compare in OF_MESSAGES and not self.name.startswith(("/", "*"))


def read_selected_results(section: Marked, mistakes: Mistakes) -> tuple[SelectedResult, ...]:
    """Return the section `results:`, without invalid entries.

    Args:
        section: its value.
        mistakes: collects unknown keys and invalid values.
    """
    entries = mistakes.mapping(section).items()
    found = (mistakes.whole(partial(_selected_result, name, entry)) for name, entry in entries)
    return tuple(each for each in found if each is not None)


def _selected_result(name: str, entry: Marked, mistakes: Mistakes) -> SelectedResult:
    """Return one result: how it is compared, or a mapping with `compare` and `ignore`."""
    is_mapping = isinstance(entry.value, dict)
    fields = dict(mistakes.fields(entry, FIELDS)) if is_mapping else {"compare": entry}
    ignored = mistakes.items(fields["ignore"]) if "ignore" in fields else []
    paths = [mistakes.attempt(partial(_path, item)) for item in ignored]
    if "compare" not in fields and mistakes.errors:
        raise mistakes.errors.pop()  # its key may be misspelt
    if "compare" not in fields:
        raise entry.fail("missing compare; add it, such as `compare: last`")
    compare = fields["compare"].text()
    if compare not in COMPARISONS:
        raise fields["compare"].fail(f"unknown comparison {compare!r}; {expected(compare, COMPARISONS)}")
    if compare == FILE and not name.startswith("/"):
        raise entry.fail(f"invalid file {name!r}; expected a path in the mission's file system, such as /ram/log.txt")
    if compare == OUTPUT and name.startswith("/"):
        raise entry.fail(f"invalid output {name!r}; name the node's application, the fourth field of its line")
    if "ignore" not in fields:
        return SelectedResult(name, compare)
    if compare not in OF_MESSAGES:
        raise fields["ignore"].fail(f"is only valid for messages, and {name} has no fields")
    return SelectedResult(name, compare, tuple(path for path in paths if path))


def _path(item: Marked) -> str:
    path = item.text()
    if not all(part.isidentifier() for part in path.split(".")):
        raise _bad_path(item, path)
    return path


def _bad_path(item: Marked, path: str) -> UsageError:
    return item.fail(f"must be the path of a field, such as header.stamp, not {path!r}")
