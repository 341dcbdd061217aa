"""The two identities of a message type: its md5sum and its full text, both as genmsg computes them.

Two programs talk only if their md5sums agree; the full text travels in connection headers and bags, so that a reader
without the package can still decode. Pure functions of specs; imports nothing of cfepy.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

from rospy_shim.msgs.spec import BUILTINS, Field, Spec

_Lookup = Callable[[str], Spec]
_SEPARATOR = "=" * 80 + "\n"


def md5_text(spec: Spec, md5sum_of: Callable[[str], str]) -> str:
    """The text that is hashed: constants, then fields; a nested message stands as its own md5sum.

    Args:
        spec: the message.
        md5sum_of: md5sum of a nested type, by full name.
    """
    lines = [f"{constant.type} {constant.name}={constant.text}" for constant in spec.constants]
    lines += [f"{_hashed_type(field, md5sum_of)} {field.name}" for field in spec.fields]
    return "\n".join(lines)


def md5sum(spec: Spec, md5sum_of: Callable[[str], str]) -> str:
    """Fingerprint of a message, as 32 hexadecimal digits."""
    return hash_text(md5_text(spec, md5sum_of))


def hash_text(text: str) -> str:
    """md5 of a text; an identity, not a protection."""
    import hashlib

    return hashlib.md5(text.encode(), usedforsecurity=False).hexdigest()


def full_text(spec: Spec, lookup: _Lookup) -> str:
    """The definition followed by those of all types that it needs, each once, in order of first need."""
    parts = [spec.text + "\n"]
    for name in _needs(spec, lookup):
        parts.append(f"{_SEPARATOR}MSG: {name}\n{lookup(name).text}\n")
    return "".join(parts)[:-1]


def split_full_text(text: str) -> Iterable[tuple[str | None, str, int]]:
    """Take a full text apart: (type name or None for the first, definition, number of its first line)."""
    line = 1
    parts = text.split("\n" + _SEPARATOR)
    for index, part in enumerate(parts):
        name, body = None, part
        if index:
            heading, _, body = part.partition("\n")
            name = heading.removeprefix("MSG:").strip()
            line += 1
        yield name, body, line
        line += body.count("\n") + 2


def _hashed_type(field: Field, md5sum_of: Callable[[str], str]) -> str:
    return field.type if field.base in BUILTINS else md5sum_of(field.base)


def _needs(spec: Spec, lookup: _Lookup) -> dict[str, None]:
    found: dict[str, None] = {}
    for name in spec.message_types:
        found.setdefault(name)
        for deeper in _needs(lookup(name), lookup):
            found.setdefault(deeper)
    return found
