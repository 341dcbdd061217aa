"""The constants that an application imports from `cfepy.osal`, with osapi's values."""

from __future__ import annotations

import pytest

import cfepy.osal as osal


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("OS_PEND", -1),
        ("OS_CHECK", 0),
        ("OS_READ_ONLY", 0),
        ("OS_WRITE_ONLY", 1),
        ("OS_READ_WRITE", 2),
        ("OS_SEEK_END", 2),
        ("OS_FILE_FLAG_CREATE", 1),
        ("OS_SEM_FULL", 1),
        ("OS_MAX_API_NAME", 20),
        ("OS_SocketDomain_INET", 1),
        ("OS_SocketType_DATAGRAM", 1),
        ("OS_SocketType_STREAM", 2),
        ("OS_SocketShutdownMode_SHUT_READWRITE", 3),
        ("OS_STREAM_STATE_READABLE", 4),
        ("OS_TIME_TICKS_PER_SECOND", 10_000_000),
    ],
)
def test_constant_is_in_the_package(name: str, value: int) -> None:
    assert getattr(osal, name) == value
    assert name in osal.__all__
