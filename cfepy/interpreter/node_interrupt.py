"""The KeyboardInterrupt of a simulated process, to distinguish it from a Ctrl-C of the host's user.

The code of a node finds it as `KeyboardInterrupt` among its builtins: SIGINT raises it. If the node raises it, it
ends a callback, a thread or the node, as in a process of its own, but not the run. It is no kind of Python's own
KeyboardInterrupt, so its bases are the same as those that a node sees on a robot.
"""

from __future__ import annotations


class NodeInterrupt(BaseException):
    """Exception for a node that was sent SIGINT, or that raises KeyboardInterrupt; a traceback shows that name."""

    __module__ = "builtins"
    __qualname__ = "KeyboardInterrupt"


NodeInterrupt.__name__ = "KeyboardInterrupt"
