"""The virtual network against models of a few lines: streams are bytes in order, mailboxes queues with a limit."""

from __future__ import annotations

from collections import deque

from hypothesis import given
from hypothesis import strategies as st

from cfepy.osal.network import (
    DATAGRAM_BUFFER,
    DATAGRAM_OVERHEAD,
    STREAM_BUFFER,
    BoundEndpoints,
    Datagram,
    Listener,
    Mailbox,
    Place,
)

HERE, THERE = Place("127.0.0.1", 1), Place("127.0.0.1", 2)
HOSTS = ("0.0.0.0", "127.0.0.1", "127.0.0.2", "::", "::1")


@given(st.lists(st.tuples(st.booleans(), st.integers(1, STREAM_BUFFER + 10)), max_size=30), st.booleans())
def test_stream_is_read_in_the_order_of_writing(steps: list[tuple[bool, int]], closes: bool) -> None:
    listener = Listener()
    near = listener.connect(HERE, THERE)
    far = listener.accept()
    taken, given_back = bytearray(), bytearray()
    for number, (writes, size) in enumerate(steps):
        if writes:
            data = bytes([number]) * size
            count = near.write(data)
            assert count == min(size, STREAM_BUFFER - (len(taken) - len(given_back)))
            taken += data[:count]
        else:
            given_back += far.read(size)
        assert far.readable == (len(taken) > len(given_back))
        assert near.writable == (len(taken) - len(given_back) < STREAM_BUFFER)
    if closes:
        near.close()
    given_back += far.read(STREAM_BUFFER)
    assert given_back == taken
    assert far.readable == closes


@given(st.lists(st.one_of(st.none(), st.integers(0, 60_000)), max_size=60))
def test_a_mailbox_is_a_queue_with_a_limit(steps: list[int | None]) -> None:
    mailbox, model = Mailbox(), deque[Datagram]()
    for number, size in enumerate(steps):
        if size is not None:
            datagram = Datagram(HERE, THERE, bytes([number]) * size)
            used = sum(len(one.data) + DATAGRAM_OVERHEAD for one in model)
            fits = used + size + DATAGRAM_OVERHEAD <= DATAGRAM_BUFFER
            assert mailbox.offer(datagram) == fits
            model.extend([datagram] if fits else [])
        elif model:
            assert mailbox.take() == model.popleft()
        assert mailbox.readable == bool(model)


@given(st.lists(st.tuples(st.sampled_from(HOSTS), st.integers(1, 3), st.booleans()), max_size=25))
def test_place_has_one_owner(steps: list[tuple[str, int, bool]]) -> None:
    ports: BoundEndpoints[Mailbox] = BoundEndpoints(shares=False)
    owners: dict[Place, Mailbox] = {}
    for host, port, binds in steps:
        place = Place(host, port)
        if binds:
            mailbox = Mailbox()
            rivals = [other for other in owners if (other.port, other.is_ip6) == (port, place.is_ip6)]
            free = not any(place.any_host in (other.host, host) or other == place for other in rivals)
            assert (ports.bind(mailbox, place) is not None) == free
            if free:
                owners[place] = mailbox
        elif place in owners:
            ports.release(owners.pop(place))
        for reached in (Place(host, port).reached(), Place("127.0.0.3", port)):
            expected = owners.get(reached, owners.get(Place(reached.any_host, port)))
            assert ports.find(reached) is expected
