"""tf2::BufferCore in C++ answers as Python's tf2 of cfepy, and as the real one where that is installed."""

from __future__ import annotations

import math
import re
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from cfepy.extra.convert.message_headers import Profile, write_headers
from rospy_shim.types.msgs import library_of, shipped
from tests.ros_libraries.world import universe
from tests.roscfe.compiling import BOOST, HEADERS, ROSCFE, STRICT, compiled
from tests.roscfe.frame_scripts import scripts

HERE = Path(__file__).parent
LIBRARY = [ROSCFE / "src/tf" / name for name in ("text.cpp", "samples.cpp", "tree.cpp", "reports.cpp")]
LISTENING = [*LIBRARY, ROSCFE / "src/tf/listening.cpp"]
OURS = [HERE / "frames.cpp", HERE / "stubs.cpp", *LIBRARY]
REAL = Path("/usr/include/tf2/buffer_core.h")
LIVES = 40
CACHE = 10.0
PRECISION = 1e-12  # Python has another order of operations between two samples
load: Any = universe().importer.load
rospy, msg, tf2 = load("rospy"), load("geometry_msgs.msg"), load("tf2_py")


def program(folder: Path, *options: str, name: str = "ours") -> Path:
    messages = folder / "messages"
    write_headers(["geometry_msgs/TransformStamped"], messages, Profile.HOST, shipped())
    return compiled(folder, OURS, *options, name=name, headers=(messages, HEADERS, BOOST))


def answers(made: Path, lines: list[str]) -> tuple[list[str], list[str]]:
    """Return a program's output, and its log."""
    text = "\n".join(lines) + "\n"
    done = subprocess.run([made, str(CACHE)], input=text, capture_output=True, text=True, check=True)
    return done.stdout.splitlines(), done.stderr.splitlines()


# -- Python's ----------------------------------------------------------------------------------------------------------


def moment(text: str) -> Any:
    return rospy.Time(*divmod(int(text), 1_000_000_000))


def put(buffer: Any, child: str, parent: str, stamp: str, kind: str, author: str, *numbers: str) -> None:
    message = msg.TransformStamped(child_frame_id=child)
    message.header.frame_id, message.header.stamp = parent, moment(stamp)
    values = [math.nan if number == "nan" else float.fromhex(number) for number in numbers]
    message.transform = msg.Transform(msg.Vector3(*values[:3]), msg.Quaternion(*values[3:]))
    (buffer.set_transform_static if kind == "static" else buffer.set_transform)(message, author)


def found(message: Any) -> str:
    t, r = message.transform.translation, message.transform.rotation
    numbers = " ".join(float.hex(number) for number in (t.x, t.y, t.z, r.x, r.y, r.z, r.w))
    return f"{message.header.stamp.to_nsec()} {message.header.frame_id} {message.child_frame_id} {numbers}"


def common(buffer: Any, target: str, source: str) -> str:
    if not (buffer._frameExists(target) and buffer._frameExists(source)):
        return "1 0 "
    try:
        return f"0 {buffer.get_latest_common_time(target, source).to_nsec()} "
    except tf2.TransformException as error:
        return f"{1 if 'loop' in str(error) else 2} 0 {error}"


def parent(buffer: Any, name: str, time: str) -> str:
    cache = buffer._BufferCore__tree.caches.get(name)
    sample = None if cache is None else cache.sample(int(time))
    return f"{int(buffer._frameExists(name))} 0 " if sample is None else f"1 1 {sample[0]}"


def asked(buffer: Any, kind: str, *words: str) -> str:
    times = [moment(word) if re.fullmatch(r"[0-9]+", word) else word for word in words]
    if kind in ("look", "lookfull"):
        return found((buffer.lookup_transform_core if kind == "look" else buffer.lookup_transform_full_core)(*times))
    if kind in ("can", "canfull"):
        possible, text = (buffer.can_transform_core if kind == "can" else buffer.can_transform_full_core)(*times)
        return f"{possible} {text}"
    if kind == "chain":
        return "".join(f"{name} " for name in buffer._chain(*times))
    if kind in ("common", "parent"):
        return (common if kind == "common" else parent)(buffer, *words)
    if kind == "dot":
        return str(buffer._allFramesAsDot(rospy.Time(float(words[0]))))
    return str(buffer.all_frames_as_string() if kind == "string" else buffer.all_frames_as_yaml())


def in_python(lines: list[str], said: list[str]) -> Iterator[str]:
    """Yield the answers of Python's buffer to the lines of a life; `said` is its log."""
    buffer = tf2.BufferCore(rospy.Duration(CACHE))
    for line in lines:
        kind, *words = ("" if word == "-" else word for word in line.split())
        if kind == "clear":
            buffer.clear()
            continue
        if kind == "set":
            before = len(said)
            put(buffer, *words)
            yield "1" if len(said) == before else "0"
            continue
        try:
            text = asked(buffer, kind, *words)
        except tf2.TransformException as error:
            text = f"{type(error).__name__}: {error}"
        yield from text.split("\n")


def parts(line: str) -> tuple[str, list[float]]:
    """Words of a line, and its hexadecimal numbers."""
    numbers = re.findall(r" (-?0x\S+)", line)
    return re.sub(r" -?0x\S+", "", line), [float.fromhex(number) for number in numbers]


