"""Datagrams to and from a flight computer, over the loopback interface."""

from __future__ import annotations

import pytest

from cfepy.io.udp import UdpListener, own_address, send
from cfepy.status import UsageError


def test_datagrams_arrive_in_order() -> None:
    with UdpListener("127.0.0.1", 0) as listener:
        send("127.0.0.1", listener.port, b"one")
        send("127.0.0.1", listener.port, b"two")
        assert (listener.receive(5), listener.receive(5)) == (b"one", b"two")
        assert listener.receive(0.001) is None
        with pytest.raises(UsageError, match=f"127.0.0.1:{listener.port}: cannot listen there: .*; give another port"):
            UdpListener("127.0.0.1", listener.port)


def test_send_reports_that_no_program_listens_on_the_local_host() -> None:
    with UdpListener("127.0.0.1", 0) as listener:
        assert send("127.0.0.1", listener.port, b"one")
    assert not send("127.0.0.1", listener.port, b"two")


def test_unknown_hosts_are_reported() -> None:
    assert own_address("127.0.0.1") == "127.0.0.1"
    for call in (own_address, lambda host: send(host, 1, b"")):
        with pytest.raises(UsageError, match=r"no\.such\.host\.invalid"):
            call("no.such.host.invalid")
