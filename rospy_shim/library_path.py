"""Where the libraries are that nodes import beside rospy: tf, tf2_ros, ...; each a folder in `rospy_shim/libraries`.

A library is ordinary node code. It is on the import path of every node, behind the node's own folders, so a node that
brings a library's original source gets that; it is read when it is first imported and executed in the node's universe,
with the node's own rospy. It may import the standard library, rospy, message packages, NumPy and other libraries,
nothing else.

Packages of other projects that a library's original source imports and rarely uses have stand-ins, which are found when
nobody has installed the real ones. Imports nothing.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

FOLDER = Path(__file__).parent / "libraries"
STAND_INS = Path(__file__).parent / "stand_ins"


@cache
def names() -> frozenset[str]:
    """Names of the libraries."""
    return frozenset(path.parent.name for path in FOLDER.glob("*/__init__.py"))
