"""OS_Socket*: the requirements of NASA's network-api-test, and further guarantees of a network in virtual time."""

from __future__ import annotations

from functools import partial

import pytest

from cfepy.osal import Osal
from cfepy.osal.limits import OS_CHECK
from cfepy.osal.network import DATAGRAM_BUFFER, DATAGRAM_OVERHEAD, Datagram, Network, Place
from cfepy.osal.sockaddr import OS_SocketDomain_INVALID, SockAddr
from cfepy.osal.sockets import (
    NoName,
    OS_socket_option_IP_DSCP,
    OS_socket_option_UNDEFINED,
)
from cfepy.rtos import CpuCosts
from cfepy.status import (
    OS_ERR_BAD_ADDRESS,
    OS_ERR_EMPTY_SET,
    OS_ERR_INCORRECT_OBJ_STATE,
    OS_ERR_INCORRECT_OBJ_TYPE,
    OS_ERR_INVALID_ARGUMENT,
    OS_ERR_INVALID_ID,
    OS_ERR_INVALID_SIZE,
    OS_ERR_NAME_NOT_FOUND,
    OS_ERR_NAME_TOO_LONG,
    OS_ERR_NOT_IMPLEMENTED,
    OS_ERR_OPERATION_NOT_SUPPORTED,
    OS_ERR_TRY_AGAIN,
    OS_ERROR,
    OS_INVALID_POINTER,
    OsalError,
)
from tests.osal.helpers import MS, Bench
from tests.osal.sockets import DATAGRAM, INET, INET6, NO_SOCKET, STREAM, a_file, address, bound, connection
from tests.osal.test_queues import status_of

# -- addresses -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("domain", "text"), [(INET, "localhost"), (INET, "10.1.2.3"), (INET6, "::1"), (INET6, "fe80::2")]
)
def test_an_address_is_filled_in_step_by_step(bench: Bench, domain: int, text: str) -> None:
    addr = bench.os.socket_addr_init(domain)
    assert bench.os.socket_addr_to_string(addr) == {INET: "0.0.0.0", INET6: "::"}[domain]
    bench.os.socket_addr_set_port(addr, 1234)
    bench.os.socket_addr_from_string(addr, text)
    assert (bench.os.socket_addr_to_string(addr), bench.os.socket_addr_get_port(addr)) == (text, 1234)


@pytest.mark.parametrize(
    ("text", "host"),
    [
        *(("127.1", "localhost"), ("0x7f000001", "localhost"), ("0177.0.0.1", "localhost"), ("010.1.2.3", "8.1.2.3")),
        *(("1.2.65535", "1.2.255.255"), ("4294967295", "255.255.255.255"), ("0", "0.0.0.0")),
    ],
)
def test_numbers_of_an_address_are_read_as_the_c_library_reads_them(bench: Bench, text: str, host: str) -> None:
    addr = bench.os.socket_addr_init(INET)
    bench.os.socket_addr_from_string(addr, text)
    assert bench.os.socket_addr_to_string(addr) == host


@pytest.mark.parametrize("text", ["nohost", "256.0.0.1", "1.2.3.4.5", "1.2.3.4x", "1.2.3.", "09.1", "0x"])
def test_name_of_a_host_requires_a_name_server(bench: Bench, text: str) -> None:
    addr = bench.os.socket_addr_init(INET)
    assert status_of(bench.os.socket_addr_from_string, addr, text) == OS_ERR_TRY_AGAIN
    assert bench.os.socket_addr_to_string(addr) == "0.0.0.0"


@pytest.mark.parametrize("text", ["::1", "", " ", "127.0.0.1 ", "1..2", "-1", "bad name", "\u0661.1.1.1"])
def test_text_that_cannot_be_a_name_of_a_host_is_refused(bench: Bench, text: str) -> None:
    addr = bench.os.socket_addr_init(INET)
    assert status_of(bench.os.socket_addr_from_string, addr, text) == OS_ERR_EMPTY_SET
    assert bench.os.socket_addr_to_string(addr) == "0.0.0.0"


@pytest.mark.parametrize("text", ["1.2.3.4", "localhost", "fe80::1%lo"])
def test_address_of_another_domain_is_refused(bench: Bench, text: str) -> None:
    assert status_of(bench.os.socket_addr_from_string, bench.os.socket_addr_init(INET6), text) == OS_ERR_EMPTY_SET


