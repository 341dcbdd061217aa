"""rclpy for nodes of cfepy's missions: `init`, `shutdown`, `create_node` and the functions that spin.

Names, arguments and results match rclpy of ROS 2 Jazzy; the code is cfepy's own, on top of `rclpy._seam`, which
connects a program with the Software Bus. It is executed anew in each program.
"""

from __future__ import annotations

from typing import Any

from rclpy.context import Context
from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.signals import SignalHandlerOptions, install_signal_handlers, uninstall_signal_handlers
from rclpy.task import Future
from rclpy.utilities import get_default_context, get_rmw_implementation_identifier, ok
from rclpy.utilities import shutdown as _shutdown
from rclpy.utilities import try_shutdown as _try_shutdown

__all__ = [
    "Context",
    "Future",
    "Node",
    "Parameter",
    "SignalHandlerOptions",
    "create_node",
    "get_default_context",
    "get_global_executor",
    "get_rmw_implementation_identifier",
    "init",
    "ok",
    "shutdown",
    "spin",
    "spin_once",
    "spin_until_future_complete",
    "try_shutdown",
]
_executors: list[Executor] = []
"""The global executor, once it was asked for."""


class InitContextManager:
    """Shuts a context down at the end of a `with` block."""

    def __init__(self, context: Context) -> None:
        self.context = context

    def __enter__(self) -> InitContextManager:
        return self

    def __exit__(self, *error: object) -> None:
        try_shutdown(context=self.context)


def init(
    *,
    args: list[str] | None = None,
    context: Context | None = None,
    domain_id: int | None = None,
    signal_handler_options: SignalHandlerOptions | None = None,
) -> InitContextManager:
    """Initialize a context.

    Args:
        args: command line; None takes sys.argv.
        context: the context; None takes the default one.
        domain_id: accepted; a mission has one domain.
        signal_handler_options: signals that shut the context down; None takes SIGINT and SIGTERM for the default
            context.

    Raises:
        RuntimeError: the context is initialized already.
    """
    chosen = context if context is not None else get_default_context()
    if signal_handler_options is None:
        signal_handler_options = SignalHandlerOptions.ALL if context is None else SignalHandlerOptions.NO
    install_signal_handlers(signal_handler_options)
    chosen.init(args, domain_id=domain_id)
    return InitContextManager(chosen)


def get_global_executor() -> Executor:
    """Return the executor that the functions of this module use; made at first use."""
    if not _executors:
        _executors.append(SingleThreadedExecutor())
    return _executors[0]


def _forget_executor() -> None:
    if _executors:
        _executors.pop().shutdown()


def shutdown(*, context: Context | None = None, uninstall_handlers: bool | None = None) -> None:
    """Shut a context down; None is the default one.

    Raises:
        RuntimeError: it is not initialized, or is shut down.
    """
    _forget_executor()
    _shutdown(context=context)
    if uninstall_handlers or (uninstall_handlers is None and context is None):
        uninstall_signal_handlers()


def try_shutdown(*, context: Context | None = None, uninstall_handlers: bool | None = None) -> None:
    """Shut a context down if it is not yet; None is the default one."""
    _forget_executor()
    _try_shutdown(context=context)
    if uninstall_handlers or (uninstall_handlers is None and context is None):
        uninstall_signal_handlers()


def create_node(node_name: str, **options: Any) -> Node:
    """Make a node; it takes the options of `Node`."""
    return Node(node_name, **options)


def spin_once(node: Node, *, executor: Executor | None = None, timeout_sec: float | None = None) -> None:
    """Run one callback of a node, or wait for one.

    Args:
        node: the node.
        executor: the executor; None takes the global one.
        timeout_sec: longest time in s; None or a negative one waits without limit.
    """
    chosen = get_global_executor() if executor is None else executor
    try:
        chosen.add_node(node)
        chosen.spin_once(timeout_sec=timeout_sec)
    finally:
        chosen.remove_node(node)


def spin(node: Node, executor: Executor | None = None) -> None:
    """Run the callbacks of a node until its context is shut down.

    Args:
        node: the node.
        executor: the executor; None takes the global one.

    Raises:
        ExternalShutdownException: the context was shut down meanwhile.
    """
    chosen = get_global_executor() if executor is None else executor
    try:
        chosen.add_node(node)
        if type(chosen) is SingleThreadedExecutor:
            chosen.spin_while_alive()
        while chosen.context.is_alive():
            chosen.spin_once()
    finally:
        chosen.remove_node(node)


def spin_until_future_complete(
    node: Node, future: Future, executor: Executor | None = None, timeout_sec: float | None = None
) -> None:
    """Run the callbacks of a node until a future is done.

    Args:
        node: the node.
        future: the future.
        executor: the executor; None takes the global one.
        timeout_sec: longest time in s; None or a negative one waits without limit.
    """
    chosen = get_global_executor() if executor is None else executor
    try:
        chosen.add_node(node)
        chosen.spin_until_future_complete(future, timeout_sec)
    finally:
        chosen.remove_node(node)
