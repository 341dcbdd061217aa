"""The ground link: commands to a mission and telemetry from it as over UDP, but inside the process.

It acts as a ground system that is connected to CI_LAB's and TO_LAB's sockets. The host uses it between two parts of a
run; its data arrives at the current virtual time, and is recorded in the trace with its bytes. So a run with a ground
link is as deterministic as one without.
"""

from __future__ import annotations

from collections.abc import Callable
from types import TracebackType

from cfepy.mission import Mission
from cfepy.osal import Datagram, Place

CI_PORT = 1234
TO_PORT = 1235
GROUND = Place("127.0.0.1", TO_PORT)


class GroundLink:
    """Connection from the host to the virtual sockets of a mission, and back.

    Args:
        mission: the mission; the link stays connected after its resets.
        on_datagram: called at once with everything that the mission sends; without it, `received` returns it.
    """

    def __init__(self, mission: Mission, on_datagram: Callable[[Datagram], object] | None = None) -> None:
        self._mission = mission
        self._waiting: dict[int, list[tuple[int, bytes]]] = {}
        self._outlet = self._keep if on_datagram is None else on_datagram
        mission.network.outlets.append(self._outlet)

    def send(self, packet: bytes, port: int = CI_PORT, source: Place = GROUND) -> bool:
        """Send a datagram to a port of the mission; only from the host, while the run is stopped.

        Args:
            packet: its bytes.
            port: port of CI_LAB: 1234 on processor 1.
            source: its sender, as the receiver sees it.

        Returns:
            Whether it was taken: False when no socket is bound there, or the one that is has no room left.
        """
        return self._mission.outside.datagram(port, source, bytes(packet))

    def received(self, port: int = TO_PORT) -> list[tuple[int, bytes]]:
        """Return the received datagrams since the last call, in order.

        Args:
            port: port to which TO_LAB sends.

        Returns:
            The virtual time of sending in ns and the bytes of each datagram, whatever the host it was sent to.
        """
        return self._waiting.pop(port, [])

    def close(self) -> None:
        """Remove the link; the mission continues without it."""
        self._mission.network.outlets.remove(self._outlet)

    def __enter__(self) -> GroundLink:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, where: TracebackType | None
    ) -> None:
        self.close()

    def _keep(self, datagram: Datagram) -> None:
        self._waiting.setdefault(datagram.target.port, []).append((self._mission.kernel.now, datagram.data))
