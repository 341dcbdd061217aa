"""The md5sum of a message type from its full definition, as ROS computes it (wiki.ros.org/ROS/Technical Overview).

Foreign recordings may lack it, and a topic cannot be connected without it. Imports the standard library only.
"""

from __future__ import annotations

import hashlib
import re

_BUILT_IN = re.compile(r"(u?int(8|16|32|64)|float(32|64)|bool|string|time|duration|char|byte)")
_CONSTANT = re.compile(r"([\w/]+)\s+(\w+)\s*=(.*)")
_FIELD = re.compile(r"([\w/]+)(\[\d*\])?\s+(\w+)$")
_SECTION = re.compile(r"^=+\s*\nMSG:\s*(\S+)[^\n]*\n?", re.MULTILINE)


def md5sum_of(type: str, definition: str) -> str:
    """Return the md5sum of a type, or "*", which stands for any, if its definition is invalid.

    Args:
        type: such as "sensor_msgs/JointState".
        definition: with the definitions of the types in it, as in a bag.
    """
    parts = _SECTION.split(definition)
    texts = {type: parts[0], **dict(zip(parts[1::2], parts[2::2], strict=True))}
    try:
        return _md5sum(type, texts, frozenset())
    except (KeyError, ValueError):
        return "*"


def _md5sum(type: str, texts: dict[str, str], around: frozenset[str]) -> str:
    if type in around:
        raise ValueError(f"{type} is in itself")
    constants, fields = [], []
    for line in texts[type].splitlines():
        constant = _CONSTANT.match(line.strip())
        text = line.partition("#")[0].strip()
        if constant is not None and (constant[1] == "string" or "=" in text):
            value = constant[3] if constant[1] == "string" else constant[3].partition("#")[0]
            constants.append(f"{constant[1]} {constant[2]}={value.strip()}")
        elif text:
            found = _FIELD.match(text)
            if found is None:
                raise ValueError(f"invalid field {text}")
            kind, array, name = found.groups()
            if _BUILT_IN.fullmatch(kind) is None:
                inner = _md5sum(_full_name(kind, type), texts, around | {type})
                fields.append(f"{inner} {name}")
            else:
                fields.append(f"{kind}{array or ''} {name}")
    return hashlib.md5("\n".join([*constants, *fields]).encode(), usedforsecurity=False).hexdigest()


def _full_name(kind: str, of: str) -> str:
    if "/" in kind:
        return kind
    return "std_msgs/Header" if kind == "Header" else f"{of.partition('/')[0]}/{kind}"
