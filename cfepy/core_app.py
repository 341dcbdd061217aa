"""Code that the five core applications share: the loop of their main tasks, and their replies to commands."""

from __future__ import annotations

from collections.abc import Callable
from typing import NoReturn

from cfepy.config.platform import PlatformConfig
from cfepy.ports import ERROR, INFORMATION, PEND_FOREVER, SYSTEM_CORE_READY, Ports


def serve(
    ports: Ports, config: PlatformConfig, pipe: int, perf_id: int, process: Callable[[bytes], object]
) -> NoReturn:
    """Run the loop of a main task: wait until all core applications run, then handle each packet.

    Args:
        ports: the services.
        config: has the time limit of the wait for the other core applications.
        pipe: the command pipe.
        perf_id: the marker in the performance log; the caller has already logged its entry.
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
    """Replies to commands: each reply counts the command and sends an event.

    Args:
        ports: gives access to the event services.

    Attributes:
        command_counter: number of accepted commands.
        error_counter: number of rejected commands.
    """

    def __init__(self, ports: Ports) -> None:
        self._ports = ports
        self.reset()

    def reset(self) -> None:
        """Set both counters to 0."""
        self.command_counter = self.error_counter = 0

    def accept(self, event_id: int, text: str, event_type: int = INFORMATION) -> None:
        """Count an accepted command and send its event."""
        self.command_counter += 1
        self.send(event_id, text, event_type)

    def reject(self, event_id: int, text: str) -> None:
        """Count a rejected or failed command and send an error event."""
        self.error_counter += 1
        self.send(event_id, text, ERROR)

    def send(self, event_id: int, text: str, event_type: int = INFORMATION) -> None:
        """Send an event without counting a command."""
        self._ports.evs.send_event(event_id, event_type, text)
