"""Stream sockets: connections between a server and its clients, and how they end."""

from __future__ import annotations

from cfepy.osal.limits import OS_CHECK
from cfepy.osal.network import STREAM_BUFFER
from cfepy.osal.sockets import (
    OS_SocketShutdownMode_SHUT_READ,
    OS_SocketShutdownMode_SHUT_READWRITE,
    OS_SocketShutdownMode_SHUT_WRITE,
)
from cfepy.status import (
    OS_ERR_INCORRECT_OBJ_STATE,
    OS_ERR_INCORRECT_OBJ_TYPE,
    OS_ERR_INVALID_ARGUMENT,
    OS_ERR_INVALID_ID,
    OS_ERR_INVALID_SIZE,
    OS_ERR_NO_FREE_IDS,
    OS_ERROR,
    OS_INVALID_POINTER,
)
from tests.osal.helpers import MS, Bench
from tests.osal.sockets import DATAGRAM, INET, INET6, NO_SOCKET, STREAM, a_file, address, bound, connection
from tests.osal.test_queues import status_of


def test_a_server_and_its_clients(bench: Bench) -> None:
    os = bench.os

    def serve() -> None:
        server = bound(bench, 9997, STREAM)
        for _ in range(3):
            accepted = os.socket_accept(server)
            assert accepted is not None
            data = os.read(accepted[0], 20)
            os.write(accepted[0], data.upper())
            os.write(accepted[0], bytes([len(data)]))
            os.close(accepted[0])

    def use() -> list[tuple[bytes, ...]]:
        answers = []
        for text in (b"a", b"bc", b"def"):
            client = os.socket_open(INET, STREAM)
            assert os.socket_connect(client, address(9997), 10)
            os.write(client, text)
            os.task_delay(1)
            answers.append((os.timed_read(client, 20, 10) or b"", os.read(client, 20)))
            os.close(client)
        return answers

    bench.task(serve, priority=90)
    assert bench.run(use) == [(b"A\x01", b""), (b"BC\x02", b""), (b"DEF\x03", b"")]


def test_a_stream_has_no_borders(bench: Bench) -> None:
    _, client, served = connection(bench)
    for text in (b"one", b"two", b"three"):
        bench.os.write(client, text)
    assert [bench.os.read(served, limit) for limit in (4, 3, 100)] == [b"onet", b"wot", b"hree"]
    assert bench.os.timed_read(served, 5, OS_CHECK) is None