@pytest.mark.parametrize("kind", [DATAGRAM, STREAM])
def test_socket_is_not_bound_to_an_address_of_another_domain(bench: Bench, kind: int) -> None:
    sock_id = bench.os.socket_open(INET, kind)
    assert status_of(bench.os.socket_bind, sock_id, SockAddr(INET6, "::1", 9999)) == OS_ERROR
    bench.os.socket_bind(sock_id, address(9999))


def test_addresses_without_domain_and_missing_ones(bench: Bench) -> None:
    os, empty = bench.os, SockAddr()
    assert status_of(os.socket_addr_init, OS_SocketDomain_INVALID) == OS_ERR_NOT_IMPLEMENTED
    assert status_of(os.socket_addr_set_port, empty, 0xFFFF) == OS_ERR_BAD_ADDRESS
    assert status_of(os.socket_addr_get_port, empty) == OS_ERR_BAD_ADDRESS
    assert status_of(os.socket_addr_to_string, empty) == OS_ERR_BAD_ADDRESS
    assert status_of(os.socket_addr_from_string, empty, "127.0.0.1") == OS_ERR_BAD_ADDRESS
    for call in (os.socket_addr_to_string, os.socket_addr_get_port):
        assert status_of(call, None) == OS_INVALID_POINTER
    assert status_of(os.socket_addr_from_string, None, "127.0.0.1") == OS_INVALID_POINTER
    assert status_of(os.socket_addr_set_port, None, 1) == OS_INVALID_POINTER
    assert status_of(os.socket_addr_set_port, os.socket_addr_init(INET), 0x10000) == OS_ERR_INVALID_ARGUMENT


# -- datagrams -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("domain", "host"), [(INET, "127.0.0.1"), (INET6, "::1")])
def test_datagrams_both_ways(bench: Bench, domain: int, host: str) -> None:
    first, second = bound(bench, 9999, DATAGRAM, host, domain), bound(bench, 9998, DATAGRAM, host, domain)
    assert bench.os.socket_send_to(first, b"ping", address(9998, host, domain)) == 4
    assert bench.os.socket_recv_from(second, 10) == (b"ping", address(9999, host, domain))
    assert bench.os.socket_send_to(second, b"pong", address(9999, host, domain)) == 4
    assert bench.os.socket_recv_from(first, 10) == (b"pong", address(9998, host, domain))


def test_datagrams_keep_their_order_and_borders(bench: Bench) -> None:
    sender, receiver = bench.os.socket_open(INET, DATAGRAM), bound(bench, 5000)
    sent = [bytes([number]) * (number + 1) for number in range(20)]
    for data in sent:
        bench.os.socket_send_to(sender, data, address(5000))
    assert [bench.os.socket_recv_from(receiver, 10)[0] for _ in sent] == [data[:10] for data in sent]  # type: ignore[index]
    assert bench.os.socket_recv_from(receiver, 10, OS_CHECK) is None


