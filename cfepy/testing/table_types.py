"""Finding the declaration of a table that a test means."""

from __future__ import annotations

from cfepy.mission.declared import table_types
from cfepy.status import UsageError
from cfepy.tbl import TableType


def table_type(name: str, mission: str | None) -> TableType:
    """The declaration of a table, by its full name, or by its own if no other one has it.

    Raises:
        UsageError: there is none, or there are several of that name.
    """
    problems: list[str] = []
    known = table_types(mission, problems)
    if name in known:
        return known[name]
    found = [kind for kind in known.values() if kind.own_name == name]
    if len(found) == 1:
        return found[0]
    which = (
        f"is {' or '.join(kind.name for kind in found)} meant?" if found else f"there are {', '.join(sorted(known))}"
    )
    raise UsageError("; ".join([f"no table is called {name!r}", which, *problems]))
