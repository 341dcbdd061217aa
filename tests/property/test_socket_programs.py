"""Tasks with random operations on connections: bytes stay in order, and a run is the same on both contexts."""

from __future__ import annotations

from dataclasses import dataclass, field

from hypothesis import given, settings
from hypothesis import strategies as st

from cfepy.osal.sockaddr import OS_SocketDomain_INET, SockAddr
from cfepy.osal.streams import OS_SocketType_STREAM
from cfepy.status import OsalError
from tests.osal.helpers import Bench

PORT = 9000
Step = tuple[str, int]
STEPS = st.lists(
    st.tuples(st.sampled_from(("write", "read", "delay", "select", "stop", "close")), st.integers(1, 100_000)),
    max_size=8,
)


@dataclass
class Side:
    """One end of a connection: sent and received data; `done` after its task has ended."""

    sent: bytearray = field(default_factory=bytearray)
    got: bytearray = field(default_factory=bytearray)
    done: bool = False


def perform(bench: Bench, sock: int, steps: list[Step], side: Side) -> None:
    """Execute the steps up to the first one that fails."""
    os = bench.os
    try:
        for number, (what, amount) in enumerate(steps):
            if what == "write":
                data = bytes([number + 1]) * amount
                side.sent += data[: os.timed_write(sock, data, amount % 50) or 0]
            elif what == "read":
                side.got += os.timed_read(sock, amount, amount % 50) or b""
            elif what == "select":
                os.select_single(sock, amount % 16, amount % 50)
            elif what == "delay":
                os.task_delay(amount % 30)
            elif what == "stop":
                os.socket_shutdown(sock, amount % 3 + 1)
            else:
                os.close(sock)
    except OsalError as refusal:
        bench.log.append(str(refusal))
    bench.log.append((bench.kernel.now, len(side.sent), len(side.got)))
    side.done = True


def fly(
    programs: list[tuple[list[Step], list[Step]]], context: str
) -> tuple[list[tuple[Side, Side]], list[object], str]:
    """Run a client and a server task for each pair of programs."""
    bench = Bench(context=context)
    os = bench.os
    listener = os.socket_open(OS_SocketDomain_INET, OS_SocketType_STREAM)
    os.socket_bind(listener, SockAddr(OS_SocketDomain_INET, "127.0.0.1", PORT))
    sides = [(Side(), Side()) for _ in programs]
    for number, (client_steps, server_steps) in enumerate(programs):
        client = os.socket_open(OS_SocketDomain_INET, OS_SocketType_STREAM)
        assert os.socket_connect(client, SockAddr(OS_SocketDomain_INET, "127.0.0.1", PORT), 0)
        accepted = os.socket_accept(listener, 0)
        assert accepted is not None
        near, far = sides[number]
        bench.task(lambda c=client, p=client_steps, s=near: perform(bench, c, p, s), 100 + number % 2, f"C{number}")
        bench.task(lambda c=accepted[0], p=server_steps, s=far: perform(bench, c, p, s), 100, f"S{number}")
    bench.kernel.run(until_ns=5_000_000_000)
    digest = bench.kernel.trace.digest() if bench.kernel.trace is not None else ""
    os.delete_all_objects()
    assert not os.network.streams.bound
    bench.kernel.shutdown()
    return sides, bench.log, digest


@settings(max_examples=30, deadline=None)
@given(st.lists(st.tuples(STEPS, STEPS), min_size=1, max_size=3))
def test_any_programs_give_the_same_run_on_threads_and_greenlets(programs: list[tuple[list[Step], list[Step]]]) -> None:
    sides, log, digest = fly(programs, "thread")
    for near, far in sides:
        assert near.done
        assert far.done
        assert near.sent.startswith(far.got)
        assert far.sent.startswith(near.got)
    assert fly(programs, "greenlet")[1:] == (log, digest)