def test_a_receiver_waits_in_virtual_time(bench: Bench) -> None:
    def receive() -> list[object]:
        sock_id = bound(bench, 5000)
        return [(bench.os.socket_recv_from(sock_id, 9, ms), bench.kernel.now // MS) for ms in (5, OS_CHECK, 50, -1)]

    def send() -> None:
        sock_id = bench.os.socket_open(INET, DATAGRAM)
        for text in (b"one", b"two"):
            bench.os.task_delay(20)
            bench.os.socket_send_to(sock_id, text, address(5000))

    bench.task(send)
    outcome = bench.run(receive)
    assert [(data and data[0], when) for data, when in outcome] == [(None, 5), (None, 5), (b"one", 20), (b"two", 40)]


def test_absolute_time_outs(bench: Bench) -> None:
    def receive() -> tuple[object, int]:
        sock_id = bound(bench, 5000)
        until = bench.os.time_from_relative_milliseconds(30)
        bench.os.task_delay(10)
        return bench.os.socket_recv_from_abs(sock_id, 9, until), bench.kernel.now // MS

    assert bench.run(receive) == (None, 30)


def test_socket_bound_to_all_hosts_gets_datagrams_for_any_host(bench: Bench) -> None:
    receiver, sender = bound(bench, 5000, host="0.0.0.0"), bound(bench, 5001, host="0.0.0.0")
    for host in ("127.0.0.1", "127.0.0.9", "0.0.0.0"):
        bench.os.socket_send_to(sender, host.encode(), address(5000, host))
        assert bench.os.socket_recv_from(receiver, 20, OS_CHECK) == (host.encode(), address(5001))


def test_datagram_without_a_receiver_is_lost_or_leaves_the_network(bench: Bench) -> None:
    sender, seen = bound(bench, 5001), []
    assert bench.os.socket_send_to(sender, b"x", address(5000)) == 1
    bench.os.network.outlets.append(seen.append)
    assert bench.os.socket_send_to(sender, b"y", address(5000, "10.0.0.7")) == 1
    assert seen == [Datagram(Place("127.0.0.1", 5001), Place("10.0.0.7", 5000), b"y")]


def test_full_mailbox_drops_the_newest_datagram(bench: Bench) -> None:
    sender, receiver = bench.os.socket_open(INET, DATAGRAM), bound(bench, 5000)
    room = DATAGRAM_BUFFER // (1 + DATAGRAM_OVERHEAD)
    for number in range(room + 3):
        bench.os.socket_send_to(sender, bytes([number & 0xFF]), address(5000))
    numbers = [bench.os.socket_recv_from(receiver, 1, OS_CHECK) for _ in range(room)]
    assert [data[0][0] for data in numbers if data] == [number & 0xFF for number in range(room)]
    assert bench.os.socket_recv_from(receiver, 1, OS_CHECK) is None


def test_connected_datagram_socket_has_one_peer(bench: Bench) -> None:
    first, second, third = bound(bench, 5001), bound(bench, 5002), bound(bench, 5003)
    assert bench.os.socket_connect(first, address(5002))
    assert bench.os.write(first, b"hello") == 5
    assert bench.os.socket_recv_from(second, 9, OS_CHECK) == (b"hello", address(5001))
    bench.os.socket_send_to(third, b"not you", address(5001))
    bench.os.socket_send_to(second, b"you", address(5001))
    assert bench.os.timed_read(first, 9, OS_CHECK) == b"you"
    assert bench.os.timed_read(first, 9, OS_CHECK) is None


def test_wrong_arguments_for_datagrams(bench: Bench) -> None:
    os, file_id, loose = bench.os, a_file(bench), bench.os.socket_open(INET, DATAGRAM)
    sock_id, stream = bound(bench, 9998), bench.os.socket_open(INET, STREAM)
    for unknown, status in (
        (0, OS_ERR_INVALID_ID),
        (NO_SOCKET, OS_ERR_INVALID_ID),
        (file_id, OS_ERR_INCORRECT_OBJ_TYPE),
    ):
        assert status_of(os.socket_bind, unknown, address(1)) == status
        assert status_of(os.socket_recv_from, unknown, 4, 0) == status
        assert status_of(os.socket_send_to, unknown, b"1", address(1)) == status
    assert status_of(os.socket_recv_from, stream, 4, 0) == OS_ERR_INCORRECT_OBJ_TYPE
    assert status_of(os.socket_send_to, stream, b"1", address(1)) == OS_ERR_INCORRECT_OBJ_TYPE
    assert status_of(os.socket_recv_from, loose, 4, 0) == OS_ERR_INCORRECT_OBJ_STATE
    assert status_of(os.socket_recv_from, sock_id, 0, 0) == OS_ERR_INVALID_SIZE
    assert status_of(os.socket_send_to, sock_id, b"", address(1)) == OS_ERR_INVALID_SIZE
    assert status_of(os.socket_send_to, sock_id, bytes(65_508), address(1)) == OS_ERROR
    assert status_of(os.socket_send_to, sock_id, b"1", None) == OS_INVALID_POINTER
    assert status_of(os.socket_send_to, sock_id, b"1", SockAddr(9)) == OS_ERR_BAD_ADDRESS
    assert status_of(os.socket_send_to, sock_id, b"1", SockAddr()) == OS_ERROR  # the kernel's answer, not OSAL's
    assert status_of(os.socket_connect, sock_id, SockAddr()) == OS_ERROR
    assert status_of(os.socket_send_to, sock_id, b"1", address(1, "::1", INET6)) == OS_ERROR
    assert status_of(os.socket_open, INET, 3) == OS_ERR_NOT_IMPLEMENTED
    assert status_of(os.socket_open, 3, DATAGRAM) == OS_ERR_NOT_IMPLEMENTED


def test_binding(bench: Bench) -> None:
    os, sock_id = bench.os, bound(bench, 9998)
    other = os.socket_open(INET, DATAGRAM)
    assert status_of(os.socket_bind, sock_id, address(9998)) == OS_ERR_INCORRECT_OBJ_STATE
    assert status_of(os.socket_bind, other, None) == OS_INVALID_POINTER
    assert status_of(os.socket_bind, other, SockAddr()) == OS_ERR_BAD_ADDRESS
    assert status_of(os.socket_bind, other, address(9998, "10.0.0.1")) == OS_ERROR


def test_of_datagram_sockets_at_one_port_the_most_specific_and_newest_receives(bench: Bench) -> None:
    os, sender = bench.os, bench.os.socket_open(INET, DATAGRAM)
    everywhere, old, new = bound(bench, 9998, host="0.0.0.0"), bound(bench, 9998), bound(bench, 9998)
    received: list[int] = []
    for closed in (new, old, everywhere):
        os.socket_send_to(sender, b"1", address(9998))
        received += [each for each in (everywhere, old, new) if _gets(os, each)]
        os.close(closed)
    assert received == [new, old, everywhere]


def _gets(os: Osal, sock_id: int) -> bool:
    try:
        return os.socket_recv_from(sock_id, 9, OS_CHECK) is not None
    except OsalError:  # it is closed
        return False


def test_the_id_of_a_socket_is_looked_at_before_the_address(bench: Bench) -> None:
    os = bench.os
    assert status_of(os.socket_send_to, NO_SOCKET, b"1", SockAddr()) == OS_ERR_INVALID_ID
    assert status_of(os.socket_bind_address, NO_SOCKET, SockAddr()) == OS_ERR_INVALID_ID
    assert status_of(os.socket_connect, NO_SOCKET, SockAddr()) == OS_ERR_INVALID_ID
    assert status_of(os.socket_send_to, a_file(bench), b"1", SockAddr()) == OS_ERR_INCORRECT_OBJ_TYPE
    assert status_of(os.socket_bind_address, bound(bench, 9), SockAddr()) == OS_ERR_INCORRECT_OBJ_STATE


def test_port_0_is_any_free_port(bench: Bench) -> None:
    bound(bench, 32_768)
    first, second, receiver = bound(bench, 0), bound(bench, 0), bound(bench, 5000)
    for sock_id in (first, second):
        bench.os.socket_send_to(sock_id, b"x", address(5000))
    ports = [bench.os.socket_recv_from(receiver, 1, OS_CHECK)[1].port for _ in range(2)]  # type: ignore[index]
    assert ports == [32_769, 32_770]


def test_task_waiting_at_a_closed_socket_gets_an_error_in_a_safe_mission(safe_bench: Bench) -> None:
    sock_id = bound(safe_bench, 5000)

    def receive() -> None:
        safe_bench.log.append((status_of(safe_bench.os.socket_recv_from, sock_id, 9), safe_bench.kernel.now // MS))

    def close() -> None:
        safe_bench.os.task_delay(7)
        safe_bench.os.close(sock_id)

    safe_bench.task(receive)
    safe_bench.run(close)
    assert safe_bench.log == [(OS_ERR_INVALID_ID, 7)]


def test_two_processors_exchange_datagrams_on_one_network() -> None:
    network = Network()
    first, second = Bench(network=network), Bench(network=network)
    with first.kernel, second.kernel:
        receiver = bound(second, 1235)
        first.os.socket_send_to(first.os.socket_open(INET, DATAGRAM), b"hello", address(1235))
        first.os.delete_all_objects()
        assert second.os.socket_recv_from(receiver, 9, OS_CHECK) == (b"hello", address(32_768))
        assert [port for _, port in network.datagrams.bound] == [1235]


# -- facts, options, descriptors ---------------------------------------------------------------------------------------


def test_names_and_facts(bench: Bench) -> None:
    os, sock_id = bench.os, bound(bench, 9999)
    assert os.socket_get_info(sock_id) == ("localhost:9999", 0)
    assert os.socket_get_id_by_name("localhost:9999") == sock_id
    assert os.get_resource_name(sock_id) == "localhost:9999"
    _, _, served = connection(bench)
    assert os.get_resource_name(served) == "localhost:32768-localhost:9997"
    assert os.socket_get_info(served).name == "localhost:32768-loc"
    assert status_of(os.socket_get_id_by_name, "NF") == OS_ERR_NAME_NOT_FOUND
    assert status_of(os.socket_get_id_by_name, "N" * 20) == OS_ERR_NAME_TOO_LONG
    assert status_of(os.socket_get_info, NO_SOCKET) == OS_ERR_INVALID_ID
    assert os.socket_get_info(a_file(bench)).name == "/ram/test.txt"


def test_facts_about_a_socket_without_address_end_the_process_as_on_linux(bench: Bench) -> None:
    os, caught = bench.os, []

    def ask() -> None:
        for sock_id in (os.socket_open(INET, STREAM), os.socket_open(INET, DATAGRAM)):
            with pytest.raises(NoName) as failure:
                os.socket_get_info(sock_id)
            caught.append(failure.value.ends_process)

    bench.run(ask)
    assert caught == [True, True]


def test_facts_about_a_socket_without_address_are_given_in_a_safe_mission(safe_bench: Bench) -> None:
    os = safe_bench.os
    assert safe_bench.run(lambda: os.socket_get_info(os.socket_open(INET, STREAM)).creator == os.task_get_id())


def test_options(bench: Bench) -> None:
    os, sock_id, file_id = bench.os, bound(bench, 9999), a_file(bench)
    assert os.socket_get_option(sock_id, OS_socket_option_IP_DSCP) == 0
    os.socket_set_option(sock_id, OS_socket_option_IP_DSCP, 0x44)
    os.socket_set_option(sock_id, OS_socket_option_UNDEFINED, 7)
    assert os.socket_get_option(sock_id, OS_socket_option_IP_DSCP) == 0x04
    assert os.socket_get_option(sock_id, OS_socket_option_UNDEFINED) == 0
    assert status_of(os.socket_get_option, NO_SOCKET, 0) == OS_ERR_INVALID_ID
    assert status_of(os.socket_set_option, NO_SOCKET, 0, 0) == OS_ERR_INVALID_ID
    assert status_of(os.socket_get_option, sock_id, 2) == OS_ERR_INVALID_ARGUMENT
    assert status_of(os.socket_set_option, sock_id, 2, 0) == OS_ERR_INVALID_ARGUMENT
    assert status_of(os.socket_get_option, file_id, OS_socket_option_IP_DSCP) == OS_ERROR


def test_seek_is_refused_on_sockets_and_timed_io_works_on_files(bench: Bench) -> None:
    sock_id = bound(bench, 9999)
    assert status_of(bench.os.lseek, sock_id, 0, 0) == OS_ERR_OPERATION_NOT_SUPPORTED
    file_id = a_file(bench)
    assert bench.os.timed_write(file_id, b"text", 5) == 4
    bench.os.lseek(file_id, 0, 0)
    assert bench.os.timed_read(file_id, 9, 5) == b"text"


def test_the_sockets_of_an_ended_application_are_closed(bench: Bench) -> None:
    owner = object()
    bench.task(lambda: bound(bench, 1234), owner=owner)
    bench.kernel.run(MS)
    assert bench.os.delete_objects_of(owner) == []
    bound(bench, 1234)


# -- determinism -------------------------------------------------------------------------------------------------------


def test_traffic_of_many_tasks_is_the_same_on_threads_and_greenlets() -> None:
    assert crowd("thread") == crowd("greenlet")


def crowd(context: str) -> tuple[str, list[object]]:
    """Run four tasks of equal priority that echo to each other.

    Returns the trace's digest, and the receptions with times.
    """
    bench = Bench(context=context)
    os = bench.os

    def talk(number: int) -> None:
        sock_id = bound(bench, 5000 + number)
        os.task_delay(1)
        for turn in range(10):
            os.socket_send_to(sock_id, bytes([number, turn]), address(5000 + (number + turn) % 4))
            received = os.socket_recv_from(sock_id, 9, number + turn)
            bench.log.append((number, bench.kernel.now, received and received[0]))

    with bench.kernel as kernel:
        for number in range(4):
            bench.task(partial(talk, number), name=f"TALK{number}")
        kernel.run(1_000 * MS)
        assert kernel.trace is not None
        return kernel.trace.digest(), bench.log


def test_socket_closed_while_it_sends_keeps_no_port() -> None:
    bench = Bench(costs=CpuCosts(byte_ps=1_000_000))
    sock = bench.os.socket_open(INET, DATAGRAM)
    statuses: list[int] = []

    def sender() -> None:
        statuses.append(status_of(lambda: bench.os.socket_send_to(sock, bytes(1000), address(9990))))

    def closer() -> None:
        bench.kernel.delay(MS // 2)
        bench.os.close(sock)

    bench.task(sender, 100)
    bench.task(closer, 50)
    bench.kernel.run(until_ns=10 * MS)
    assert statuses == [OS_ERR_INVALID_ID]
    assert not bench.os.network.datagrams.bound
    bench.kernel.shutdown()
