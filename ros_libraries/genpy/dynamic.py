"""`generate_dynamic`: message classes from a full text."""

from __future__ import annotations

from typing import Any

from genmsg import MsgContext, MsgGenerationException
from genmsg.msg_loader import load_depends, load_msg_from_string

from .classes import classes_of_text

_SEPARATOR = "\n" + "=" * 80 + "\n"
_HEADING = "MSG: "


def generate_dynamic(core_type: str, msg_cat: str) -> dict[str, Any]:
    """Return the classes of a type and of all types in it.

    Args:
        core_type: name of the first type in the text.
        msg_cat: the full text, as in `_full_text`, a connection header or a bag.

    Raises:
        MsgGenerationException: a type after the first does not name itself.
        InvalidMsgSpec: a definition has a mistake.
        MsgNotFound: the text uses a type that it does not define.
    """
    text = msg_cat.replace("roslib/Header", "std_msgs/Header")  # where the header was long ago
    core, *others = text.split(_SEPARATOR)
    definitions = {core_type: core}
    for other in others:
        heading, _, body = other.partition("\n")
        if not heading.startswith(_HEADING):
            problem = "dependent type is missing 'MSG:' type declaration header"
            raise MsgGenerationException(f"invalid input to generate_dynamic: {problem}")
        definitions[heading.removeprefix(_HEADING).strip()] = body
    context = MsgContext.create_default()
    specs = {name: load_msg_from_string(context, body, name) for name, body in definitions.items()}
    for spec in specs.values():
        load_depends(context, spec, {})
    classes = classes_of_text(core_type, text)
    for name, spec in specs.items():
        classes[name]._spec = spec
    return {name: classes[name] for name in specs}
