"""The times at which a client gets messages; messages in pieces."""

from __future__ import annotations

import pytest

from cfepy.extra.viewers.rosbridge import sending
from cfepy.extra.viewers.rosbridge.fragments import Assembly, fragments
from cfepy.extra.viewers.rosbridge.sending import Pacing, Wish
from cfepy.status import UsageError


def _paced(*wishes: Wish) -> Pacing[int]:
    pacing: Pacing[int] = Pacing()
    for name, wish in enumerate(wishes):
        pacing.want(name, wish)
    return pacing


def test_all_messages_are_sent_at_once_without_a_rate() -> None:
    pacing = _paced(Wish())
    assert [pacing.add(each, 0.0) for each in range(3)] == [0, 1, 2]
    assert pacing.due(9.0) is None


def test_rate_drops_messages_that_come_too_early() -> None:
    pacing = _paced(Wish(throttle_ms=100))
    assert [pacing.add(each, each * 0.06) for each in range(5)] == [0, None, 2, None, 4]
    assert pacing.due(9.0) is None
    assert pacing.dropped == 0, "as asked for"


def test_a_queue_keeps_the_newest_for_their_time() -> None:
    pacing = _paced(Wish(throttle_ms=100, queue_length=2))
    assert [pacing.add(each, 0.0) for each in range(5)] == [0, None, None, None, None]
    assert pacing.dropped == 2
    assert [pacing.due(at_s) for at_s in (0.05, 0.1, 0.15, 0.2, 0.3)] == [None, 3, None, 4, None]


def test_waiting_messages_are_sent_first() -> None:
    pacing = _paced(Wish(throttle_ms=100, queue_length=2))
    assert pacing.add(0, 0.0) == 0
    assert pacing.add(1, 0.0) is None
    assert pacing.add(2, 0.2) is None
    assert pacing.due(0.2) == 1


def test_several_subscriptions_share_the_fastest_pace() -> None:
    pacing = _paced(Wish(200, 5, "png"), Wish(100, 3, "cbor"), Wish(300, 4, "no such"))
    assert pacing.compression == "cbor"
    assert pacing.add(0, 0.0) == 0
    assert pacing.add(1, 0.05) is None
    assert pacing.due(0.1) == 1
    assert not pacing.want_no_more(1)
    assert pacing.compression == "png"
    assert pacing.add(2, 0.15) is None
    assert pacing.due(0.25) is None
    assert pacing.want_no_more(None)


@pytest.mark.parametrize("size", [1, 7, 100])
def test_pieces_make_the_text_again_in_any_order(size: int) -> None:
    text = '{"op": "x", "data": "caf\u00e9"}'
    for order in (1, -1):
        assembly = Assembly(100)
        pieces = list(fragments(text, size, "id"))[::order]
        found = [assembly.add(each, 0.0) for each in pieces]
        assert found == [*[None] * (len(pieces) - 1), text]


def test_too_large_or_too_many_incomplete_messages_are_refused() -> None:
    assembly = Assembly(10)
    with pytest.raises(UsageError, match="more than 10 characters"):
        assembly.add({"id": 1, "num": 0, "total": 2, "data": "x" * 11}, 0.0)
    for each in range(2):
        assembly.add({"id": each, "num": 0, "total": 2, "data": "x" * 4}, 0.0)
    with pytest.raises(UsageError, match="more than 10 characters"):
        assembly.add({"id": 2, "num": 0, "total": 2, "data": "x" * 4}, 0.0)
    assembly = Assembly(10)
    for each in range(16):
        assembly.add({"id": each, "num": 0, "total": 2, "data": ""}, 0.0)
    with pytest.raises(UsageError, match="with 16 incomplete messages"):
        assembly.add({"id": 16, "num": 0, "total": 2, "data": ""}, 0.0)
    assert assembly.add({"id": 16, "num": 0, "total": 1, "data": "y"}, 601.0) == "y", "the others were given up"


@pytest.mark.parametrize("now_s", [0.0, 1.0, 599.0, 1e6])
def test_refused_piece_takes_no_place(now_s: float) -> None:
    assembly = Assembly(10)
    for name in range(40):
        with pytest.raises(UsageError, match="append fragment 2"):
            assembly.add({"id": name, "num": 2, "total": 2, "data": ""}, now_s)
    assert assembly.add({"id": 0, "num": 0, "total": 1, "data": "y"}, now_s) == "y"


def test_messages_that_wait_are_bounded_in_bytes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sending, "MOST_QUEUED_BYTES", 10)
    pacing = Pacing[bytes](len)
    pacing.want(None, Wish(1000, 100))
    assert pacing.add(b"first", 0.0) == b"first"
    for each in (b"1234", b"5678", b"9abc"):
        assert pacing.add(each, 0.1) is None
    assert pacing.dropped == 1
    assert pacing.due(1.0) == b"5678"
    for _ in range(3):
        pacing.add(b"wxyz", 1.1)
    assert pacing.due(2.0) == b"wxyz"
