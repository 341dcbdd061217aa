"""The library beside ROS's own: compared with the recorded output of Debian's roscpp, and with messages through
both."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from cfepy.extra.convert.message_headers import Profile, write_headers
from dev.roscfe.building import ROSCPP, STRICT_FLAGS, SYSTEM, compile_program, needs_cpp
from dev.roscfe.random_messages import LIBRARY, all_types
from dev.roscfe.roundtrip import Program, frames_of

pytestmark = [pytest.mark.slow, needs_cpp]
HEADERS = ("ros/serialization.h", "actionlib_msgs", "geometry_msgs", "tf2_msgs")
needs_roscpp = pytest.mark.skipif(
    not all((SYSTEM / each).exists() for each in HEADERS),
    reason="there are no headers of ROS (Debian: libroscpp-dev, libtf2-msgs-dev ...); what they print is recorded",
)
FOLDER = Path(__file__).parent
PROGRAMS = ("times", "printed", "own_types", "boost")
PRINTED = [
    *(f"std_msgs/{name}" for name in ("Byte", "Char", "Bool", "UInt64", "Duration", "Empty", "Header")),
    *(
        "std_msgs/Float32MultiArray",
        "std_msgs/Int8MultiArray",
        "std_msgs/String",
        "geometry_msgs/PoseArray",
        "rosgraph_msgs/Log",
    ),
    *("geometry_msgs/PoseWithCovariance", "actionlib_msgs/GoalStatusArray", "tf2_msgs/TFMessage"),
]


def output(program: Path) -> str:
    """Return a program's output."""
    return subprocess.run([program], capture_output=True, text=True, check=True).stdout


@pytest.mark.parametrize("name", PROGRAMS)
def test_program_prints_the_recorded_output(tmp_path: Path, name: str) -> None:
    write_headers(PRINTED, tmp_path, Profile.HOST, LIBRARY)
    flags = (f"-I{tmp_path}", "-O1")
    made = compile_program(tmp_path / name, [FOLDER / f"{name}.cpp"], *flags, base=STRICT_FLAGS)
    assert output(made) == (FOLDER / f"{name}.txt").read_text(encoding="utf-8")


@needs_roscpp
@pytest.mark.parametrize("name", PROGRAMS)
def test_recorded_output_equals_the_output_with_roscpp(tmp_path: Path, name: str) -> None:
    source, base = FOLDER / f"{name}.cpp", ("-std=c++17",)
    made = compile_program(tmp_path / name, [source], base=base, include=(), libraries=ROSCPP)
    assert output(made) == (FOLDER / f"{name}.txt").read_text(encoding="utf-8")


@needs_roscpp
def test_messages_pass_between_cfepy_and_roscpp(tmp_path: Path) -> None:
    types = [name for name in all_types() if (SYSTEM / f"{name}.h").is_file()]
    assert len(types) >= 20
    theirs = Program(tmp_path, types, Profile.HOST, "-O1", roscpp=True)
    (tmp_path / "ours").mkdir()
    ours = Program(tmp_path / "ours", types, Profile.HOST, "-O1")
    for name in types:
        frames = frames_of(name, 100)
        answers = theirs.answers(name, frames)
        assert [answer.octets for answer in answers] == frames, name
        assert [answer.octets for answer in ours.answers(name, [answer.octets for answer in answers])] == frames, name
        short = [frame[:-1] for frame in frames if frame]
        assert not any(answer.good for answer in theirs.answers(name, short)), name
        assert not any(answer.good for answer in ours.answers(name, short)), name
