"""The routing table alone: ids, throttled walks, sequence counts, and its answers to invalid ids."""

from __future__ import annotations

import pytest

from cfepy.rtos import Kernel
from cfepy.sb.pipe import Pipe
from cfepy.sb.routing import INVALID_MSG_ID, INVALID_ROUTE_ID, Destination, Route, RoutingTable, Throttle


@pytest.fixture
def table() -> RoutingTable:
    table = RoutingTable(capacity=3, highest=0x1FFF)
    assert [table.add_route(msg_id) for msg_id in (0x1803, 0x0801, 0x1806)] == [1, 2, 3]
    return table


def test_routes_keep_their_order(table: RoutingTable) -> None:
    seen: list[int] = []
    table.for_each_route_id(lambda route_id: seen.append(table.get_msg_id(route_id)))
    assert seen == [0x1803, 0x0801, 0x1806]
    assert table.get_route_id(0x0801) == 2
    assert table.route_id_to_value(2) == 1
    assert table.value_to_route_id(1) == 2


def test_full_table_and_invalid_msg_ids_have_no_route(table: RoutingTable) -> None:
    assert table.add_route(0x0802) == INVALID_ROUTE_ID
    assert RoutingTable(3, 0x1FFF).add_route(0x2000) == INVALID_ROUTE_ID
    assert table.get_route_id(0x0802) == INVALID_ROUTE_ID


@pytest.mark.parametrize(("start", "count", "seen", "following"), [(0, 1, [1], 1), (1, 1, [2], 2), (1, 9, [2, 3], 0)])
def test_a_throttled_walk(table: RoutingTable, start: int, count: int, seen: list[int], following: int) -> None:
    got: list[int] = []
    throttle = Throttle(start, count)
    table.for_each_route_id(got.append, throttle)
    assert got == seen
    assert throttle.following == following


def test_sequence_counts_wrap_after_14_bits(table: RoutingTable) -> None:
    assert table.get_sequence_counter(1) == 0
    table.increment_sequence_counter(1)
    assert table.get_sequence_counter(1) == 1
    table.routes[0x1803].sequence = 0x3FFF
    table.increment_sequence_counter(1)
    assert table.get_sequence_counter(1) == 0


def test_destinations_can_be_replaced(table: RoutingTable) -> None:
    kernel = Kernel("thread")
    destinations = [Destination(Pipe(kernel, 1, name, None), 4, 1) for name in ("A", "B")]
    table.set_dest_list_head_ptr(2, destinations)
    assert table.get_dest_list_head_ptr(2) == destinations
    assert table.routes[0x0801].active == tuple(destinations)
    kernel.shutdown()


@pytest.mark.parametrize("route_id", [INVALID_ROUTE_ID, -1, 4])
def test_invalid_route_ids_are_refused(table: RoutingTable, route_id: int) -> None:
    table.increment_sequence_counter(route_id)
    table.set_dest_list_head_ptr(route_id, [])
    assert table.get_msg_id(route_id) == INVALID_MSG_ID
    assert table.get_dest_list_head_ptr(route_id) == []
    assert table.get_sequence_counter(route_id) == 0
    assert not table.is_valid_route_id(route_id)


def test_init_removes_all_routes(table: RoutingTable) -> None:
    table.init()
    assert table.get_route_id(0x1803) == INVALID_ROUTE_ID
    assert table.add_route(0x1806) == 1
    assert table.is_valid_route_id(1)


def test_totals_of_ended_subscriptions_take_no_memory() -> None:
    kernel = Kernel("thread")
    route = Route(0x0801, 1)
    for number in range(100):
        destination = Destination(Pipe(kernel, 1, f"P{number}", None), 4, 1)
        route.add(destination)
        destination.puts, destination.gets, destination.limit_drops, destination.overflow_drops = 3, 2, 1, 5
        if number % 2:
            destination.gets = 3
        else:
            destination.pipe.depth = 0  # deleted, with a message in it
        route.remove(destination)
    assert len(route.gone) == 1
    assert route.totals() == (250, 50, 100, 500)
    kernel.shutdown()


def test_message_read_after_the_end_of_a_subscription_counts() -> None:
    kernel = Kernel("thread")
    route = Route(0x0801, 1)
    late, other = (Destination(Pipe(kernel, 1, name, None), 4, 1) for name in ("A", "B"))
    for destination in (late, other):
        destination.puts = 1
        route.add(destination)
        route.remove(destination)
    late.gets = 1
    assert route.totals() == (1, 1, 0, 0)
    kernel.shutdown()
