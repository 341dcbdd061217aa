"""The end of a node: causes of a shutdown, and hooks that run then (rospy.core's shutdown functions, rospy.spin).

A shutdown comes from the node itself, from ES (CFE_ES_RunLoop returns false), or from the end of the mission, which
stands for the Ctrl-C that ends a roslaunch.
"""

from __future__ import annotations

import signal
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from cfepy.interpreter.node_interrupt import NodeInterrupt
from cfepy.nodes.node_tracebacks import traceback_text
from cfepy.rtos import WaitList

if TYPE_CHECKING:
    from rospy_shim.client.node import Node

LOOK_NS = 100_000_000  # period at which a node asks ES whether to go on
SPIN_NS = 500_000_000  # period at which `spin` looks


class Life:
    """Shutdown of one node.

    Args:
        node: the node.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._kernel = node.kernel
        self._flag = False
        self._requested = False
        self._look_at = 0
        self._call_ns = node.call_ns
        self._client_hooks: list[Callable[[], object]] = []
        self._preshutdown_hooks: list[Callable[[str], object]] = []
        self._shutdown_hooks: list[Callable[[str], object]] = []
        self._own_handlers: list[object] = []
        self._former_handlers: dict[int, Any] = {}
        self.wait_lists: list[WaitList] = []  # tasks that wait here are woken by the shutdown
        node.universe.exit_hooks.append((self.signal_shutdown, ("atexit",), {}))

    @property
    def over(self) -> bool:
        """True if the node is shut down; as `is_shutdown`, without asking ES."""
        return self._flag

    def is_shutdown(self) -> bool:
        """Return True if the node is shut down, which ES may have asked for (CFE_ES_RunLoop)."""
        if self._call_ns:
            self._kernel.charge(self._call_ns)
        if self._kernel.now >= self._look_at:
            self._look()
        return self._flag

    def is_shutdown_requested(self) -> bool:
        """Return True if a shutdown has begun."""
        return self._requested

    def _look(self) -> None:
        if self._kernel.current is self._kernel.host or self._requested:
            return
        self._look_at = self._kernel.now + LOOK_NS
        if not self._node.cfe.es.run_loop():
            self.signal_shutdown("cFE asks the application to exit")

    def add_client_shutdown_hook(self, h: Callable[[], object]) -> None:
        """Add a function that is called when the node shuts down, while it is still on the graph (rospy.on_shutdown).

        Raises:
            TypeError: it cannot be called.
        """
        _check(h)
        if self._flag:
            h()
        else:
            self._client_hooks.append(h)

    def add_preshutdown_hook(self, h: Callable[[str], object]) -> None:
        """Add a function that is called with the reason, after the client's hooks.

        Raises:
            TypeError: it cannot be called.
        """
        _check(h)
        self._add(self._preshutdown_hooks, h)

    def add_shutdown_hook(self, h: Callable[[str], object]) -> None:
        """Add a function that is called with the reason, once `is_shutdown` is true.

        Raises:
            TypeError: it cannot be called.
        """
        _check(h)
        self._add(self._shutdown_hooks, h)

    def _add(self, hooks: list[Callable[[str], object]], hook: Callable[[str], object]) -> None:
        if self._flag:
            hook("already shutdown")
        else:
            hooks.append(hook)

    def signal_shutdown(self, reason: str) -> None:
        """Shut the node down: run the hooks, leave the graph, wake waiting tasks.

        Args:
            reason: passed to the hooks.
        """
        if self._requested:
            return
        self._requested = True
        for client_hook in self._client_hooks[:]:
            self._run(client_hook)
        for hook in self._preshutdown_hooks[:]:
            self._run(hook, reason)
        self._flag = True
        self._node.leave_graph()
        for hook in self._shutdown_hooks[:]:
            self._run(hook, reason)
        for waits in self.wait_lists[:]:
            self._kernel.wake_all(waits)

    def _run(self, hook: Callable[..., object], *args: str) -> None:
        """Run one hook. Its exception is shown, and the next one runs all the same."""
        try:
            hook(*args)
        except (Exception, NodeInterrupt) as error:
            self._node.universe.print_error(traceback_text(error))

    def spin(self) -> None:
        """Wait until the node is shut down; callbacks run in tasks of their own.

        Raises:
            ROSInitException: before `init_node`.
        """
        self._node.require_initialized()
        try:
            while not self.is_shutdown():
                self._kernel.delay(SPIN_NS)
        except (KeyboardInterrupt, NodeInterrupt):
            self.signal_shutdown("keyboard interrupt")

    def wait(self, waits: WaitList, timeout_ns: int) -> None:
        """Wait in a list for a time in ns, or until the shutdown."""
        self.wait_lists.append(waits)
        try:
            self._kernel.wait_on(waits, timeout_ns)
        finally:
            self.wait_lists.remove(waits)

    # -- requests from outside -----------------------------------------------------------------------------------------

    def register_signals(self) -> None:
        """Let SIGINT and SIGTERM shut the node down; a handler that it has set before runs too."""
        table = self._node.universe.signals
        for number in (signal.SIGINT, signal.SIGTERM):
            former = table.get(number)
            table.set(number, self._handler(number, former))

    def _handler(self, number: int, former: Any) -> Callable[[int, object], None]:
        def on_signal(received: int, frame: object) -> None:
            self.signal_shutdown(f"signal-{received}")
            if callable(former) and former is not signal.default_int_handler:
                former(received, frame)

        self._own_handlers.append(on_signal)
        self._former_handlers[number] = former
        return on_signal

    def interrupt(self, reason: str) -> None:
        """Act as Ctrl-C does, at the end of the mission. Rospy's handler runs first, one set before `init_node` last.

        With `disable_signals` the node must handle it: a KeyboardInterrupt in its main thread.
        """
        if self._node.universe.signals.get(signal.SIGINT) in self._own_handlers:
            self.signal_shutdown(reason)
        self._node.universe.deliver_signal(signal.SIGINT)


def _check(hook: object) -> None:
    if not callable(hook):
        raise TypeError(f"shutdown hook [{hook}] must be a function or callable object: {type(hook)}")
