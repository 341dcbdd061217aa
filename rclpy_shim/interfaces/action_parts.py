"""The messages and services of an action, as rosidl derives them from a .action file.

An action such as "example_interfaces/Fibonacci" has three messages of its own (Goal, Result, Feedback), two services
(SendGoal, GetResult) and one message that carries the feedback. Their names join the action's with an underscore.
"""

from __future__ import annotations

from rospy_shim.types.msgs.definition_sources import Definition, split_parts

OWN_PARTS = ("Goal", "Result", "Feedback")
SERVICES = ("SendGoal", "GetResult")
_UUID = "unique_identifier_msgs/UUID goal_id\n"
_DERIVED = {
    "SendGoal_Request": _UUID + "{}_Goal goal\n",
    "SendGoal_Response": "bool accepted\nbuiltin_interfaces/Time stamp\n",
    "GetResult_Request": _UUID,
    "GetResult_Response": "int8 status\n{}_Result result\n",
    "FeedbackMessage": _UUID + "{}_Feedback feedback\n",
}
PARTS = (*OWN_PARTS, *_DERIVED)
"""The messages of an action."""


def action_of(name: str) -> tuple[str, str]:
    """Return the action and the part of a message such as "Fibonacci_SendGoal_Request"; the part is empty for others.

    Args:
        name: bare name of the message.
    """
    action, _, part = name.partition("_")
    return (action, part) if part in PARTS else (name, "")


def definition_of(action: Definition, name: str, part: str) -> Definition:
    """Return the definition of one message of an action.

    Args:
        action: text of the .action file.
        name: bare name of the action.
        part: one of `PARTS`.
    """
    if part in _DERIVED:
        return Definition(_DERIVED[part].format(name), action.file)
    parts = split_parts(action)
    at = OWN_PARTS.index(part)
    return parts[at] if at < len(parts) else Definition("", action.file)
