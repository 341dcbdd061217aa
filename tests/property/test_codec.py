"""The message codec on generated values of every shipped type: round trip, agreement with the plain encoder, and with
real genpy where this machine has it."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rospy_shim.types import genpy
from rospy_shim.types.msgs import message_class, shipped
from rospy_shim.types.msgs.reference import encode
from tests.rospy_shim.golden_msgs import build
from tests.rospy_shim.types.msgs.values import plain

TYPES = [f"{package}/{name}" for package in shipped().packages() for name in shipped().names(package) or ()]
ROS_PYTHON = "/usr/bin/python3"
PEER = Path(__file__).parents[1] / "rospy_shim/types/msgs/genpy_peer.py"

_SMALL = settings(max_examples=80, deadline=None, suppress_health_check=[HealthCheck.too_slow])


typed_values = st.sampled_from(TYPES).flatmap(lambda name: st.tuples(st.just(name), plain(name)))


@pytest.mark.slow
@_SMALL
@given(typed_values)
def test_messages_survive_a_round_trip(typed: tuple[str, Any]) -> None:
    name, value = typed
    library, cls = shipped(), message_class(name)
    message = build(library, name, value)
    encoded = message.__pack__()
    assert encoded == encode(library.spec(name), library.spec, message)
    assert cls.__unpack__(encoded).__pack__() == encoded
    assert cls.__unpack__(b"xyz" + encoded + b"tail", 3).__pack__() == encoded
    assert cls().deserialize(encoded).__pack__() == encoded


@_SMALL
@given(st.lists(st.lists(st.text(max_size=3), max_size=4), min_size=1, max_size=6))
def test_cached_strings_change_nothing(lists: list[list[str]]) -> None:
    library, cls = shipped(), message_class("sensor_msgs/JointState")
    for names in [*lists, *lists[::-1], lists[0]]:
        message = cls(name=names)
        encoded = message.__pack__()
        assert encoded == encode(library.spec("sensor_msgs/JointState"), library.spec, message)
        decoded = cls.__unpack__(encoded)
        assert decoded.name == names
        decoded.name.append("mine")


@pytest.mark.slow
@_SMALL
@given(typed_values, st.data())
def test_truncated_bytes_are_decoded_or_refused(typed: tuple[str, Any], data: st.DataObject) -> None:
    name, value = typed
    cls = message_class(name)
    encoded = build(shipped(), name, value).__pack__()
    cut = encoded[: data.draw(st.integers(0, len(encoded)))]
    try:
        again = cls.__unpack__(cut)
    except genpy.DeserializationError:
        return
    assert again.__pack__() == cls().deserialize(cut).__pack__()


class Peer:
    """Real genpy in a process of its own."""

    def __init__(self) -> None:
        self.process = subprocess.Popen(
            [ROS_PYTHON, str(PEER)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )

    def ask(self, name: str, **request: Any) -> dict[str, Any]:
        """Send one request for a type and return the answer."""
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        line = json.dumps({"type": name, "full_text": message_class(name)._full_text, **request})
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        answer: dict[str, Any] = json.loads(self.process.stdout.readline())
        return answer


@pytest.fixture(scope="module")
def peer() -> Iterator[Peer]:
    """Yield real genpy, or skip the test with the reason that it is missing."""
    try:
        found = subprocess.run([ROS_PYTHON, "-c", "import genpy.dynamic"], capture_output=True, check=False)
    except OSError:
        found = None
    if found is None or found.returncode != 0:
        pytest.skip(f"{ROS_PYTHON} has no genpy (Debian: python3-genpy); golden bytes are tested all the same")
    made = Peer()
    yield made
    made.process.communicate()


@_SMALL
@given(typed=typed_values)
def test_messages_equal_genpy(peer: Peer, typed: tuple[str, Any]) -> None:
    name, value = typed
    message = build(shipped(), name, value)
    theirs = peer.ask(name, value=value)
    assert {"hex": message.__pack__().hex(), "text": str(message), "md5sum": message._md5sum} == theirs


@pytest.mark.slow
@_SMALL
@given(typed=typed_values, data=st.data())
def test_damaged_bytes_are_decoded_as_by_genpy(peer: Peer, typed: tuple[str, Any], data: st.DataObject) -> None:
    name, value = typed
    octets = bytearray(build(shipped(), name, value).__pack__())
    for _ in range(data.draw(st.integers(0, 2))):
        if octets:
            octets[data.draw(st.integers(0, len(octets) - 1))] = data.draw(st.sampled_from([0, 1, 2, 5, 127, 255]))
    damaged = bytes(octets[: data.draw(st.integers(0, len(octets)))])
    theirs = peer.ask(name, hex=damaged.hex())
    try:
        ours = {"hex": message_class(name).__unpack__(damaged).__pack__().hex()}
    except Exception as error:
        ours = {"error": type(error).__name__}
    assert ours == theirs
