"""OS_Select*: the requirements of NASA's select-test."""

from __future__ import annotations

from cfepy.osal.limits import OS_CHECK
from cfepy.osal.network import STREAM_BUFFER
from cfepy.osal.sockets import OS_STREAM_STATE_READABLE, OS_STREAM_STATE_WRITABLE, FdSet
from cfepy.status import OS_ERR_INVALID_ID, OS_INVALID_POINTER
from tests.osal.helpers import MS, Bench
from tests.osal.sockets import DATAGRAM, INET, NO_SOCKET, STREAM, a_file, address, bound, connection
from tests.osal.test_queues import status_of

READ, WRITE = OS_STREAM_STATE_READABLE, OS_STREAM_STATE_WRITABLE


def fd_set(bench: Bench, *ids: int) -> FdSet:
    made = FdSet()
    for objid in ids:
        bench.os.select_fd_add(made, objid)
    return made


def members(bench: Bench, made: FdSet, *ids: int) -> list[bool]:
    return [bench.os.select_fd_is_set(made, objid) for objid in ids]


def test_a_set_is_filled_and_emptied(bench: Bench) -> None:
    ids = [bound(bench, port) for port in (1, 2, 3)]
    made = fd_set(bench, ids[2], ids[0], ids[2])
    assert members(bench, made, *ids) == [True, False, True]
    bench.os.select_fd_clear(made, ids[2])
    assert members(bench, made, *ids) == [True, False, False]
    bench.os.select_fd_zero(made)
    assert members(bench, made, *ids, 0) == [False] * 4


def test_wrong_arguments(bench: Bench) -> None:
    os, empty = bench.os, FdSet()
    assert status_of(os.select_fd_zero, None) == OS_INVALID_POINTER
    for call in (os.select_fd_add, os.select_fd_clear):
        assert status_of(call, None, bound(bench, 0)) == OS_INVALID_POINTER
        assert status_of(call, empty, 0) == OS_ERR_INVALID_ID
    assert status_of(os.select_single, NO_SOCKET, READ, 0) == OS_ERR_INVALID_ID
    assert status_of(os.select_multiple, empty, None, 0) == OS_ERR_INVALID_ID
    assert status_of(os.select_multiple, None, None, 0) == OS_ERR_INVALID_ID


def test_select_single_reports_a_readable_and_writable_socket(bench: Bench) -> None:
    def use() -> list[object]:
        os, sender = bench.os, bench.os.socket_open(INET, DATAGRAM)
        receiver = bound(bench, 5000)
        seen: list[object] = [os.select_single(receiver, 0), os.select_single(receiver, READ | WRITE)]
        seen += [os.select_single(receiver, READ, 30), bench.kernel.now // MS]
        os.socket_send_to(sender, b"x", address(5000))
        return [*seen, os.select_single(receiver, READ), os.select_single(receiver, READ | WRITE, OS_CHECK)]

    assert bench.run(use) == [0, WRITE, None, 30, READ, READ | WRITE]


def test_datagram_for_one_of_several_sockets_wakes_the_task(bench: Bench) -> None:
    receivers = [bound(bench, port) for port in (5000, 5001, 5002)]

    def send() -> None:
        bench.os.task_delay(12)
        bench.os.socket_send_to(bench.os.socket_open(INET, DATAGRAM), b"x", address(5001))

    def use() -> tuple[object, ...]:
        waiting = fd_set(bench, *receivers)
        early = bench.os.select_multiple(waiting, None, 5)
        unchanged = members(bench, waiting, *receivers)
        return early, unchanged, bench.os.select_multiple(waiting, None), members(bench, waiting, *receivers)

    bench.task(send)
    assert bench.run(use) == (False, [True] * 3, True, [False, True, False])
    assert bench.kernel.now >= 12 * MS


def test_server_is_readable_when_a_client_connects(bench: Bench) -> None:
    def connect() -> None:
        bench.os.task_delay(3)
        bench.os.socket_connect(bench.os.socket_open(INET, STREAM), address(9997))

    def use() -> tuple[object, int]:
        server = bound(bench, 9997, STREAM)
        return bench.os.select_single(server, READ), bench.kernel.now // MS

    bench.task(connect)
    assert bench.run(use) == (READ, 3)


def test_full_stream_is_not_writable_and_ended_stream_is_readable(bench: Bench) -> None:
    _, client, served = connection(bench)
    assert bench.os.write(client, bytes(STREAM_BUFFER)) == STREAM_BUFFER
    readers, writers = fd_set(bench, client, served), fd_set(bench, client, served)
    assert bench.os.select_multiple(readers, writers, OS_CHECK)
    assert members(bench, readers, client, served) == [False, True]
    assert members(bench, writers, client, served) == [False, True]
    bench.os.close(served)
    assert bench.os.select_single(client, READ | WRITE, OS_CHECK) == READ | WRITE


def test_files_are_always_ready(bench: Bench) -> None:
    file_id, silent = a_file(bench), bound(bench, 5000)
    assert bench.os.select_single(file_id, READ | WRITE, OS_CHECK) == READ | WRITE
    readers = fd_set(bench, file_id, silent)
    assert bench.os.select_multiple(readers, None)
    assert members(bench, readers, file_id, silent) == [True, False]


def test_socket_closed_during_select_is_reported_in_a_safe_mission(safe_bench: Bench) -> None:
    first, second = bound(safe_bench, 5000), bound(safe_bench, 5001)

    def close() -> None:
        safe_bench.os.task_delay(2)
        safe_bench.os.close(first)

    def use() -> tuple[object, int]:
        until = safe_bench.os.time_from_relative_milliseconds(9)
        ready = safe_bench.os.select_multiple_abs(fd_set(safe_bench, first, second), None, until)
        return ready, safe_bench.kernel.now // MS

    safe_bench.task(close)
    safe_bench.task(lambda: safe_bench.log.append(status_of(safe_bench.os.select_single, first, READ)), name="single")
    assert safe_bench.run(use) == (False, 9)
    assert safe_bench.log == [OS_ERR_INVALID_ID]