def test_a_full_stream_holds_the_writer_back(bench: Bench) -> None:
    _, client, served = connection(bench)

    def write() -> None:
        for data in (bytes(STREAM_BUFFER + 5), b"more"):
            bench.log.append((bench.os.write(client, data), bench.kernel.now // MS))

    def read() -> int:
        assert bench.os.timed_write(client, b"x", OS_CHECK) is None
        bench.os.task_delay(8)
        return len(bench.os.read(served, 3)) + len(bench.os.read(served, STREAM_BUFFER))

    bench.task(write, priority=90)
    assert bench.run(read) == STREAM_BUFFER + 3
    assert bench.log == [(STREAM_BUFFER, 0), (3, 8)]


def test_the_end_of_a_stream(bench: Bench) -> None:
    _, client, served = connection(bench)
    bench.os.write(served, b"last")
    bench.os.close(served)
    assert [bench.os.read(client, 9), bench.os.read(client, 9)] == [b"last", b""]
    assert bench.os.write(client, b"lost") == 4  # and causes the reset
    assert bench.os.read(client, 9) == b""
    assert status_of(bench.os.write, client, b"x") == OS_ERROR
    assert status_of(bench.os.socket_shutdown, client, OS_SocketShutdownMode_SHUT_READ) == OS_ERROR


def test_closing_with_unread_bytes_resets_the_peer(bench: Bench) -> None:
    _, client, served = connection(bench)
    bench.os.write(served, b"last")
    bench.os.write(client, b"unread")
    bench.os.close(served)
    assert bench.os.read(client, 9) == b"last"
    assert status_of(bench.os.read, client, 9) == OS_ERROR
    assert bench.os.read(client, 9) == b""
    assert status_of(bench.os.write, client, b"x") == OS_ERROR


def test_refused_socket_reads_its_end_and_refuses_the_next_attempt(bench: Bench) -> None:
    os, client = bench.os, bench.os.socket_open(INET, STREAM)
    assert status_of(os.timed_read, client, 4, 10) == OS_ERROR
    assert status_of(os.socket_connect, client, address(9997), 10) == OS_ERROR
    assert os.timed_read(client, 4, 10) == b""
    assert status_of(os.timed_write, client, b"x", 10) == OS_ERROR
    bound(bench, 9997, STREAM)
    assert status_of(os.socket_connect, client, address(9997), 10) == OS_ERROR
    assert os.socket_connect(client, address(9997), 10)


def test_connected_datagram_socket_reports_once_that_its_peer_is_missing(bench: Bench) -> None:
    os, client = bench.os, bench.os.socket_open(INET, DATAGRAM)
    os.socket_connect(client, address(9997), 10)
    for call, arguments in ((os.timed_read, (client, 4, 0)), (os.timed_write, (client, b"x", 0))):
        assert os.write(client, b"lost") == 4
        assert status_of(call, *arguments) == OS_ERROR
        assert os.timed_read(client, 4, 0) is None


def test_shutdown(bench: Bench) -> None:
    os = bench.os
    server, client, served = connection(bench)
    os.socket_shutdown(client, OS_SocketShutdownMode_SHUT_READ)
    assert os.timed_read(client, 4, 10) == b""
    assert os.write(client, b"still") == 5
    os.socket_shutdown(client, OS_SocketShutdownMode_SHUT_WRITE)
    assert status_of(os.write, client, b"x") == OS_ERROR
    assert [os.read(served, 9), os.read(served, 9)] == [b"still", b""]
    os.socket_shutdown(client, OS_SocketShutdownMode_SHUT_READWRITE)
    for sock_id, mode, status in (
        (client, 0, OS_ERR_INVALID_ARGUMENT),
        (NO_SOCKET, 1, OS_ERR_INVALID_ID),
        (a_file(bench), 1, OS_ERR_INCORRECT_OBJ_TYPE),
        (server, 1, OS_ERR_INCORRECT_OBJ_STATE),
        (bound(bench, 5000), 1, OS_ERROR),
    ):
        assert status_of(os.socket_shutdown, sock_id, mode) == status


def test_waiting_connection_can_send_before_it_is_accepted(bench: Bench) -> None:
    server, client = bound(bench, 9997, STREAM), bench.os.socket_open(INET, STREAM)
    bench.os.socket_connect(client, address(9997))
    bench.os.write(client, b"early")
    accepted = bench.os.socket_accept(server, OS_CHECK)
    assert accepted is not None
    assert accepted[1] == address(32_768)
    assert bench.os.read(accepted[0], 9) == b"early"


def test_ten_connections_wait_to_be_accepted(bench: Bench) -> None:
    def use() -> list[bool]:
        server = bound(bench, 9997, STREAM)
        clients = [bench.os.socket_open(INET, STREAM) for _ in range(11)]
        connected = [bench.os.socket_connect(client, address(9997), 5) for client in clients]
        bench.os.socket_accept(server)
        return [*connected, bench.os.socket_connect(clients[-1], address(9997), 5)]

    assert bench.run(use) == [True] * 10 + [False, True]


def test_close_of_a_socket_that_waits_to_connect_is_an_error_in_a_safe_mission(safe_bench: Bench) -> None:
    bound(safe_bench, 9997, STREAM)
    clients = [safe_bench.os.socket_open(INET, STREAM) for _ in range(11)]
    for client in clients[:10]:
        safe_bench.os.socket_connect(client, address(9997))

    def close() -> None:
        safe_bench.os.task_delay(4)
        safe_bench.os.close(clients[10])

    safe_bench.task(
        lambda: safe_bench.log.append(status_of(safe_bench.os.socket_connect, clients[10], address(9997))), name="LATE"
    )
    safe_bench.run(close)
    assert safe_bench.log == [OS_ERR_INVALID_ID]


def test_wrong_states_of_streams(bench: Bench) -> None:
    os, file_id, loose = bench.os, a_file(bench), bench.os.socket_open(INET, STREAM)
    for unknown, status in (
        (0, OS_ERR_INVALID_ID),
        (NO_SOCKET, OS_ERR_INVALID_ID),
        (file_id, OS_ERR_INCORRECT_OBJ_TYPE),
        (bound(bench, 5000), OS_ERR_INCORRECT_OBJ_TYPE),
        (loose, OS_ERR_INCORRECT_OBJ_STATE),
    ):
        assert status_of(os.socket_accept, unknown, 0) == status
        assert status_of(os.socket_listen, unknown) == status
    server, client, _ = connection(bench)
    assert status_of(os.socket_listen, server) == OS_ERR_INCORRECT_OBJ_STATE
    assert status_of(os.socket_connect, client, address(9997), 0) == OS_ERR_INCORRECT_OBJ_STATE
    assert status_of(os.socket_bind, client, address(1)) == OS_ERR_INCORRECT_OBJ_STATE
    assert status_of(os.socket_connect, file_id, address(9997), 0) == OS_ERR_INCORRECT_OBJ_TYPE
    assert status_of(os.socket_connect, loose, None, 0) == OS_INVALID_POINTER
    assert status_of(os.socket_connect, loose, address(9997, "::1", INET6), 0) == OS_ERROR
    assert status_of(os.socket_connect, loose, address(1), 0) == OS_ERROR
    assert status_of(os.socket_connect, server, address(9997), 0) == OS_ERROR
    assert os.timed_read(server, 4, OS_CHECK) is os.timed_write(server, b"x", OS_CHECK) is None
    assert status_of(os.write, loose, b"x") == OS_ERROR
    os.socket_bind_address(loose, address(4))
    assert status_of(os.socket_accept, loose, 0) == OS_ERROR
    assert status_of(os.timed_read, client, 0, 0) == OS_ERR_INVALID_SIZE
    assert status_of(os.timed_read, NO_SOCKET, 4, 0) == OS_ERR_INVALID_ID
    assert os.timed_read(client, 4, OS_CHECK) is None


def test_closed_server_disconnects_waiting_clients(bench: Bench) -> None:
    server, client = bound(bench, 9997, STREAM), bench.os.socket_open(INET, STREAM)
    bench.os.socket_connect(client, address(9997))
    bench.os.close(server)
    assert status_of(bench.os.read, client, 9) == OS_ERROR
    assert bench.os.read(client, 9) == b""
    assert status_of(bench.os.socket_connect, bench.os.socket_open(INET, STREAM), address(9997)) == OS_ERROR
    bound(bench, 9997, STREAM)


def test_descriptors_run_out_before_a_connection_is_lost(bench: Bench) -> None:
    server, client = bound(bench, 9997, STREAM), bench.os.socket_open(INET, STREAM)
    bench.os.socket_connect(client, address(9997))
    more = [bench.os.socket_open(INET, STREAM) for _ in range(48)]
    assert status_of(bench.os.socket_accept, server, 0) == OS_ERR_NO_FREE_IDS
    bench.os.close(more[0])
    assert bench.os.socket_accept(server, OS_CHECK) is not None
