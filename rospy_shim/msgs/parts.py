"""Definitions of more than one part: services, and actions with the seven messages that actionlib exchanges for one.

An action is a goal, a result and a feedback, and an envelope for each, as actionlib_msgs' genaction makes them.
Imports cfepy.status only.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from cfepy.status import UsageError

_DASHES = "---"
_PARTS = ("Goal", "Result", "Feedback")
_ENVELOPES = {
    "Goal": "actionlib_msgs/GoalID goal_id",
    "Result": "actionlib_msgs/GoalStatus status",
    "Feedback": "actionlib_msgs/GoalStatus status",
}


class Definition(NamedTuple):
    """Text of one type and the place it was read from."""

    text: str
    file: str
    first_line: int = 1


def split_parts(definition: Definition) -> list[Definition]:
    """The parts of an action, which lines that begin with three dashes separate."""
    parts, start = [], 0
    lines = definition.text.split("\n")
    for at, line in enumerate([*lines, _DASHES]):
        if line.startswith(_DASHES):
            text = "\n".join(lines[start:at])
            parts.append(Definition(text, definition.file, definition.first_line + start))
            start = at + 1
    return parts


def split_service(definition: Definition) -> tuple[Definition, Definition]:
    """Request and response of a service. Only the first line of dashes parts them; more of them are as if empty."""
    request, *rest = split_parts(definition)
    text = "\n\n".join(part.text for part in rest)
    first_line = rest[0].first_line if rest else definition.first_line
    return request, Definition(text, definition.file, first_line)


def messages_of(actions: Mapping[str, Definition]) -> dict[str, Definition]:
    """The messages of all actions of a package.

    Args:
        actions: definitions by the action's bare name.

    Raises:
        UsageError: an action has not exactly three parts.
    """
    return {name + suffix: made for name, action in actions.items() for suffix, made in _messages(name, action)}


def _messages(name: str, action: Definition) -> Iterator[tuple[str, Definition]]:
    parts = split_parts(action)
    if len(parts) != len(_PARTS):
        line = parts[min(len(parts) - 1, len(_PARTS))].first_line
        raise UsageError(
            f"an action has 3 parts with a line {_DASHES} between each, not {len(parts)}", file=action.file, line=line
        )
    for part, definition in zip(_PARTS, parts, strict=True):
        envelope = f"Header header\n{_ENVELOPES[part]}\n{name}{part} {part.lower()}\n"
        yield part, definition
        yield f"Action{part}", Definition(envelope, action.file, action.first_line)
    whole = "".join(f"{name}Action{part} action_{part.lower()}\n" for part in _PARTS)
    yield "Action", Definition(whole, action.file, action.first_line)
