"""Ports for programs that must be given one."""

from __future__ import annotations

import socket

import pytest

from dev.host_ports import LOWEST, first_picked, free_port


@pytest.mark.parametrize("kind", [socket.SOCK_STREAM, socket.SOCK_DGRAM])
def test_free_port_is_below_the_ports_picked_by_the_system(kind: socket.SocketKind) -> None:
    ports = {free_port(kind) for _ in range(50)}
    assert len(ports) > 40
    assert all(LOWEST <= port < first_picked() for port in ports)
    for port in ports:
        with socket.socket(socket.AF_INET, kind) as opened:
            opened.bind(("127.0.0.1", port))


def test_port_in_use_is_skipped(monkeypatch: pytest.MonkeyPatch) -> None:
    numbers = iter([0, 1])
    with socket.socket() as taken:
        free = free_port()
        taken.bind(("127.0.0.1", free_port()))
        wanted = (taken.getsockname()[1], free)
        monkeypatch.setattr("dev.host_ports._any_number", lambda *limits: wanted[next(numbers)])
        assert free_port() == free


def test_ports_picked_by_the_system_are_higher() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server, socket.create_connection(server.getsockname()) as client:
        assert all(each.getsockname()[1] >= first_picked() for each in (server, client))
