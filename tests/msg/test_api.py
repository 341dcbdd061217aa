"""Every public function of NASA's message module has its Python counterpart."""

from __future__ import annotations

import re

import pytest

from cfepy import msg

GET_AND_SET = [
    "Size",
    "Type",
    "HeaderVersion",
    "HasSecondaryHeader",
    "ApId",
    "SegmentationFlag",
    "SequenceCount",
    "EDSVersion",
    "Endian",
    "PlaybackFlag",
    "Subsystem",
    "System",
    "FcnCode",
    "MsgTime",
    "MsgId",
]
OTHERS = [
    "Init",
    "GetNextSequenceCount",
    "GenerateChecksum",
    "ValidateChecksum",
    "GetTypeFromMsgId",
    "OriginationAction",
    "VerificationAction",
]


def snake(name: str) -> str:
    return re.sub("(?<=[a-z])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "_", name).lower()


@pytest.mark.parametrize("name", [*("Get" + n for n in GET_AND_SET), *("Set" + n for n in GET_AND_SET), *OTHERS])
def test_function_exists(name: str) -> None:
    assert callable(getattr(msg, snake(name)))
    assert snake(name) in msg.__all__


def test_message_api_has_37_functions() -> None:
    assert 2 * len(GET_AND_SET) + len(OTHERS) == 37