# -- tests -------------------------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_answers_equal_python(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    said: list[str] = []
    monkeypatch.setattr(load("tf2_py._tf2"), "_report", lambda level, text: said.append(f"{level} {text}"))
    made = program(tmp_path, "-Wall", "-Wextra", "-Werror", "-O1", "-fsanitize=address,undefined")
    seen: set[str] = set()
    for seed in range(LIVES):
        lines = scripts(seed)
        printed, log = answers(made, lines)
        said.clear()
        wanted = list(in_python(lines, said))
        assert log == said, seed
        assert len(printed) == len(wanted), seed
        for line, other in zip(printed, wanted, strict=True):
            (text, numbers), (other_text, other_numbers) = parts(line), parts(other)
            assert text.rstrip() == other_text.rstrip(), seed
            assert numbers == pytest.approx(other_numbers, rel=PRECISION, abs=PRECISION), (seed, line, other)
            seen.add("numbers" if numbers else text.split(":")[0])
    kinds = {"LookupException", "ConnectivityException", "ExtrapolationException", "InvalidArgumentException"}
    assert seen > {*kinds, "numbers"}


def comparable(lines: list[str]) -> list[str]:
    """Return the lines without a mistake of tf2: it reports a missing fixed frame if the source is missing."""
    return [re.sub(r" ?fixed_frame: \S*does not exist\.", "", line).rstrip() for line in lines]


@pytest.mark.slow
def test_answers_equal_a_real_ros(tmp_path: Path) -> None:
    if not REAL.is_file() or shutil.which("g++") is None:
        pytest.skip("there is no libtf2-dev on this computer; the comparison with Python has to do")
    libraries = ["-ltf2", "-lrostime", "-lboost_thread", "-lboost_system"]
    real = tmp_path / "real"
    command = ["g++", "-std=c++17", "-w", "-O2", str(HERE / "frames.cpp"), *libraries, "-o", str(real)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    ours = program(tmp_path, "-O2")
    for seed in range(LIVES):
        lines = scripts(seed)
        (printed, log), (wanted, wanted_log) = answers(ours, lines), answers(real, lines)
        assert comparable(printed) == comparable(wanted), seed
        shown = [line.rstrip() for line in wanted_log if not line.startswith("         at line")]
        assert [re.sub(r" \(parent \S+\) at ", " at ", line).rstrip() for line in log] == shown, seed


@pytest.mark.slow
def test_failure_without_exceptions_ends_the_application(tmp_path: Path) -> None:
    made = program(tmp_path, *STRICT)
    done = subprocess.run([made, "10"], input="look a b 0\n", capture_output=True, text=True, check=False)
    assert done.returncode == 3
    text = '"a" passed to lookupTransform argument target_frame does not exist. '
    assert done.stdout == f"refused: exception: {text}\n"


@pytest.mark.slow
@pytest.mark.parametrize("sanitizers", [[], ["-fsanitize=address,undefined"]])
def test_no_memory_is_allocated_in_flight(sanitizers: list[str], tmp_path: Path) -> None:
    """This holds in the strict profile, for 50 s of four frames at 100 Hz, with a buffer too small for 10 s of them."""
    messages = tmp_path / "messages"
    types = ["geometry_msgs/TransformStamped", "geometry_msgs/PoseWithCovarianceStamped", "geometry_msgs/PoseStamped"]
    types += [f"geometry_msgs/{name}Stamped" for name in ("Point", "Quaternion", "Vector3", "Wrench")]
    write_headers(types, messages, Profile.STRICT, shipped())
    sources = [HERE / "frames_memory.cpp", HERE / "stubs.cpp", HERE / "bus_stubs.cpp", *LISTENING]
    options = [*STRICT, "-O1", "-Wno-mismatched-new-delete", "-DROSCFE_PROFILE_STRICT", *sanitizers]
    made = compiled(tmp_path, sources, *options, headers=(messages, HEADERS, BOOST))
    done = subprocess.run([made], capture_output=True, text=True, errors="replace", check=False)
    assert done.returncode == 0, done.stderr
    printed = done.stdout.splitlines()
    assert printed[0].startswith("news: 0, ")
    assert printed[1] == f"forgotten early: {4 * 5000 - 1600}"  # all except the capacity of the buffer
    assert printed[2] == "oldest: 1 0"  # 1600 samples are 4 s of four frames
    assert printed[3] == "cut: 142 of 142 refused"
    assert "The buffer of transforms is full: 1600 samples" in done.stderr
    assert "runtime error" not in done.stderr


@pytest.mark.slow
def test_type_on_the_bus_is_that_of_tf2(tmp_path: Path) -> None:
    source = tmp_path / "type.cpp"
    source.write_text(
        "#include <cstdio>\n#include <cstring>\n"
        '#include <tf2_msgs/TFMessage.h>\n#include "roscfe/frames/transforms_message.h"\n'
        "int main()\n{\n"
        "    typedef roscfe::wire::Traits<roscfe::frames::Transforms> Ours;\n"
        "    typedef roscfe::wire::Traits<tf2_msgs::TFMessage> Theirs;\n"
        '    std::printf("%s", Ours::definition());\n'
        "    return std::strcmp(Ours::md5(), Theirs::md5()) || std::strcmp(Ours::type(), Theirs::type());\n}\n",
        encoding="utf-8",
    )
    messages = tmp_path / "messages"
    write_headers(["tf2_msgs/TFMessage"], messages, Profile.HOST, shipped())
    parts_needed = [source, HERE / "stubs.cpp", HERE / "bus_stubs.cpp", *LISTENING]
    made = compiled(tmp_path, parts_needed, headers=(messages, HEADERS, BOOST))
    done = subprocess.run([made], capture_output=True, text=True, check=False)
    assert done.returncode == 0
    assert library_of("tf2_msgs/TFMessage", done.stdout).md5sum("tf2_msgs/TFMessage") == shipped().md5sum(
        "tf2_msgs/TFMessage"
    )
