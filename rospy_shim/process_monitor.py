"""What becomes of nodes that end: started again, left alone, or the end of the whole run (roslaunch.pmon).

May import cfepy.nodes.config.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from cfepy.nodes.config import NodeConfig, RosConfig

if TYPE_CHECKING:
    from cfepy.console import Console


class ProcessMonitor:
    """Looks after the nodes of one mission.

    Args:
        config: what was said about them.
        console: where it tells what it does.
        stop: ends the run where it is.

    Attributes:
        statuses: the exit status of each node that has ended by itself, by cFE name.
        restarts: how often a node was started again, by cFE name.
        over: whether the run has come to its end.
        closing: whether the nodes were asked to end, so that how they do it is not their failure.
    """

    def __init__(self, config: RosConfig, console: Console, stop: Callable[[], object]) -> None:
        self.statuses: dict[str, int] = {}
        self.restarts: dict[str, int] = {}
        self.over = False
        self._config = config
        self._console = console
        self._stop = stop
        self.closing = False

    def close(self) -> None:
        """The run is about to end: no node is started again, and the end of none is remarkable."""
        self.closing = True

    def starts_again(self, node: NodeConfig, status: int) -> bool:
        """A node has ended: whether it is to be started again.

        Args:
            node: which one.
            status: its exit status.
        """
        if self.closing:
            return False
        self.statuses[node.app] = status
        if node.respawn:
            self.restarts[node.app] = self.restarts.get(node.app, 0) + 1
            self._say(f"{node.name} has ended with exit status {status} and is started again")
            return True
        if node.required:
            self._say(f"{node.name} has ended with exit status {status}; it is required, so the run is over")
            self._end()
        elif self._config.ends_with_nodes and all(app in self.statuses for app in self._config.nodes):
            self._end()
        return False

    def _end(self) -> None:
        self.over = True
        self._stop()

    def _say(self, text: str) -> None:
        self._console.write(f"launch: {text}")
