"""ROS nodes in C++ as cFE applications: the convertor, `cfepy convert`.

A node's source is compiled as it is, against the interface library in flight/roscfe. What belongs here reads C++
packages (`packages`), makes what is generated around a node, such as the headers of its messages (`messages`), its
entry point and its parameters, and calls the compiler. Running what was built does not belong here: to a mission a
shared object is a compiled application like any other.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.faces import face

if TYPE_CHECKING:
    from cfepy.convert.flight import build_for_flight

__all__ = ["build_for_flight"]

if not TYPE_CHECKING:  # a type checker sees the names above, and no others
    __getattr__, __dir__ = face(__name__, {".flight": ("build_for_flight",)})
