"""The KeyboardInterrupt of a simulated process, to distinguish it from a Ctrl-C of the host's user.

The code of a node finds it as `KeyboardInterrupt` among its builtins: SIGINT raises it, and what the node raises itself
ends a callback, a thread or the node, as in a process of its own, but not the run.
"""

from __future__ import annotations


class NodeInterrupt(KeyboardInterrupt):
    """A node was sent SIGINT, or raises KeyboardInterrupt. A traceback in the node shows that name."""

    __module__ = "builtins"
    __qualname__ = "KeyboardInterrupt"


NodeInterrupt.__name__ = "KeyboardInterrupt"
