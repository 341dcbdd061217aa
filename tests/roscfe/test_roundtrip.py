"""All message types in C++: random messages come back as genpy's bytes, here and on 32 bits, big-endian too."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.extra.convert.message_headers import Profile
from dev.roscfe.building import needs_cpp, target_named
from dev.roscfe.random_messages import all_types
from dev.roscfe.roundtrip import Program, frames_of

pytestmark = [pytest.mark.slow, needs_cpp]
MESSAGES = {"here": 200, "powerpc": 30, "arm": 30}  # of each type; an emulated processor is slow


@pytest.mark.parametrize("profile", [Profile.HOST, Profile.STRICT])
@pytest.mark.parametrize("target", MESSAGES)
def test_all_types_survive_a_round_trip(tmp_path: Path, profile: Profile, target: str) -> None:
    kind = target_named(target)
    types = all_types()
    assert len(types) > 1000
    program = Program(tmp_path, types, profile, "-O1", target=kind)
    for name in types:
        assert not program.differing(name, frames_of(name, MESSAGES[target])), name


def test_reading_in_the_strict_profile_allocates_nothing(tmp_path: Path) -> None:
    types = ["diagnostic_msgs/DiagnosticArray", "sensor_msgs/PointCloud2", "trajectory_msgs/JointTrajectory"]
    program = Program(tmp_path, types, Profile.STRICT, "-O1")
    for name in types:
        assert {answer.allocated for answer in program.answers(name, frames_of(name, 50))} == {0}


def test_message_too_long_for_the_strict_profile_is_refused(tmp_path: Path) -> None:
    program = Program(tmp_path, ["std_msgs/String"], Profile.STRICT, "-O1")
    fitting, longer = (bytes([count, 0, 0, 0]) + b"x" * count for count in (24, 25))
    answers = program.answers("std_msgs/String", [fitting, longer, fitting])
    assert [answer.good for answer in answers] == [True, False, True]
    assert answers[2].octets == fitting
