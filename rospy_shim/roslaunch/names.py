"""How launch files put names together (rosgraph.names). Imports nothing of cfepy."""

from __future__ import annotations

from rospy_shim.names import PRIV_NAME, SEP


def joined(namespace: str, name: str) -> str:
    """A name below a namespace; global and private names stay as they are."""
    if not namespace or name.startswith((SEP, PRIV_NAME)):
        return name
    return namespace + name if namespace.endswith(SEP) else f"{namespace}{SEP}{name}"


def as_namespace(name: str) -> str:
    """A namespace with a slash at both ends.

    Raises:
        ValueError: it begins with "~".
    """
    if name.startswith(PRIV_NAME):
        raise ValueError(f"{name!r} is private, which a namespace cannot be")
    name = name if name.startswith(SEP) else SEP + name
    return name if name.endswith(SEP) else name + SEP
