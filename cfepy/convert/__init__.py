"""ROS nodes in C++ as cFE applications: the convertor, `cfepy convert`.

A node's source is compiled as it is, against the interface library in flight/roscfe. What belongs here reads C++
packages (`packages`), makes what is generated around a node, such as the headers of its messages (`messages`), its
entry point and its parameters, and calls the compiler. Running what was built does not belong here: to a mission a
shared object is a compiled application like any other.
"""

from __future__ import annotations
