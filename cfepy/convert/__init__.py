"""ROS nodes in C++ as cFE applications: the convertor, `cfepy convert`.

A node's source is compiled as it is, against the interface library in flight/roscfe. What belongs here makes what is
generated around it: the headers of its messages (`messages`), its entry point, its parameters and its build.
"""

from __future__ import annotations
