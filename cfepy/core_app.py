"""What the five core applications have in common: the loop of their main tasks, and answers to commands."""

from __future__ import annotations

from collections.abc import Callable
from typing import NoReturn

from cfepy.config.platform import PlatformConfig
from cfepy.ports import ERROR, INFORMATION, PEND_FOREVER, SYSTEM_CORE_READY, Ports


def serve(
    ports: Ports, config: PlatformConfig, pipe: int, perf_id: int, process: Callable[[bytes], object]
) -> NoReturn:
    """The loop of a main task: wait until all core applications run, then handle packet after packet.

    Args:
        ports: the services.
        config: says how long to wait for the others.
        pipe: the command pipe.
        perf_id: marks in the performance log when the task works; its entry was logged before.
        process: handles a packet.
    """
    es, receive = ports.es, ports.sb.receive_buffer
    es.wait_for_system_state(SYSTEM_CORE_READY, config.es_core_max_startup_ms)
    while True:
        es.increment_task_counter()
        es.perf_log_exit(perf_id)
        packet = receive(pipe, PEND_FOREVER)
        es.perf_log_entry(perf_id)
        if packet is not None:
            process(packet)


class Replies:
    """How commands are answered: a counter goes up and an event goes out.

    Args:
        ports: for the events.

    Attributes:
        command_counter: commands that were done.
        error_counter: commands that were refused.
    """

    def __init__(self, ports: Ports) -> None:
        self._ports = ports
        self.reset()

    def reset(self) -> None:
        """Set both counters to 0."""
        self.command_counter = self.error_counter = 0

    def accept(self, event_id: int, text: str, event_type: int = INFORMATION) -> None:
        """The command was carried out."""
        self.command_counter += 1
        self.send(event_id, text, event_type)

    def reject(self, event_id: int, text: str) -> None:
        """The command was refused, or failed."""
        self.error_counter += 1
        self.send(event_id, text, ERROR)

    def send(self, event_id: int, text: str, event_type: int = INFORMATION) -> None:
        """Say something, and count nothing."""
        self._ports.evs.send_event(event_id, event_type, text)
